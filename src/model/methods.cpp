#include "model/methods.h"

#include <iterator>

#include "numeric/number.h"

namespace anholon {

using Use = MethodInfo::Use;

// The least tolerance of Runge-Kutta is the round-off of f in double; that of BDF, whose order is 5 at most, is one
// that it reaches in acceptable time.
static constexpr MethodInfo kMethods[] = {
    // use, name, title, citation, wide numbers, resumes, encloses, order can be chosen, order, least tolerance, raised
    {Use::motion, "auto", "Taylor", "", true, true, true, true, 0, 0, true},
    {Use::both, "taylor", "Taylor", "", true, true, true, true, 0, 0, true},
    {Use::motion, "rk", "Runge-Kutta 8", "PrinceDormand1981", false, false, false, false, 8, 1e-14, true},
    {Use::motion, "bdf", "BDF", "Hindmarsh2005", false, false, false, false, 5, 1e-10, false},
    {Use::second_opinion, "cvode", "CVODE", "Hindmarsh2005", false, false, false, true, 0, 1e-14, true},
    {Use::second_opinion, "ida", "IDA", "Hindmarsh2005", false, false, false, true, 0, 1e-14, true},
};
static_assert(std::size(kMethods) == static_cast<std::size_t>(Method::ida) + 1);

const MethodInfo& info(Method method) { return kMethods[static_cast<std::size_t>(method)]; }
const char* name(Method method) { return info(method).name; }

static bool serves(const MethodInfo& m, Use use) { return m.use == use || m.use == Use::both; }

const std::vector<std::string>& method_names(Use use) {
  const auto names_with = [](Use wanted) {
    std::vector<std::string> list;
    for (const MethodInfo& m : kMethods)
      if (serves(m, wanted)) list.emplace_back(m.name);
    return list;
  };
  static const std::vector<std::string> motions = names_with(Use::motion), opinions = names_with(Use::second_opinion);
  return use == Use::motion ? motions : opinions;
}

std::optional<Method> find_method(const std::string& name, Use use) {
  for (std::size_t k = 0; k < std::size(kMethods); ++k)
    if (kMethods[k].name == name && serves(kMethods[k], use)) return static_cast<Method>(k);
  return std::nullopt;
}

std::optional<MethodRefusal> refusal(const MethodInfo& method, const MethodDemands& demands) {
  using Of = MethodRefusal::Of;
  if (demands.wide_numbers && !method.wide_numbers) return MethodRefusal{Of::numbers, "computes in double"};
  if (demands.saved && !method.resumes) return MethodRefusal{Of::saving, "cannot go on with the same bits"};
  if (demands.enclosed && !method.encloses) return MethodRefusal{Of::enclosing, "has no dense output that is enclosed"};
  if (demands.order && !method.has_order) return MethodRefusal{Of::order, "has no order to choose"};
  if (!method.serves(demands.tolerance) && !method.raises_tolerance)
    return MethodRefusal{Of::tolerance, "is of order 5 at most, for tolerances of " +
                                            number_text(method.least_tolerance, 3) + " and more"};
  return std::nullopt;
}

}  // namespace anholon
