#include "formulation/quantities.h"

#include "formulation/operators.h"

namespace anholon {

Quantities listed(std::initializer_list<Quantities> lists) {
  Quantities all;
  for (const Quantities& l : lists) all.insert(all.end(), l.begin(), l.end());
  return all;
}

Quantities named(const Label& name, Expr value) { return {Quantity{name, value}}; }

Quantities named(const Labels& names, const Column& values) {
  Quantities out;
  for (std::size_t a = 0; a < values.size(); ++a) out.push_back({names[a], values[a]});
  return out;
}

Quantities partials(const Labels& of, const Labels& by, const Rows& values) {
  Quantities out;
  for (std::size_t s = 0; s < values.size(); ++s)
    for (std::size_t a = 0; a < values[s].size(); ++a)
      if (!is_zero(values[s][a])) out.push_back({partial(of[s], by[a]), values[s][a]});
  return out;
}

Quantities rates_of_partials(const Labels& of, const Labels& by, const Rows& values) {
  Quantities out = partials(of, by, values);
  for (Quantity& q : out) q.name = rate(q.name);
  return out;
}

Quantities partials_of(const Mechanics& M, const Label& name, Expr F, unsigned k) {
  return named(partial(name, jet_labels(M, k)), gradient(F, jets(*M.model, k)));
}

Quantities with_partials(const Mechanics& M, const Label& name, Expr F, unsigned k) {
  return listed({named(name, F), partials_of(M, name, F, k)});
}

Quantities frozen_rates(const Quantities& of, const Column& values) {
  Quantities out;
  for (std::size_t a = 0; a < values.size(); ++a) out.push_back({frozen_rate(of[a].name), values[a]});
  return out;
}

Quantities of_nielsen(const Mechanics& M, unsigned m) {
  const Expr before = T(M, m - 1);
  const Label name = energy("T", m - 1);
  const Quantities momenta = partials_of(M, name, before, m);
  const Column rates = total_derivative(gradient(before, jets(*M.model, m)));
  return listed({named(name, before), momenta, frozen_rates(momenta, rates), partials_of(M, name, before, m - 1)});
}

Quantities of_lagrange(const Mechanics& M) { return of_nielsen(M, 1); }

Quantities of_micevic_rusov(const Mechanics& M, unsigned m) {
  const Quantities list =
      listed({with_partials(M, energy("T", m), T(M, m), m), with_partials(M, energy("T", m - 1), T(M, m - 1), m - 1)});
  return m == 1 ? list : listed({list, partials_of(M, energy("T"), M.T, 0)});
}

Quantities of_mangeron_deleanu(const Mechanics& M, unsigned m) {
  return listed({with_partials(M, energy("T", m), T(M, m), m), with_partials(M, energy("T"), M.T, 0)});
}

Quantities of_appell(const Mechanics& M) { return with_partials(M, energy("S"), M.S, 2); }

Quantities reduced(const Elimination& E, const Label& name, Expr F) { return named(name, E.on(F)); }

Quantities dependent_partials(const Mechanics& M, const Elimination& E, const Label& name, Expr F, unsigned k) {
  return named(partial(name, pick(jet_labels(M, k), E.dependent)), E.on(E.D(gradient(F, jets(*M.model, k)))));
}

Quantities f_by_lower(const Mechanics& M, const Elimination& E) {
  return partials(pick(jet_labels(M, E.m), E.dependent), pick(jet_labels(M, E.m - 1), E.independent), E.f_by(E.m - 1));
}

Quantities rates_of_f_by_u(const Mechanics& M, const Elimination& E) {
  return rates_of_partials(pick(jet_labels(M, E.m), E.dependent), free_labels(M, E), E.rate(E.f_by_u()));
}

Quantities f_rate_by_u(const Mechanics& M, const Elimination& E) {
  return partials(pick(jet_labels(M, E.m + 1), E.dependent), free_labels(M, E), E.f_rate_by_u());
}

Labels point_labels(const Mechanics& M, const Label& of) {
  Labels out;
  std::size_t body = M.model->bodies.size(), axis = 0;
  for (const WeightedPoint& p : M.points) {
    axis = p.body == body && !p.uniform_field ? axis + 1 : p.uniform_field ? 0 : 1;
    body = p.body;
    const std::string& name = M.model->bodies[p.body].name;
    for (const char* e : {"x", "y", "z"}) {
      Labels parts{name_of(*M.model, name)};
      std::string text = name;
      if (axis) {
        const std::string number = std::to_string(axis);
        text += "." + number;
        parts.push_back({number, number, "<mn>" + number + "</mn>"});
      }
      parts.push_back(letter(e));
      out.push_back(indexed(of, text + "." + e, parts));
    }
  }
  return out;
}

Quantities along(const Mechanics& M, const Elimination& E, const Label& of, const Column& X) {
  Labels names;
  for (const std::string& u : E.free.names) names.push_back(indexed(of, u, {name_of(*M.model, u)}));
  return named(names, E.contract(X));
}

Quantities forces_along(const Mechanics& M, const Elimination& E) { return along(M, E, letter("G"), forces(M)); }

}  // namespace anholon
