#include "observe/floors/supports.h"

#include <algorithm>
#include <cmath>

#include "numeric/number.h"
#include "setup/notes_on_multipliers.h"

namespace anholon {

namespace {

// True if a constraint has one equation, determines its own multiplier, and is kept by a force.
bool stands_alone(const Scenario& s, std::size_t r) {
  const Constraint& c = s.model->constraints[r];
  return c.name.find('.') == std::string::npos && !c.by &&
         std::find(s.redundant.begin(), s.redundant.end(), r) == s.redundant.end();
}

// The least rise of a normal that carries enough of the weight.
constexpr double kLeastRise = 0.05;

// The gradient of a residual with respect to the place of the body or system that the directions move.
std::optional<Triple> gradient(PlaceRates& rates, const std::vector<std::size_t>& coordinates, std::size_t body,
                               std::size_t residual) {
  std::vector<Triple> directions;
  std::vector<double> slopes;
  for (const std::size_t a : coordinates) {
    rates.look(a);
    directions.push_back(rates.center(body));
    slopes.push_back(rates.residual(residual));
  }
  return gradient_in_space(directions, slopes);
}

std::vector<std::size_t> coordinates_of(const Translations& t) {
  std::vector<std::size_t> list;
  for (const Translation& x : t.all) list.push_back(x.coordinate);
  return list;
}

std::vector<std::size_t> all_coordinates(const Scenario& s) {
  std::vector<std::size_t> list(s.model->coordinates.size());
  for (std::size_t a = 0; a < list.size(); ++a) list[a] = a;
  return list;
}

}  // namespace

std::vector<Support> floors(const Scenario& s, const std::optional<Translations>& found) {
  if (!found) return {};
  std::vector<Triple> free;
  for (const Translation& t : found->all) free.push_back(t.along);
  if (basis(free).size() < 2) return {};
  std::vector<Support> list;
  for (std::size_t k = 0; k < found->geometric.size(); ++k) {
    const std::size_t r = found->geometric[k];
    if (!stands_alone(s, r)) continue;
    if (const std::optional<Triple>& n = found->gradients[k]) {
      if (!(norm(*n) > 0) || !found->normal || !(dot(*found->normal, found->up) > kLeastRise)) continue;
      list.push_back({r, dot(*n, *found->normal), Support::Kind::floor, found->level()});
      continue;
    }
    if (events_set_numbers(*s.model)) continue;
    Workspace own(s);
    PlaceRates rates(own, {r});
    if (!rates.known()) continue;
    rates.go(0);
    const std::optional<Triple> n = gradient(rates, coordinates_of(*found), 0, 0);
    if (n && std::abs(dot(*n, found->up)) > kLeastRise * norm(*n))
      list.push_back({r, dot(*n, found->up) > 0 ? 1.0 : -1.0, Support::Kind::ground, false});
  }
  return list;
}

namespace {

// All rates at one place.
struct Rates {
  std::vector<Triple> weights;                         // of the bodies
  std::vector<std::vector<Triple>> centers;            // of each body by each coordinate
  std::vector<std::vector<std::vector<double>>> axes;  // the same for axes
  std::vector<std::vector<double>> slopes;  // of each constraint, by coordinates or velocities according to its order
};

Rates all_rates(const Scenario& s, PlaceRates& rates, double away) {
  const std::vector<Constraint>& constraints = s.model->constraints;
  Rates all;
  all.slopes.resize(constraints.size());
  const std::size_t bodies = s.model->bodies.size();
  all.centers.resize(bodies), all.axes.resize(bodies);
  const bool rolls = std::any_of(constraints.begin(), constraints.end(), [](const auto& c) { return c.order == 1; });
  rates.go(away);
  for (std::size_t a = 0; a < s.model->coordinates.size(); ++a)
    for (int order = 0; order <= (rolls ? 1 : 0); ++order) {
      rates.look(a, static_cast<unsigned>(order));
      for (std::size_t c = 0; c < constraints.size(); ++c)
        if (constraints[c].order == order) all.slopes[c].push_back(rates.residual(c));
      for (std::size_t b = 0; order == 0 && b < bodies; ++b)
        all.centers[b].push_back(rates.center(b)), all.axes[b].push_back(rates.axes(b));
    }
  for (std::size_t b = 0; b < bodies; ++b) all.weights.push_back(rates.weight(b));
  return all;
}

// Finds the body that a constraint carries, and the other constraints that hold it.
class Carried {
 public:
  Carried(const Scenario& s, PlaceRates& rates) : s_(s) {
    for (const double away : {0.0, 0.31, -0.73}) places_.push_back(all_rates(s, rates, away));
  }

