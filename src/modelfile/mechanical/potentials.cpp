#include "modelfile/mechanical/potentials.h"

#include "expr/table.h"
#include "model/jumps.h"
#include "modelfile/mechanical/control.h"
#include "modelfile/text/collect.h"
#include "modelfile/text/keys.h"

namespace anholon {

void read_gravity(const Item& root, Scope& scope, Diagnostics& diagnostics) {
  const Item* section = find_section(root, "gravity", diagnostics);
  if (!section) return;
  check_keys(*section, "[gravity]", "gravity", diagnostics);
  if (const Item* gradient = section->find("gradient")) {
    if (gradient->kind != Item::Kind::boolean)
      diagnostics.error(gradient->span, "'gradient' is true or false");
    else
      scope.gravity_gradient = gradient->truth;
  }
  if (const Item* field = section->find("field"))
    scope.set_gravity(*field);
  else
    diagnostics.error(section->span, "[gravity] has no field", "field = \"-g*ez\"");
}

void read_potentials(const Item& root, Scope& scope, Model& model, Diagnostics& diagnostics) {
  const Item* section = find_section(root, "potential", diagnostics);
  if (!section) return;
  scope.freeze_masses = true;
  for (const Item& i : section->items)
    collect(
        diagnostics,
        [&] {
          const Expr v = scope.number(i), value = with_feedback(model, v, "the potential '" + i.key + "'");
          if (jet_order(value) > 0)
            throw Failure(i.span, "the potential '" + i.key + "' depends on a velocity", "give a force instead");
          if (const auto name = too_rough(v, 1))
            throw Failure(i.span,
                          "the potential '" + i.key + "' holds the table '" + *name +
                              "', which jumps: so would the energy, without a force",
                          "fit = \"linear\", \"monotone\" or \"spline\"");
          if (jumps_at_a_point(model, put_controls(model, {&value, 1})[0], holds_coordinates))
            diagnostics.warning(i.span, "the potential '" + i.key + "' jumps: so does the energy, without a force",
                                "write a potential that is continuous in the coordinates; a wall is a [[contact]]");
          model.potentials.push_back({i.key, value, i.span});
        },
        i);
  scope.freeze_masses = false;
}

void read_dissipation(const Item& root, Scope& scope, Model& model, Diagnostics& diagnostics) {
  const Item* section = find_section(root, "dissipation", diagnostics);
  if (!section) return;
  scope.freeze_masses = true;
  for (const Item& i : section->items)
    collect(
        diagnostics,
        [&] {
          const Expr r = with_feedback(model, scope.number(i), "the dissipation '" + i.key + "'");
          const int order = jet_order(r);
          if (order > 1) throw Failure(i.span, "the dissipation '" + i.key + "' depends on an acceleration");
          if (order < 1)
            throw Failure(i.span, "the dissipation '" + i.key + "' depends on no velocity",
                          "R = \"c/2*x'^2\" gives the force -c x'");
          model.dissipation.push_back({i.key, r, i.text(), i.span});
        },
        i.span);
  scope.freeze_masses = false;
}

}  // namespace anholon
