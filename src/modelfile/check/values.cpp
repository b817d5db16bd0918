#include "modelfile/check/values.h"

#include <algorithm>
#include <functional>

#include "modelfile/text/collect.h"
#include "numeric/multi.h"
#include "tape/point.h"
#include "tape/tape.h"

namespace anholon {

// The depth of references between parameters.
static constexpr std::size_t kDeepestParameters = 400;

void check_values(const Model& model, Diagnostics& diagnostics) {
  const Graph& g = *model.graph;
  // The length of the chain of references behind each value.
  std::vector<std::size_t> depth(model.parameters.size(), 0);
  const std::function<std::size_t(std::size_t)> deep = [&](std::size_t i) {
    if (depth[i] > 0 || is_number(model.parameters[i].value)) return depth[i];
    std::size_t most = 0;
    for (NodeId id : symbols({&model.parameters[i].value, 1}))
      if (g.node(id).kind == Kind::parameter) most = std::max(most, 1 + deep(g.node(id).index));
    return depth[i] = most;
  };
  for (std::size_t i = 0; i < depth.size(); ++i)
    if (deep(i) > kDeepestParameters) {
      diagnostics.error(model.parameters[i].span, "the parameter '" + model.parameters[i].name +
                                                      "' leads through more than " +
                                                      std::to_string(kDeepestParameters) + " others");
      return;
    }
  std::vector<std::optional<double>> known(model.parameters.size());
  const std::function<double(Expr)> value = [&](Expr e) {
    if (g.is_number(e.id)) return from_rational<double>(g.value(e.id));
    return PointValues([&](const Node& n) {
      std::optional<double>& v = known[n.index];
      if (!v) v = value(model.parameters[n.index].value);
      return *v;
    })(e);
  };
  const auto check = [&](Expr e, Span place, const std::string& what) {
    return collect(diagnostics, [&] {
      if (is_number(e) || is_finite(value(e))) return;
      std::string why = "a root or logarithm of a negative number, or a number beyond all bounds";
      try {
        const PrecisionScope precision(40);
        Column all;
        for (const Parameter& p : model.parameters) all.push_back(p.value);
        all.push_back(e);
        if (is_finite(evaluate_parameters<Multi>(*model.graph, all).back())) return;
      } catch (const Failure& f) {
        why = f.diagnostic.message;
      }
      throw Failure(place, what + " has no value: " + why);
    });
  };
  for (const Parameter& p : model.parameters)
    if (!check(p.value, p.span, "the parameter '" + p.name + "'")) return;  // other parameters may contain this one
  for (const StateVariable& z : model.states) check(z.initial, z.span, "the initial value of '" + z.name + "'");
  for (const auto* list : {&model.initial.given, &model.initial.guess})
    for (const GivenValue& v : *list) check(v.value, v.span, "this initial value");
  check(model.initial.t, {}, "the initial time");
}

}  // namespace anholon
