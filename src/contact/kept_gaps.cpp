#include "contact/kept_gaps.h"

#include <algorithm>
#include <cmath>

#include "expr/generic_point.h"
#include "numeric/linear.h"
#include "setup/notes_on_multipliers.h"

namespace anholon {

namespace {

// The rows of the constraints of positions and of those linear in velocities, and of the gap of a contact.
class GapRows {
 public:
  GapRows(Workspace& s, const Contact& contact, const std::vector<double>& borders)
      : s_(s), constraints_(linear_constraints(s)), tape_(compile(formulas(contact))),
        machine_(tape_, 0, with_sides(parameter_values<long double>(*s.model), borders)) {}

  // Returns the constraints that keep the gap at this state; empty if it may change.
  std::vector<std::size_t> keep(const ContactState& at) {
    const Matrix<double> rows = at_state(at);
    IndependentConstraints choice = independent(rows);
    choice.redundant = {constraints_.size()};
    const Dependency d = dependencies(rows, choice)[0];
    std::vector<std::size_t> list;
    for (std::size_t k = 0; k < constraints_.size() && !d.empty(); ++k)
      if (d[k] != 0) list.push_back(constraints_[k]);
    return list;
  }

  // Moves the coordinates by the least change so that the geometric constraints hold. Returns false if it does not
  // succeed.
  bool put_on_constraints(ContactState& at) {
    constexpr int kMostSteps = 30;
    constexpr double kHolds = 1e-12;
    const std::size_t n = at.q.size();
    Matrix<double> unit(n, n);
    for (std::size_t a = 0; a < n; ++a) unit(a, a) = 1;
    for (int step = 0; step < kMostSteps; ++step) {
      const Matrix<double> rows = at_state(at);
      std::vector<std::size_t> of;
      double miss = 0;
      for (const std::size_t k : independent(rows).independent)
        if (order(k) == 0) of.push_back(k);
      for (std::size_t k = 0; k < constraints_.size(); ++k)
        if (order(k) == 0) miss = std::max(miss, std::abs(residual(k)));
      if (!std::isfinite(miss)) return false;
      if (miss <= kHolds) return true;
      Matrix<double> kept(of.size(), n);
      std::vector<double> missed, change;
      for (std::size_t i = 0; i < of.size(); ++i) {
        missed.push_back(-residual(of[i]));
        for (std::size_t a = 0; a < n; ++a) kept(i, a) = rows(of[i], a);
      }
      if (!least_change(unit, kept, missed, change)) return false;
      for (std::size_t a = 0; a < n; ++a) at.q[a] += change[a];
    }
    return false;
  }

 private:
  static std::vector<std::size_t> linear_constraints(const Workspace& s) {
    std::vector<std::size_t> list;
    for (std::size_t r = 0; r < s.model->constraints.size(); ++r) {
      const int order = s.mechanics->order[r];
      const Column& row = s.mechanics->Phi[r];
      const bool linear = std::all_of(row.begin(), row.end(), [&](Expr e) { return jet_order(e) < order; });
      if (!s.model->constraints[r].by && (order == 0 || (order == 1 && linear))) list.push_back(r);
    }
    return list;
  }
  int order(std::size_t k) const { return s_.mechanics->order[constraints_[k]]; }

  // For each constraint its row, its residual and its rate; for the gap its row and its rate.
  Column formulas(const Contact& contact) const {
    const Mechanics& m = *s_.mechanics;
    const auto rate = [&](Expr e) { return put_state_rates(*s_.model, total_derivative(e), 1); };
    Column es;
    const auto add = [&](const Column& row) { es.insert(es.end(), row.begin(), row.end()); };
    for (const std::size_t r : constraints_) {
      const Expr phi = put_state_rates(*s_.model, put_masses(*s_.model, m.phi[r]), 1);
      add(gradient(phi, m.order[r] == 0 ? m.q : m.qd));
      es.push_back(phi);
      es.push_back(m.order[r] == 0 ? rate(phi) : phi);
    }
    const Expr gap = s_.graph().own(contact.gap);
    add(gradient(gap, m.q));
    es.push_back(rate(gap));
    return es;
  }

