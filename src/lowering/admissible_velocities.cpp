#include "lowering/admissible_velocities.h"

#include <algorithm>
#include <cmath>

#include "system/cleared.h"

namespace anholon {

namespace {
// A pivot is at least this part of the largest candidate.
constexpr double kPivot = 1e-2;
}  // namespace

bool AdmissibleVelocities::solve(const Column& constraints) {
  for (refused = 0; refused < constraints.size(); ++refused)
    if (!solve(constraints[refused])) return false;
  for (Expr& d : definitions) d = eliminated(d);
  return true;
}

// Returns nullopt if the constraint is not linear in the free velocities.
std::optional<AdmissibleVelocities::Row> AdmissibleVelocities::row(Expr constraint) {
  Row r{constraint, tidy_(solved(constraint)), {}, {}, g_.zero()};
  const Expr phi = written_out(r.by_names);
  const Column by = gradient(phi, free);
  if (std::any_of(by.begin(), by.end(), [&](Expr e) { return contains(e, free); })) return std::nullopt;
  auto [a, rest] = linear(phi, free, tidy_);
  r.a = std::move(a), r.rest = rest;
  for (std::size_t i = 0; i < free.size(); ++i)
    if (!is_zero(r.a[i])) r.in.push_back(i), r.largest = std::max(r.largest, std::abs(at_(r.a[i])));
  for (const std::size_t i : r.in)
    if (std::abs(at_(r.a[i])) >= kPivot * r.largest)
      if (const std::size_t c = varying_nodes(r.a[i]); c < r.cost) r.best = i, r.cost = c;
  r.pair = pair_of(r);
  return r;
}

std::optional<AdmissibleVelocities::Row::Pair> AdmissibleVelocities::pair_of(const Row& r) {
  // If there are more than two velocities and no part without velocities, later constraints clear the poles.
  if (r.cost == 0 || (r.in.size() > 2 && is_zero(r.rest))) return std::nullopt;
  for (std::size_t k = 0; k < r.in.size(); ++k)
    for (std::size_t l = k + 1; l < r.in.size(); ++l) {
      const std::size_t v = r.in[k], w = r.in[l];
      const Expr square = tidy_(pow(r.a[v], 2) + pow(r.a[w], 2));
      if (r.in.size() == 2 || (is_constant(square) && at_(square) > 0)) return Row::Pair{v, w, square};
    }
  return std::nullopt;
}

bool AdmissibleVelocities::solve(Expr constraint) {
  if (const Expr whole = cleared(constraint); whole != constraint)
    if (const auto r = row(whole); r && r->largest > 0 && (r->cost == 0 || r->pair)) {
      clears_poles = true;
      solve(*r);
      return true;
    }
  const auto r = row(constraint);
  if (!r) {
    why = "is not linear in the velocities";
    return false;
  }
  if (!(r->largest > 0)) {
    why = "determines no further velocity at the start";
    return false;
  }
  solve(*r);
  return true;
}

void AdmissibleVelocities::solve(const Row& r) {
  const Column& a = r.a;
  if (r.pair) {
    // a v + b w + c = 0 without division by a or b: v = b u - a c/(a^2 + b^2), w = -a u - b c/(a^2 + b^2).
    const auto [v, w, square] = *r.pair;
    const Expr u = new_name(), u_by_velocity = (a[w] * free_by_velocity_[v] - a[v] * free_by_velocity_[w]) / square;
    std::vector<Expr> terms{r.rest};
    for (const std::size_t i : r.in)
      if (i != v && i != w) terms.push_back(a[i] * free[i]);
    const Expr others = sum(terms);
    const auto beside = [&](Expr along, std::size_t i) {
      return is_zero(others) ? along : tidy_(along - a[i] * others / square);
    };
    const Expr of_v = beside(a[w] * u, v), of_w = beside(-a[v] * u, w);
    // The later one is removed first, because removal moves the ones after it.
    remove(w, of_w);
    remove(v, of_v);
    free.push_back(u);
    free_by_velocity_.push_back(u_by_velocity);
    return;
  }
  pivots.push_back(a[r.best]);
  if (r.cost == 0)
    if (const auto d = direction(r.constraint); d && partial(r.by_names, free[r.best]) == a[r.best]) {
      define(r.best, tidy_(-put(r.by_names, {free[r.best]}, {g_.zero()}) / a[r.best]));
      name_speed(*d);
      return;
    }
  std::vector<Expr> terms{r.rest};
  for (const std::size_t i : r.in)
    if (i != r.best) terms.push_back(a[i] * free[i]);
  remove(r.best, tidy_(-sum(terms) / a[r.best]));
}

// Returns the direction if X and Y occur unchanged in phi.
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

// Names the speed u, with X = b u, Y = -a u from now on, also in the velocities of points that are reached from this
// one.
void AdmissibleVelocities::name_speed(const Direction& d) {
  const Expr u = new_name(), speed = tidy_(solved(d.b * d.X - d.a * d.Y) / (pow(d.a, 2) + pow(d.b, 2)));
  named.push_back(u);
  definitions.push_back(speed);
  points_.push_back({d.X, d.b * u});
  points_.push_back({d.Y, -d.a * u});
}

// Substitutes velocities of points, the latest point first.
Expr AdmissibleVelocities::by_points(Expr e) const {
  if (points_.empty()) return e;
  std::unordered_map<NodeId, Expr> image;
  for (NodeId id : reachable({&e, 1}))
    if (g_.node(id).kind == Kind::sum)
      for (auto point = points_.rbegin(); point != points_.rend() && !image.count(id); ++point)
        if (const std::optional<Expr> rest = without(id, point->first.id)) image.emplace(id, *rest + point->second);
  return replace_nodes({&e, 1}, image)[0];
}

// Returns a sum less another one that it contains, term by term; nullopt if it does not contain it.
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

// Returns e without names.
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
