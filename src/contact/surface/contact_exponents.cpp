#include "contact/surface/contact_exponents.h"

#include "model/exponents.h"
#include "modelfile/mechanical/gaps.h"

namespace anholon {

namespace {

template <class Visit>
void for_each_formula(std::vector<Contact>& contacts, ContactForces* forces, const Visit& visit) {
  const auto each = [&](Expr& e) {
    if (e.graph) visit(e);
  };
  for (Contact& c : contacts) {
    each(c.gap), each(c.friction), each(c.static_friction), each(c.restitution);
    for (Expr& v : c.slip) each(v);
    for (Expr& size : c.sizes) each(size);
    for (Contact::Coefficient& g : c.given) each(g.value);
  }
  if (!forces) return;
  for (ContactForces::Formula& f : forces->formulas) each(f.value);
}

}  // namespace

std::vector<Contact> with_whole_exponents(Workspace& s, const std::vector<Contact>& contacts) {
  std::vector<Contact> list = contacts;
  std::shared_ptr<ContactForces> forces;
  if (!list.empty() && list[0].forces) forces = std::make_shared<ContactForces>(*list[0].forces);
  Column all;
  for_each_formula(list, forces.get(), [&](const Expr& e) { all.push_back(s.graph().own(e)); });
  const Column replaced = with_whole_exponents(*s.model, all, {});
  std::size_t next = 0;
  for_each_formula(list, forces.get(), [&](Expr& e) { e = replaced[next++]; });
  for (Contact& c : list) c.forces = forces;
  return list;
}

// Returns the formula with the values of all parameters that no event sets.
static Expr with_numbers(const Model& model, Expr e) {
  const Graph& g = *model.graph;
  for (std::size_t depth = 0; depth <= model.parameters.size(); ++depth)
    e = substitute({&e, 1}, [&](NodeId id) {
          const Node& n = g.node(id);
          const bool known = n.kind == Kind::parameter && n.index < model.parameters.size();
          return known && !model.parameters[n.index].mode ? model.parameters[n.index].value : Expr{};
        }).front();
  return e;
}

Outcome all_pass_zero(const Model& model, const std::vector<Contact>& contacts) {
  for (const Contact& c : contacts)
    if (!c.under && touches_zero_only(with_numbers(model, c.gap)))
      return {OutcomeKind::inconsistent,
              "the gap of contact '" + c.name +
                  "' touches zero and does not pass it, with the values of its parameters",
              "a distance with a sign, which a body that passes makes negative: z in place of z^2", c.span};
  return {};
}

}  // namespace anholon
