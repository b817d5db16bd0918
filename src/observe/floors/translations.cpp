#include "observe/floors/translations.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace anholon {

namespace {

// A normal whose rise is smaller carries no weight.
constexpr double kCarries = 1e-9;

constexpr double kPlaces[] = {0.0, 0.31, -0.73};  // at which rates are compared, by the distance from the start

std::optional<Translation> translation(PlaceRates& rates, const Scenario& s, std::size_t coordinate,
                                       std::size_t constraints) {
  std::optional<Translation> found;
  for (const double away : kPlaces) {
    rates.go(away);
    rates.look(coordinate);
    const Triple along = rates.center(0);
    const auto same = [&](const Triple& d, const Triple& e) { return norm(d - e) <= kSameRate * norm(e); };
    if (!(norm(along) > 0)) return std::nullopt;
    for (std::size_t b = 0; b < s.model->bodies.size(); ++b)
      if (rates.turns(b) || !same(rates.center(b), along)) return std::nullopt;
    std::vector<double> residuals;
    for (std::size_t k = 0; k < constraints; ++k) residuals.push_back(rates.residual(k));
    if (!found) {
      found = Translation{coordinate, along, residuals};
      continue;
    }
    if (!same(along, found->along)) return std::nullopt;
    // A rate that is not the same everywhere becomes NaN.
    for (std::size_t k = 0; k < constraints; ++k)
      if (!(std::abs(residuals[k] - found->residuals[k]) <= kSameRate * std::abs(residuals[k])))
        found->residuals[k] = std::nan("");
  }
  return found;
}

std::vector<Triple> directions(const Translations& t) {
  std::vector<Triple> list;
  for (const Translation& x : t.all) list.push_back(x.along);
  return list;
}

bool parallel(const Triple& a, const Triple& b) { return norm(cross(a, b)) <= kSameRate * norm(a) * norm(b); }

// Returns the unit normal of a plane with this gradient, against the weight; a normal that is vertical up to round-off is
// made exactly vertical. Returns nullopt if the plane carries no weight.
std::optional<Triple> normal_of(const Triple& plane, const Triple& up) {
  const double rise = dot(plane, up) / norm(plane);
  if (!(std::abs(rise) > kCarries)) return std::nullopt;
  return 1 - std::abs(rise) <= kSameRate ? up : ((rise > 0 ? 1 : -1) / norm(plane)) * plane;
}

// Finds the common normal of the geometric constraints. Returns false if they are not floors.
bool find_floors(Translations& all) {
  bool ground = false;
  std::optional<Triple> plane;
  for (std::size_t k = 0; k < all.geometric.size(); ++k) {
    std::vector<double> rates;
    for (const Translation& t : all.all) rates.push_back(t.residuals[k]);
    const auto is = [](auto f) { return [f](double x) { return f(x); }; };
    const bool same = std::all_of(rates.begin(), rates.end(), is([](double x) { return std::isfinite(x); })),
               held = std::any_of(rates.begin(), rates.end(), is([](double x) { return x != 0; }));
    all.gradients.emplace_back(same ? gradient_in_space(directions(all), rates) : std::nullopt);
    if (!held) continue;
    if (!same) {
      // The height above a ground varies with one coordinate at a constant rate; the length of a rod does not.
      if (std::none_of(rates.begin(), rates.end(), is([](double x) { return std::isfinite(x) && x != 0; })))
        return false;
      ground = true;
      continue;
    }
    const std::optional<Triple>& n = all.gradients.back();
    if (!n || (plane && !parallel(*n, *plane))) return false;
    plane = n;
  }
  if (plane) {
    all.normal = normal_of(*plane, all.up);
    if (!all.normal) return false;
  }
  return !(ground && plane && !all.level());
}

// The normal of a plane that is in no geometric constraint: the translations lie in the plane, except one that may lead
// upwards.
std::optional<Triple> normal_left(const Translations& all) {
  std::vector<Triple> sideways;
  bool upwards = false;
  for (const Translation& t : all.all) {
    const double rise = std::abs(dot(t.along, all.up)) / norm(t.along);
    if (1 - rise <= kSameRate)
      upwards = true;
    else
      sideways.push_back(t.along);
  }
  const std::vector<Triple> plane = basis(sideways);
  if (plane.empty() || plane.size() > 2) return std::nullopt;
  Triple n = all.up;
  for (const Triple& e : plane) n = n - dot(n, e) * e;
  if (upwards && norm(n - all.up) > kSameRate) return std::nullopt;
  if (!(norm(n) > kCarries)) return std::nullopt;
  return norm(n - all.up) <= kSameRate ? all.up : (1 / norm(n)) * n;
}

// The constraints of velocities and their derivatives by the velocities; empty for one whose derivatives are not the
// same everywhere.
std::vector<std::vector<double>> constant_rows(Workspace& s) {
  const Model& model = *s.model;
  std::vector<std::size_t> constraints;
  for (std::size_t r = 0; r < model.constraints.size(); ++r)
    if (model.constraints[r].order == 1 && !model.constraints[r].by) constraints.push_back(r);
  if (constraints.empty()) return {};
  PlaceRates rates(s, constraints);
  if (!rates.known()) return {};
  std::vector<std::vector<double>> rows(constraints.size());
  std::vector<bool> same(constraints.size(), true);
  for (const double away : kPlaces) {
    rates.go(away);
    for (std::size_t a = 0; a < model.coordinates.size(); ++a) {
      rates.look(a, 1);
      for (std::size_t k = 0; k < rows.size(); ++k) {
        if (away == kPlaces[0]) rows[k].push_back(rates.residual(k));
        same[k] = same[k] && std::abs(rates.residual(k) - rows[k][a]) <= kSameRate * std::abs(rows[k][a]);
      }
    }
  }
  for (std::size_t k = 0; k < rows.size(); ++k)
    if (!same[k]) rows[k].clear();
  return rows;
}

// The normal of a plane that constraints of velocities hold, as the normal component of rolling does, z' = 0: with
// constant coefficients they hold the velocities of translations alone.
std::optional<Triple> normal_of_velocities(const Translations& all, Workspace& s) {
  std::optional<Triple> plane;
  for (std::vector<double>& row : constant_rows(s)) {
    if (row.empty()) continue;
    std::vector<double> slopes;
    for (const Translation& t : all.all) slopes.push_back(std::exchange(row[t.coordinate], 0));
    if (std::any_of(row.begin(), row.end(), [](double x) { return x != 0; })) continue;
    const std::optional<Triple> n = gradient_in_space(directions(all), slopes);
    if (!n || !(norm(*n) > 0) || !normal_of(*n, all.up)) continue;
    if (plane && !parallel(*n, *plane)) return std::nullopt;
    plane = n;
  }
  return plane ? normal_of(*plane, all.up) : std::nullopt;
}

}  // namespace

