#include "lowering/admissible_velocities.h"

#include <algorithm>
#include <cmath>

namespace anholon {

namespace {
// Pivots are at least this part of the largest candidate.
constexpr double kPivot = 1e-2;
}  // namespace

bool AdmissibleVelocities::solve(const Column& constraints) {
  for (refused = 0; refused < constraints.size(); ++refused)
    if (!solve(constraints[refused])) return false;
  for (Expr& d : definitions) d = eliminated(d);
  return true;
}

bool AdmissibleVelocities::solve(Expr constraint) {
  const Expr by_names = tidy_(solved(constraint)), phi = written_out(by_names);
  const Column by = gradient(phi, free);
  if (std::any_of(by.begin(), by.end(), [&](Expr e) { return contains(e, free); })) {
    why = "is not linear in the velocities";
    return false;
  }
  const auto [a, rest] = linear(phi, free, tidy_);
  double largest = 0;
  std::vector<std::size_t> in;
  for (std::size_t i = 0; i < free.size(); ++i)
    if (!is_zero(a[i])) in.push_back(i), largest = std::max(largest, std::abs(at_(a[i])));
  if (!(largest > 0)) {
    why = "determines no further velocity at the start";
    return false;
  }
  std::size_t best = free.size(), cost = SIZE_MAX;
  for (const std::size_t i : in)
    if (std::abs(at_(a[i])) >= kPivot * largest)
      if (const std::size_t c = varying_nodes(a[i]); c < cost) best = i, cost = c;
  if (cost > 0 && in.size() == 2 && is_zero(rest)) {
    // a v + b w = 0 without division: v = b u, w = -a u.
    const std::size_t v = in[0], w = in[1];
    const Expr u = new_name(), u_by_velocity = (a[w] * free_by_velocity_[v] - a[v] * free_by_velocity_[w]) /
                                               tidy_(pow(a[v], 2) + pow(a[w], 2));
    remove(w, -a[v] * u);
    remove(v, a[w] * u);
    free.push_back(u);
    free_by_velocity_.push_back(u_by_velocity);
    return true;
  }
  pivots.push_back(a[best]);
  if (cost == 0)
    if (const auto d = direction(constraint); d && partial(by_names, free[best]) == a[best]) {
      define(best, tidy_(-put(by_names, {free[best]}, {g_.zero()}) / a[best]));
      name_speed(*d);
      return true;
    }
  std::vector<Expr> terms{rest};
  for (const std::size_t i : in)
    if (i != best) terms.push_back(a[i] * free[i]);
  remove(best, tidy_(-sum(terms) / a[best]));
  return true;
}

// Where X and Y stand as they are.
std::optional<AdmissibleVelocities::Direction> AdmissibleVelocities::direction(Expr phi) const {
  if (g_.node(phi.id).kind != Kind::sum || g_.terms(phi.id).size() != 2) return std::nullopt;
  std::vector<std::pair<Expr, Expr>> parts;
  const std::vector<Term> terms(g_.terms(phi.id).begin(), g_.terms(phi.id).end());
  for (const Term& t : terms) {
    if (g_.node(t.node).kind != Kind::product) return std::nullopt;
    std::vector<std::pair<Expr, Rational>> factors;
    std::optional<Expr> velocity;
    for (const Term& f : g_.terms(t.node))
      if (const Expr e{&g_, f.node}; !contains(e, qd_))
        factors.push_back({e, g_.rational(f.weight)});
      else if (velocity || g_.node(f.node).kind != Kind::sum || g_.rational(f.weight) != 1)
        return std::nullopt;
      else
        velocity = e;
    if (!velocity) return std::nullopt;
    const Rational weight = g_.rational(t.weight);
    parts.push_back({weight * g_.product(factors), *velocity});
  }
  return Direction{parts[0].first, parts[0].second, parts[1].first, parts[1].second};
}

// X = b u, Y = -a u from now on, also in the velocities of points that are reached from this one.
void AdmissibleVelocities::name_speed(const Direction& d) {
  const Expr u = new_name(), speed = tidy_(solved(d.b * d.X - d.a * d.Y) / (pow(d.a, 2) + pow(d.b, 2)));
  named.push_back(u);
  definitions.push_back(speed);
  points_.push_back({d.X, d.b * u});
  points_.push_back({d.Y, -d.a * u});
}

// The latest point first.
Expr AdmissibleVelocities::by_points(Expr e) const {
  if (points_.empty()) return e;
  std::unordered_map<NodeId, Expr> image;
  for (NodeId id : reachable({&e, 1}))
    if (g_.node(id).kind == Kind::sum)
      for (auto point = points_.rbegin(); point != points_.rend() && !image.count(id); ++point)
        if (const std::optional<Expr> rest = without(id, point->first.id)) image.emplace(id, *rest + point->second);
  return replace_nodes({&e, 1}, image)[0];
}

// A sum less another one that it contains, term by term.
std::optional<Expr> AdmissibleVelocities::without(NodeId whole, NodeId part) const {
  const std::span<const Term> terms = g_.terms(whole), taken = g_.terms(part);
  std::vector<std::pair<Rational, Expr>> rest;
  std::size_t found = 0;
  for (const Term& t : terms)
    if (found < taken.size() && t.node == taken[found].node && t.weight == taken[found].weight)
      ++found;
    else
      rest.push_back({g_.rational(t.weight), Expr{&g_, t.node}});
  return found == taken.size() ? std::optional<Expr>(g_.sum(rest)) : std::nullopt;
}

Expr AdmissibleVelocities::eliminated(Expr e) const {
  for (std::size_t i = 0; i < gone_.size(); ++i) e = put(e, {gone_[i]}, {values_[i]});
  return e;
}

// Without names.
Expr AdmissibleVelocities::written_out(Expr e) const {
  for (std::size_t i = named.size(); i-- > 0;) e = put(e, {named[i]}, {eliminated(definitions[i])});
  return e;
}

void AdmissibleVelocities::erase(std::size_t i) {
  free.erase(free.begin() + static_cast<std::ptrdiff_t>(i));
  free_by_velocity_.erase(free_by_velocity_.begin() + static_cast<std::ptrdiff_t>(i));
}

void AdmissibleVelocities::remove(std::size_t i, Expr value) {
  gone_.push_back(free[i]);
  values_.push_back(value);
  erase(i);
}

void AdmissibleVelocities::define(std::size_t i, Expr value) {
  named.push_back(free[i]);
  definitions.push_back(value);
  erase(i);
}

}  // namespace anholon
