#include "modelfile/names/identity.h"

#include <algorithm>
#include <cmath>

namespace anholon {

void add_identity(std::vector<Identity>& list, Expr e, double slack, std::function<std::string(double)> what,
                  const std::string& hint, Span span) {
  const std::vector<NodeId> all = symbols({&e, 1});
  const auto is_parameter = [&](NodeId id) { return e.graph->node(id).kind == Kind::parameter; };
  if (all.empty() || !std::all_of(all.begin(), all.end(), is_parameter)) return;
  list.push_back({compile({&e, 1}), slack, std::move(what), hint, span});
}

std::optional<Diagnostic> first_violated(const std::vector<Identity>& list, const std::vector<double>& parameters) {
  for (const Identity& identity : list) {
    Machine<double> machine(identity.left, 0, parameters);
    machine.evaluate();
    if (const double value = machine.value(0); !(std::abs(value) <= identity.slack))
      return Diagnostic{Severity::error, identity.span, identity.what(value), identity.hint};
  }
  return std::nullopt;
}

}  // namespace anholon
