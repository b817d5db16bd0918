#include "motion/methods.h"

#include <algorithm>

#include "integrate/states/sundials.h"
#include "numeric/number.h"

namespace anholon {

// In the order of Method.
static constexpr MethodInfo kMethods[] = {
    // name, title, citation, wide numbers, resumes, encloses, has an order, least tolerance, raised to it
    {"auto", "Taylor", "", true, true, true, true, 0, true},
    {"taylor", "Taylor", "", true, true, true, true, 0, true},
    {"rk", "Runge-Kutta 8", "PrinceDormand1981", false, false, false, false, kLeastRungeKuttaTolerance, true},
    {"bdf", "BDF", "Hindmarsh2005", false, false, false, false, kLeastBdfTolerance, false},
};
// In the order of Integrator.
static constexpr MethodInfo kIntegrators[] = {
    {"taylor", "Taylor", "", true, true, true, true, 0, true},
    {"cvode", "CVODE", "Hindmarsh2005", false, false, false, true, kLeastSundialsTolerance, true},
    {"ida", "IDA", "Hindmarsh2005", false, false, false, true, kLeastSundialsTolerance, true},
};

const MethodInfo& info(Method method) { return kMethods[static_cast<std::size_t>(method)]; }
const MethodInfo& info(Integrator integrator) { return kIntegrators[static_cast<std::size_t>(integrator)]; }

const std::vector<std::string>& method_names() {
  static const std::vector<std::string> names = [] {
    std::vector<std::string> list;
    for (const MethodInfo& m : kMethods) list.emplace_back(m.name);
    return list;
  }();
  return names;
}

const char* name(Method method) { return info(method).name; }

std::optional<Method> find_method(const std::string& name) {
  const auto& names = method_names();
  const auto at = std::find(names.begin(), names.end(), name);
  if (at == names.end()) return std::nullopt;
  return static_cast<Method>(at - names.begin());
}

std::optional<MethodRefusal> refusal(const MethodInfo& method, const MethodDemands& demands) {
  using Of = MethodRefusal::Of;
  if (demands.wide_numbers && !method.wide_numbers) return MethodRefusal{Of::numbers, "computes in double"};
  if (demands.saved && !method.resumes) return MethodRefusal{Of::saving, "cannot go on with the same bits"};
  if (demands.enclosed && !method.encloses) return MethodRefusal{Of::enclosing, "has no dense output that is enclosed"};
  if (demands.order && !method.has_order) return MethodRefusal{Of::order, "has no order to choose"};
  if (demands.tolerance < method.least_tolerance && !method.raises_tolerance)
    return MethodRefusal{Of::tolerance, "is of order 5 at most, for tolerances of " +
                                            number_text(method.least_tolerance, 3) + " and more"};
  return std::nullopt;
}

}  // namespace anholon
