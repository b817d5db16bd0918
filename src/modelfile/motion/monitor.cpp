#include "modelfile/motion/monitor.h"

#include <algorithm>

#include "formula/indices.h"
#include "modelfile/text/collect.h"

namespace anholon {

// Derivatives of higher order would be computed at every row, so they are refused.
static constexpr int kHighestOrder = 20;

static void read_one(const Item& i, Scope& scope, Model& model) {
  const std::string name = normal_name(i.key);
  if (!is_element_name(name))
    throw Failure(i.key_span, "'" + name.substr(0, 40) + "' is not a name",
                  "letters (a-z, A-Z, Greek), digits and _, not starting with a digit");
  const auto& taken = model.names.coordinates;
  if (name == "t" || std::find(taken.begin(), taken.end(), name) != taken.end())
    throw Failure(i.key_span, "a column '" + name + "' is there already", "give the monitor a name of its own");
  for (const Monitor& m : model.monitors)
    if (m.name == name) throw Failure(i.key_span, "there are two monitors '" + name + "'");
  if (!i.is_formula()) throw Failure(i.span, "a monitor is a formula", "speed = \"norm(vel(P.center))\"");
  const Value v = evaluate(parse_formula(i.formula), scope);
  if (const Expr* e = std::get_if<Expr>(&v)) {
    const Expr value = put_masses(model, *e);
    for (NodeId id : symbols({&value, 1}))
      if (const Node& n = model.graph->node(id);
          (n.kind == Kind::jet || n.kind == Kind::multiplier) && n.order > kHighestOrder)
        throw Failure(i.span, "a derivative of order above " + std::to_string(kHighestOrder));
    model.monitors.push_back({name, value, i.key_span, open_form(model, *e)});
    return;
  }
  throw Failure(i.span, std::string("a monitor is a number, this is ") + type_name(v),
                std::holds_alternative<Vector>(v) ? "one of its components, or its length: norm(…)" : "");
}

void read_monitors(const Item& section, Scope& scope, Model& model, Diagnostics& diagnostics) {
  const ForcesInFormulas::Allowed allowed(scope.forces);
  for (const Item& i : section.items) collect(diagnostics, [&] { read_one(i, scope, model); }, i);
}

}  // namespace anholon