  // The rows of the constraints and of the gap; the last column is the rate with all velocities zero.
  Matrix<double> at_state(const ContactState& at) {
    ContactState still = at;
    std::fill(still.qd.begin(), still.qd.end(), 0.0);
    evaluate_at(still, s_.graph(), machine_);
    const std::size_t n = at.q.size(), s = constraints_.size();
    Matrix<double> rows(s + 1, n + 1);
    for (std::size_t k = 0; k <= s; ++k) {
      for (std::size_t a = 0; a < n; ++a) rows(k, a) = static_cast<double>(machine_.value(k * (n + 2) + a));
      rows(k, n) = static_cast<double>(machine_.value(k * (n + 2) + n + (k < s ? 1 : 0)));
    }
    return rows;
  }
  double residual(std::size_t k) const {
    return static_cast<double>(machine_.value(k * (s_.model->coordinates.size() + 2) + s_.model->coordinates.size()));
  }
  IndependentConstraints independent(const Matrix<double>& rows) const {
    Matrix<double> of_constraints(constraints_.size(), rows.cols);
    std::copy_n(rows.data.begin(), of_constraints.data.size(), of_constraints.data.begin());
    std::vector<int> orders;
    for (std::size_t k = 0; k < constraints_.size(); ++k) orders.push_back(order(k));
    return choose_independent(of_constraints, orders);
  }

  Workspace& s_;
  std::vector<std::size_t> constraints_;
  Tape tape_;
  Machine<long double> machine_;
};

constexpr std::uint64_t kPlaces = 6;

// Another place near the start, at a later time: from 1/3 after the start for the first seed to 341 for the last one.
ContactState elsewhere(const Workspace& s, ContactState at, std::uint64_t seed) {
  constexpr double kMove = 0.4;
  const Graph& g = s.graph();
  for (std::size_t a = 0; a < at.q.size(); ++a)
    at.q[a] += kMove * (generic_value(g.node(s.mechanics->q[a].id), seed) - 0.5) * std::max(1.0, std::abs(at.q[a]));
  constexpr int kLater = 4;  // every time is four times as far from the start as the one before
  Rational later(1, 3);
  for (std::uint64_t k = 1; k < seed; ++k) later *= kLater;
  at.t += later;
  return at;
}

// Returns the constraints that keep the gap of a contact everywhere; empty if it may change somewhere. A drive may keep
// it for a while, so places at late times are looked at, too.
std::vector<std::size_t> keepers(Workspace& s, const Contact& contact, const ContactState& at) {
  if (s.model->constraints.empty()) return {};
  GapRows rows(s, contact, at.borders);
  std::vector<std::size_t> list = rows.keep(at);
  for (std::uint64_t seed = 1; seed <= kPlaces && !list.empty(); ++seed) {
    ContactState there = elsewhere(s, at, seed);
    if (!rows.put_on_constraints(there) || rows.keep(there) != list) return {};
  }
  return list;
}

}  // namespace

Outcome kept_by_constraints(Workspace& s, const TouchingBodies& bodies) {
  for (std::size_t c = 0; c < bodies.contacts.size(); ++c) {
    const Contact& contact = bodies.contacts[c];
    if (contact.under || !bodies.near.closed(c)) continue;
    const std::vector<std::size_t> by = keepers(s, contact, bodies.at);
    if (by.empty()) continue;
    std::vector<std::string> names;
    for (const std::size_t r : by) names.push_back("'" + s.model->constraints[r].name + "'");
    const bool one = by.size() == 1;
    return {OutcomeKind::inconsistent,
            "contact '" + contact.name +
                "' can never open, and carries no force: " + (one ? "the constraint " : "the constraints ") +
                joined_names(names) + (one ? " keeps" : " keep") + " its gap as it is",
            (one ? without_constraints(*s.model, by, true)
                 : std::string("'along' in these constraints with directions along the surface, or one of them left "
                               "out,")) +
                " leaves the direction of the gap to the contact; or leave the contact out",
            contact.span, bodies.at.t.get_d()};
  }
  return {};
}

Outcome kept_by_constraints(const Scenario& s, const std::vector<Contact>& contacts) {
  if (contacts.empty() || s.model->constraints.empty() || contacts.front().held) return {};
  Workspace own(s);
  try {
    const std::vector<Contact> with = with_borders(own, contacts);
    TouchingBodies bodies(own, with, {Rational(s.state.t), s.state.q, s.state.qd, s.state.states});
    bodies.look();
    return kept_by_constraints(own, bodies);
  } catch (const Failure&) {
    return {};
  }
}

}  // namespace anholon