  std::optional<Support> support(std::size_t r, std::size_t body) const {
    Support found{r, 0, Support::Kind::carrier, false, body};
    for (const Rates& at : places_) {
      if (!moves_alone(at, body)) return std::nullopt;
      const std::optional<Triple> n = gradient_in_space(at.centers[body], at.slopes[r]);
      if (!n || !(norm(*n) > 0)) return std::nullopt;
      if (found.upwards == 0) {
        const double rise = -dot(*n, at.weights[body]) / (norm(*n) * norm(at.weights[body]));
        if (!(std::abs(rise) > kLeastRise)) return std::nullopt;
        found.upwards = rise > 0 ? 1 : -1;
      }
      found.rolls.clear();
      for (std::size_t c = 0; c < s_.model->constraints.size(); ++c)
        if (c != r && !leaves(at, c, *n, found)) return std::nullopt;
    }
    return found;
  }

 private:
  static bool moves(const Rates& at, std::size_t body, std::size_t a) {
    const std::vector<double>& axes = at.axes[body][a];
    return norm(at.centers[body][a]) > 0 || std::any_of(axes.begin(), axes.end(), [](double x) { return x != 0; });
  }
  // True if the coordinates of a body move no other body.
  static bool moves_alone(const Rates& at, std::size_t body) {
    for (std::size_t a = 0; a < at.centers[body].size(); ++a)
      for (std::size_t b = 0; moves(at, body, a) && b < at.centers.size(); ++b)
        if (b != body && moves(at, b, a)) return false;
    return true;
  }
  // True if another constraint leaves the weight to this one: it does not hold the centre of the body; it holds the
  // centre across the plane of normal and weight; or it is one of velocities that holds the centre along the surface.
  bool leaves(const Rates& at, std::size_t c, const Triple& n, Support& found) const {
    const Constraint& other = s_.model->constraints[c];
    const std::vector<double>& slopes = at.slopes[c];
    const std::vector<Triple>& centers = at.centers[found.body];
    const std::vector<std::vector<double>>& axes = at.axes[found.body];
    bool holds = false;
    for (std::size_t a = 0; a < slopes.size(); ++a) holds = holds || (slopes[a] != 0 && norm(centers[a]) > 0);
    if (!holds) return true;
    const auto across = [](const Triple& a, const Triple& b) {
      return std::abs(dot(a, b)) <= kSameRate * norm(a) * norm(b);
    };
    if (other.order == 0) {
      const std::optional<Triple> m = gradient_in_space(centers, slopes);
      return m && across(*m, n) && across(*m, at.weights[found.body]);
    }
    const std::string name = other.name.substr(0, other.name.find('.'));
    if (found.rolls.empty() || found.rolls.back() != name) found.rolls.push_back(name);
    return works_nothing(slopes, centers, axes, n);
  }
  // True if a constraint of velocities has no part in the force along n: some motion of the coordinates moves the body
  // along n without turning it, and does not change the constraint.
  static bool works_nothing(const std::vector<double>& slopes, const std::vector<Triple>& centers,
                            const std::vector<std::vector<double>>& axes, const Triple& n) {
    // Such a motion exists if it lies in the span of the columns, which are orthogonalized.
    std::vector<std::vector<double>> columns;
    for (std::size_t a = 0; a < slopes.size(); ++a) {
      std::vector<double> column = axes[a];
      column.insert(column.end(), {centers[a].x, centers[a].y, centers[a].z, slopes[a]});
      columns.push_back(std::move(column));
    }
    std::vector<double> left(columns[0].size(), 0);
    left[left.size() - 4] = n.x, left[left.size() - 3] = n.y, left[left.size() - 2] = n.z;
    const auto product = [](const std::vector<double>& a, const std::vector<double>& b) {
      double sum = 0;
      for (std::size_t i = 0; i < a.size(); ++i) sum += a[i] * b[i];
      return sum;
    };
    const auto take = [&](std::vector<double>& from, const std::vector<double>& e) {
      const double part = product(from, e);
      for (std::size_t i = 0; i < from.size(); ++i) from[i] -= part * e[i];
    };
    constexpr double kDependent = 1e-9;
    for (std::size_t a = 0; a < columns.size(); ++a) {
      const double before = std::sqrt(product(columns[a], columns[a]));
      for (std::size_t b = 0; b < a; ++b) take(columns[a], columns[b]), take(columns[a], columns[b]);
      const double size = std::sqrt(product(columns[a], columns[a]));
      const bool independent = size > kDependent * before;
      for (double& x : columns[a]) x = independent ? x / size : 0;
      take(left, columns[a]);
    }
    return std::sqrt(product(left, left)) <= kDependent * norm(n);
  }

