#include "lowering/copied_mechanics.h"

#include "expr/copy.h"

namespace anholon {

CopiedMechanics copied_mechanics(const Mechanics& m, const System& derived, std::span<const Expr> others) {
  const Model& from = *m.model;
  CopiedMechanics c;
  c.model = std::make_shared<Model>();
  c.model->graph = std::make_shared<Graph>();
  c.model->names = from.names;
  c.model->names.defined.clear();
  c.model->coordinates = from.coordinates;
  c.model->masses = from.masses;
  c.model->controls = from.controls;
  for (Control& u : c.model->controls) u.open = {};
  Column all;
  const auto visit = [&](const auto& each) {
    for (std::size_t i = 0; i < m.points.size(); ++i) {
      const WeightedPoint& p = m.points[i];
      if (c.points.size() <= i) c.points.push_back({p.weight, p.speed2, p.place, p.uniform_field});
      for (Expr* e :
           {&c.points[i].weight, &c.points[i].speed2, &c.points[i].place.x, &c.points[i].place.y, &c.points[i].place.z})
        each(*e);
    }
    for (Expr& e : c.forces) each(e);
    for (Expr& e : c.constraints) each(e);
    for (Expr& e : c.state_rates) each(e);
    for (Expr& e : c.others) each(e);
    for (VaryingMass& v : c.model->masses) each(v.value);
    for (Control& u : c.model->controls)
      if (u.value) each(*u.value);
  };
  c.forces = forces(m);
  for (std::size_t r : derived.constraints) c.constraints.push_back(m.phi[r]);
  for (const StateVariable& z : from.states) c.state_rates.push_back(z.rate);
  c.others.assign(others.begin(), others.end());
  visit([&](Expr& e) { all.push_back(e); });
  const Column images = copied(all, *c.model->graph);
  std::size_t i = 0;
  visit([&](Expr& e) { e = images[i++]; });
  // A place that has a series of its own, or whose velocity is differentiated, contains its inputs as formulas.
  for (CopiedMechanics::Point& p : c.points) {
    const Column put = put_controls(*c.model, Column{p.speed2, p.place.x, p.place.y, p.place.z});
    p.speed2 = put[0], p.place = {put[1], put[2], put[3]};
  }
  return c;
}

}  // namespace anholon