bool events_set_numbers(const Model& m) {
  return std::any_of(m.events.begin(), m.events.end(), [](const Event& e) { return !e.set.empty(); });
}

std::optional<Translations> translations(const Scenario& s) {
  const Model& model = *s.model;
  if (model.bodies.empty() || !model.unknown_functions.empty()) return std::nullopt;
  Translations all;
  for (std::size_t r = 0; r < model.constraints.size(); ++r)
    if (model.constraints[r].order == 0) all.geometric.push_back(r);
  Workspace own(s);
  PlaceRates rates(own, all.geometric);
  rates.go(0);
  rates.look(0);
  Triple weight;
  for (std::size_t b = 0; b < model.bodies.size(); ++b) weight = weight - -1 * rates.weight(b);
  if (!(norm(weight) > 0)) return std::nullopt;
  all.up = (-1 / norm(weight)) * weight;
  for (std::size_t a = 0; a < model.coordinates.size(); ++a)
    if (const auto t = translation(rates, s, a, all.geometric.size())) all.all.push_back(*t);
  if (!find_floors(all)) return std::nullopt;
  const bool ground = std::any_of(all.gradients.begin(), all.gradients.end(), [](const auto& g) { return !g; });
  if (!all.normal && !ground) all.normal = normal_left(all);
  if (!all.normal && !ground) all.normal = normal_of_velocities(all, own);
  if (all.normal)
    all.across = std::any_of(all.all.begin(), all.all.end(), [&](const Translation& t) {
      return std::abs(dot(t.along, *all.normal)) > kSameRate * norm(t.along);
    });
  return all;
}

}  // namespace anholon