  const Scenario& s_;
  std::vector<Rates> places_;
};

}  // namespace

std::vector<Support> carriers(const Scenario& s, const std::vector<Support>& known) {
  const Model& m = *s.model;
  if (m.bodies.empty() || !m.unknown_functions.empty() || events_set_numbers(m)) return {};
  const auto in_doubt = [](const Constraint& c) { return c.order > 1 || c.by; };
  if (std::any_of(m.constraints.begin(), m.constraints.end(), in_doubt)) return {};
  std::vector<std::size_t> candidates;
  for (std::size_t r = 0; r < m.constraints.size(); ++r)
    if (m.constraints[r].order == 0 && stands_alone(s, r) && !s.classes[r].rheonomic &&
        std::none_of(known.begin(), known.end(), [&](const Support& f) { return f.constraint == r; }))
      candidates.push_back(r);
  if (candidates.empty()) return {};
  std::vector<std::size_t> all(m.constraints.size());
  for (std::size_t r = 0; r < all.size(); ++r) all[r] = r;
  Workspace own(s);
  PlaceRates rates(own, all);
  if (!rates.known()) return {};
  const Carried carried(s, rates);
  std::vector<Support> list;
  for (const std::size_t r : candidates)
    for (std::size_t b = 0; b < m.bodies.size(); ++b)
      if (const std::optional<Support> found = carried.support(r, b)) {
        list.push_back(*found);
        break;
      }
  return list;
}

// ---- along a run -----------------------------------------------------------------------------------------------------

static const std::string kLooks = "' looks like a ", kCarriesWeight = "' carries '",
                         kFrom = " from t = ", kAtMost = ", at most with ";

bool is_of_support(const std::string& note) {
  return (note.find(kLooks) != std::string::npos || note.find(kCarriesWeight) != std::string::npos) &&
         note.find(kFrom) != std::string::npos;
}

std::string without_size_of_pull(std::string note) {
  const std::size_t at = note.find(kAtMost), end = note.find(": ", at);
  if (at != std::string::npos && end != std::string::npos) note.erase(at, end - at);
  return note;
}

SupportWatch::SupportWatch(const Scenario& s, std::vector<Support> supports) : s_(s), start_(to_double(s.state.t)) {
  for (const Support& support : supports) {
    Load& load = loads_.emplace_back(support);
    const std::vector<std::size_t> group = s.undetermined.group_of(support.constraint);
    const auto left_out = [&](std::size_t r) {
      return std::find(s.redundant.begin(), s.redundant.end(), r) != s.redundant.end();
    };
    // The rows are parallel if all follow from a single one.
    if (group.size() == static_cast<std::size_t>(std::count_if(group.begin(), group.end(), left_out)) + 1)
      for (const std::size_t r : group)
        if (r != support.constraint) load.parallel.push_back(r);
    if (support.kind != Support::Kind::floor) varying_.push_back(support.constraint);
  }
}

bool SupportWatch::Load::see(double t, double force) {
  if (!std::exchange(any, true)) carries = force > 0;
  largest = std::max(largest, std::abs(force));
  // The round-off of a support that bears nothing is no pull.
  constexpr double kNothing = 1e-9;
  const bool pulling = force < 0 && -force > kNothing * largest;
  if (pulling && !pulls) pulls = t;
  return pulling;
}

double SupportWatch::length_of_gradient(const Support& support, double t) {
  if (!rates_) {
    Workspace own(s_);
    rates_ = std::make_unique<PlaceRates>(own, varying_);
    rates_->go(0);
  }
  rates_->go(t, q_);
  const auto k =
      static_cast<std::size_t>(std::find(varying_.begin(), varying_.end(), support.constraint) - varying_.begin());
  const auto n = gradient(*rates_, all_coordinates(s_), support.body, k);
  return n ? norm(*n) : 0;
}

void SupportWatch::Load::pull(double t, double force) {
  if (force < least) least = force, least_t = t;
}

std::string SupportWatch::note(const Load& l) const {
  const Support& support = l.support;
  const Constraint& c = s_.model->constraints[support.constraint];
  const std::string since = kFrom + number_text(*l.pulls, 6) + " on" +
                            (l.least < 0 ? kAtMost + number_text(-l.least, 3) + " at t = " + number_text(l.least_t, 6)
                                         : ""),
                    turned = support.upwards > 0 ? "" : " turned round, the larger side on the left",
                    begin = "constraint '" + c.name;
  if (support.kind == Support::Kind::carrier) {
    std::string text =
        begin + kCarriesWeight + s_.model->bodies[support.body].name + "' at the start, and its force is turned round" +
        since + ": a rod, a wire or a guide bears that, and a surface would have to pull; where it can only push, ";
    if (support.rolls.empty())
      return text + "one_sided = true in the constraint lets it open, with the equation " + c.equation + turned +
             others_that_hold(support.constraint);
    text += "a [[contact]] with its gap and slip in place of the constraints '" + c.name + "'";
    for (const std::string& name : support.rolls) text += ", '" + name + "'";
    return text + " lets it open";
  }
  return begin + kLooks + (support.kind == Support::Kind::floor ? "floor" : "ground") + " and pulls" +
         (support.level ? " down" : "") + since +
         ": a body that may lift would leave it; one_sided = true in the constraint lets it open, with the equation " +
         c.equation + turned + others_that_hold(support.constraint);
}

// The second step of the advice: the other constraints that hold the direction of this one must not hold it either.
std::string SupportWatch::others_that_hold(std::size_t constraint) const {
  std::vector<std::size_t> others = s_.undetermined.group_of(constraint);
  std::erase(others, constraint);
  if (others.empty()) return {};
  std::vector<std::string> names;
  for (const std::size_t r : others) names.push_back("'" + s_.model->constraints[r].name + "'");
  return ", together with " + without_constraints(*s_.model, others, true) + ", because " + joined_names(names) +
         (others.size() > 1 ? " hold" : " holds") + " the same direction";
}

std::vector<std::string> SupportWatch::notes() const {
  std::vector<std::string> list;
  for (const Load& l : loads_)
    if (l.pulls && (l.support.kind != Support::Kind::carrier || l.carries)) list.push_back(note(l));
  return list;
}

}  // namespace anholon
