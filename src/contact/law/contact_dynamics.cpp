#include "contact/law/contact_dynamics.h"

#include <algorithm>
#include <cmath>

namespace anholon {

namespace {

void check_constraints(const Scenario& s) {
  for (const std::size_t r : s.independent) {
    const Constraint& c = s.model->constraints[r];
    if (c.order > 1)
      throw Failure(
          c.span, "contacts go with constraints of positions and velocities, and '" + c.name + "' holds accelerations",
          "write the constraint with velocities, such as x' = 2*t in place of x'' = 2");
    if (c.by)
      throw Failure(c.span, "contacts do not go with servo constraints, as '" + c.name + "' is",
                    "leave out 'by', so that an ideal reaction keeps the constraint, or give the input a formula in "
                    "place of the constraint");
  }
}

// Returns the formulas in the order in which ContactDynamics::go reads them.
Column formulas(Workspace& s, const std::vector<Contact>& contacts) {
  const Mechanics& m = *s.mechanics;
  Column es;
  const auto add_row = [&](const Column& row) { es.insert(es.end(), row.begin(), row.end()); };
  const auto rate = [&](Expr e, unsigned order) { return put_state_rates(*s.model, total_derivative(e, order), 1); };
  const Column left = newton_left_side(m), given = forces(m);
  for (std::size_t i = 0; i < left.size(); ++i) {
    const Expr e = put_state_rates(*s.model, put_masses(*s.model, left[i] - given[i]), 1);
    add_row(gradient(e, m.qdd));
    es.push_back(e);
  }
  for (const std::size_t r : s.independent) {
    const int order = m.order[r];
    const Expr phi = put_masses(*s.model, m.phi[r]);
    add_row(gradient(phi, order == 0 ? m.q : m.qd));
    es.push_back(rate(phi, static_cast<unsigned>(2 - order)));
    es.push_back(rate(phi, static_cast<unsigned>(1 - order)));
  }
  for (const Contact& c : contacts) {
    es.push_back(c.gap);
    es.push_back(rate(c.gap, 1));
    add_row(gradient(c.gap, m.q));
    es.push_back(rate(c.gap, 2));
    for (const Expr v : c.slip) {
      es.push_back(v);
      add_row(gradient(v, m.qd));
      es.push_back(rate(v, 1));
    }
    es.insert(es.end(), {c.friction, c.static_friction, c.restitution});
  }
  return es;
}

// Returns the name of the first constraint on velocities that is not linear in them; empty if there is none.
std::string first_nonlinear(const Scenario& s) {
  for (const std::size_t r : s.independent)
    for (const Expr slope : s.mechanics->Phi[r])
      if (s.mechanics->order[r] == 1 && jet_order(slope) == 1) return s.model->constraints[r].name;
  return {};
}

std::vector<Contact> owned(Workspace& s, std::vector<Contact> contacts) {
  for (Contact& c : contacts) {
    for (Expr* e : {&c.gap, &c.friction, &c.static_friction, &c.restitution}) *e = s.graph().own(*e);
    for (Expr& v : c.slip) v = s.graph().own(v);
  }
  check_constraints(s);
  return contacts;
}

}  // namespace

ContactDynamics::ContactDynamics(Workspace& s, const std::vector<Contact>& contacts)
    : n_(s.mechanics->q.size()), independent_(s.independent), nonlinear_(first_nonlinear(s)),
      contacts_(owned(s, contacts)), graph_(s.graph()), tape_(compile(formulas(s, contacts_))),
      parameters_(parameter_values<long double>(*s.model)), borders_(sides(contacts)),
      machine_(tape_, 0, with_sides(parameters_, borders_)) {}

std::vector<double> sides(const std::vector<Contact>& contacts) {
  return std::vector<double>(contacts.empty() || !contacts[0].borders ? 0 : 2 * contacts[0].borders->size(), 1);
}

std::vector<long double> with_sides(std::vector<long double> parameters, const std::vector<double>& borders) {
  parameters.insert(parameters.end(), borders.begin(), borders.end());
  return parameters;
}

void evaluate_at(const ContactState& at, const Graph& graph, Machine<long double>& machine) {
  bind(machine, graph, [&](const Node& n, NodeId) -> long double {
    if (n.kind == Kind::time) return at.t.get_d();
    if (n.kind == Kind::jet) return n.order == 0 ? at.q[n.index] : n.order == 1 ? at.qd[n.index] : 0;
    return n.kind == Kind::state && n.order == 0 ? at.states[n.index] : 0;
  });
  machine.evaluate();
}

void ContactDynamics::go(const ContactState& at) {
  if (at.borders != borders_) {
    borders_ = at.borders;
    machine_.set_parameters(with_sides(parameters_, borders_));
  }
  evaluate_at(at, graph_, machine_);
  std::size_t k = 0;
  const auto next = [&] { return machine_.value(k++); };
  const auto row = [&] {
    std::vector<long double> list;
    for (std::size_t i = 0; i < n_; ++i) list.push_back(next());
    return list;
  };
  problem_ = {};
  places_.clear();
  velocities_.assign(at.qd.begin(), at.qd.end());
  std::vector<long double> terms;
  machine_.made_of(terms);
  for (std::size_t i = 0; i < n_; ++i) {
    problem_.A.push_back(row());
    problem_.terms_of_b.push_back(terms[tape_.roots[k]]);
    problem_.b.push_back(next());
  }
  constraint_rates_.clear();
  for (std::size_t r = 0; r < independent_.size(); ++r) {
    problem_.Phi.push_back(row());
    problem_.beta.push_back(next());
    constraint_rates_.push_back(next());
  }
  speed_ = 0;
  most_.resize(n_, 0), met_.resize(n_, 0);
  for (std::size_t a = 0; a < n_; ++a) {
    met_[a] = std::max(met_[a], static_cast<long double>(std::abs(at.qd[a])));
    most_[a] = std::max(most_[a], met_[a]);
    speed_ = std::max(speed_, static_cast<long double>(std::abs(at.qd[a])));
  }
  for (const Contact& c : contacts_) {
    Place place;
    ContactRows rows;
    place.gap = next();
    place.gap_rate = next();
    rows.normal = row();
    rows.normal_rate = next();
    for (std::size_t a = 0; a < c.slip.size(); ++a) {
      place.slip[a] = next();
      rows.tangential.push_back(row());
      rows.tangential_rate[a] = next();
    }
    rows.friction = next();
    rows.static_friction = next();
    place.restitution = next();
    rows.rough = c.rough();
    rows.under = c.under;
    const long double size = std::hypot(place.slip[0], place.slip[1]);
    rows.direction = size > 0 ? std::array<long double, 2>{place.slip[0] / size, place.slip[1] / size}
                              : std::array<long double, 2>{1, 0};
    // A velocity within the round-off of the earlier velocities is zero.
    constexpr long double kZero = 1e-13L;
    for (std::size_t along = 0; along < rows.tangential.size(); ++along) {
      const std::vector<long double>& t = rows.tangential[along];
      long double without = place.slip[along];  // the velocity of a belt
      for (std::size_t i = 0; i < n_; ++i) {
        place.slip_reach = std::max(place.slip_reach, std::abs(t[i] * most_[i]));
        place.slip_scale = std::max(place.slip_scale, std::abs(t[i] * met_[i]));
        without -= t[i] * at.qd[i];
      }
      place.slip_reach = std::max(place.slip_reach, std::abs(without));
      place.slip_scale = std::max(place.slip_scale, std::abs(without));
    }
    rows.moves = size > kZero * place.slip_reach && size > 0;
    problem_.contacts.push_back(std::move(rows));
    places_.push_back(place);
  }
}

bool ContactDynamics::note_fall(const ContactState& at) {
  const auto free = of_modes(problem_, ContactModes(contacts_.size()));
  bool more = false;
  for (std::size_t a = 0; free && a < n_; ++a) {
    const long double v = std::sqrt(std::abs(free->x[a]) * (1 + std::abs(static_cast<long double>(at.q[a]))));
    more = more || v > most_[a];
    most_[a] = std::max(most_[a], v);
  }
  return more;
}

void ContactDynamics::pass(const ContactState& from, const ContactState& to) {
  // This part of the terms of a difference is round-off, which matters for a short segment.
  constexpr long double kDifference = 1e-15L;
  const long double time = Rational(to.t - from.t).get_d();
  if (!(time > 0)) return;
  most_.resize(n_, 0);
  for (std::size_t a = 0; a < n_; ++a) {
    const long double way = std::abs(static_cast<long double>(to.q[a]) - from.q[a]),
                      terms = std::abs(to.q[a]) + std::abs(from.q[a]);
    most_[a] = std::max(most_[a], (way - kDifference * terms) / time);
  }
}

ContactProblem ContactDynamics::impact(const std::vector<bool>& touches, std::optional<long double> restitution) const {
  ContactProblem p;
  p.A = problem_.A;
  p.Phi = problem_.Phi;
  p.b.assign(n_, 0);
  p.beta.assign(problem_.beta.size(), 0);
  for (std::size_t c = 0; c < contacts_.size(); ++c) {
    ContactRows rows = problem_.contacts[c];
    const Place& place = places_[c];
    const long double e = restitution.value_or(place.restitution);
    rows.normal_rate = (1 + e) * place.gap_rate;
    rows.tangential_rate = place.slip;
    rows.static_friction = rows.friction;  // impulses have one coefficient
    rows.moves = false;
    rows.may_touch = touches[c];
    if (!touches[c]) rows.normal.assign(n_, 0), rows.normal_rate = 0;
    p.contacts.push_back(std::move(rows));
  }
  return p;
}

ContactProblem ContactDynamics::stop() const {
  ContactProblem p = impact(std::vector<bool>(contacts_.size(), true), 0);
  p.beta = constraint_rates_;
  for (ContactRows& rows : p.contacts) rows.friction = 0;
  return p;
}

long double ContactDynamics::slip_acceleration(std::size_t c, const std::vector<long double>& accelerations) const {
  const ContactRows& rows = problem_.contacts[c];
  std::array<long double, 2> a = rows.tangential_rate;
  for (std::size_t k = 0; k < rows.tangential.size(); ++k)
    for (std::size_t i = 0; i < accelerations.size(); ++i) a[k] += rows.tangential[k][i] * accelerations[i];
  return std::hypot(a[0], a[1]);
}

bool ContactDynamics::loses_rank(std::size_t c) const {
  if (n_ < independent_.size() + 1 + contacts_[c].slip.size()) return false;
  ContactModes modes(contacts_.size());
  modes[c].touch = Touch::sticks;
  return !of_modes(problem_, modes);
}

static bool all_finite(const std::vector<long double>& row) {
  return std::all_of(row.begin(), row.end(), [](long double x) { return std::isfinite(x); });
}

bool ContactDynamics::has_values() const {
  return all_finite(problem_.b) && all_finite(problem_.beta) &&
         std::all_of(problem_.A.begin(), problem_.A.end(), all_finite) &&
         std::all_of(problem_.Phi.begin(), problem_.Phi.end(), all_finite);
}

bool ContactDynamics::has_derivatives(std::size_t c) const {
  const ContactRows& rows = problem_.contacts[c];
  return std::isfinite(places_[c].gap_rate) && std::isfinite(rows.normal_rate) && all_finite(rows.normal);
}

bool ContactDynamics::has_slip(std::size_t c) const {
  const ContactRows& rows = problem_.contacts[c];
  const Place& at = places_[c];
  return all_finite({at.slip[0], at.slip[1], rows.tangential_rate[0], rows.tangential_rate[1]}) &&
         std::all_of(rows.tangential.begin(), rows.tangential.end(), all_finite);
}

bool ContactDynamics::velocities_hold() const {
  constexpr long double kOfTerms = 1e-14L;
  for (std::size_t r = 0; r < constraint_rates_.size(); ++r) {
    long double terms = 0;
    for (std::size_t a = 0; a < n_; ++a) terms = std::max(terms, std::abs(problem_.Phi[r][a] * velocities_[a]));
    if (std::abs(constraint_rates_[r]) > kOfTerms * terms) return false;
  }
  return true;
}

std::optional<std::vector<double>> ContactDynamics::nearest(const std::vector<double>& qd,
                                                            const ContactState& at) const {
  ContactProblem p = stop();
  p.contacts.clear();
  for (std::size_t r = 0; r < p.Phi.size(); ++r)
    for (std::size_t a = 0; a < n_; ++a) p.beta[r] += p.Phi[r][a] * (static_cast<long double>(qd[a]) - at.qd[a]);
  const auto jump = of_modes(p, {});
  if (!jump) return std::nullopt;
  std::vector<double> list;
  for (std::size_t a = 0; a < n_; ++a) list.push_back(static_cast<double>(qd[a] + jump->x[a]));
  return list;
}

}  // namespace anholon
