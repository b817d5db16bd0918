#include "mechanics/conserved.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "expr/degree.h"
#include "expr/generic_point.h"
#include "expr/normal.h"
#include "formula/units.h"
#include "model/jumps.h"
#include "tape/point.h"

namespace anholon {

namespace {

// Affine fields are searched for up to this number of coordinates; beyond it, only constant ones.
constexpr std::size_t kMostAffine = 8;
constexpr std::size_t kMostConstant = 60;
// Thresholds of linear algebra in double at random points of order 1: for the rank, and for a number to be taken as a
// fraction.
constexpr double kRankThreshold = 1e-8, kFraction = 1e-6;
constexpr int kLargestDenominator = 12;
// The threshold for sums of terms of order 1 to 1e6 that vanish, after round-off.
constexpr double kVanishing = 1e-6;

bool free_of(Expr e, std::initializer_list<Kind> kinds) {
  const Graph& g = *e.graph;
  for (NodeId id : symbols({&e, 1}))
    if (std::find(kinds.begin(), kinds.end(), g.node(id).kind) != kinds.end()) return false;
  return true;
}
bool free_of_time(Expr e) { return free_of(e, {Kind::time, Kind::given}); }
bool constant(Expr e) { return free_of(e, {Kind::time, Kind::given, Kind::jet, Kind::multiplier, Kind::mass}); }
template <class Test>
bool each(const Vector& v, Test test) {
  return test(v.x) && test(v.y) && test(v.z);
}

// Returns values between -2 and 2 that depend on the symbol and the point alone; parameters and masses are positive.
PointValues random_point(std::uint64_t point) {
  return PointValues([point](const Node& n) {
    const double unit = generic_value(n, point);
    return n.kind == Kind::parameter || n.kind == Kind::mass ? 0.4 + 1.2 * unit
           : n.kind == Kind::pi                              ? 3.14159265358979323846
                                                             : 4 * unit - 2;
  });
}

bool small_at_points(Expr e) {
  for (std::uint64_t k = 1; k <= 3; ++k) {
    PointValues at = random_point(1000 + k);
    if (!(std::abs(at(e)) < kVanishing)) return false;
  }
  return true;
}

// True if e is far from zero at a point where it has a value. This test is needed because many roots defeat the exact
// refutation, and the normal form of a nonzero expression may be long.
bool nonzero_at_a_point(Expr e) {
  constexpr double kFar = 1e-3;
  for (std::uint64_t k = 1; k <= 3; ++k) {
    PointValues at = random_point(2000 + k);
    if (const double v = at(e); std::isfinite(v) && std::abs(v) > kFar) return true;
  }
  return false;
}

bool vanishes(Expr e) { return is_zero(e) || (!nonzero_at_a_point(e) && proved_zero(e)); }

// ---- energy ------------------------------------------------------------------------------------

// Returns a potential of a force F that is homogeneous of degree k in its position r: U = -F.r/(k + 1). Constant
// forces, springs and inverse squares are tried; the proof is power + dU/dt = 0.
std::optional<Expr> homogeneous_potential(Expr product, Expr power) {
  for (const Rational& factor : {Rational(-1), Rational(-1, 2), Rational(1)}) {
    const Expr u = factor * product;
    if (free_of_time(u) && vanishes(power + total_derivative(u))) return u;
  }
  return std::nullopt;
}

// True if the reaction N of constraint r has no power on the motion: its power is lambda times dphi/dt if phi depends
// on q alone, and times degree * phi if phi is homogeneous in q'.
bool without_power(const Mechanics& m, std::size_t r) {
  if (m.order[r] == 0 && free_of(m.phi[r], {Kind::time, Kind::given, Kind::state, Kind::control, Kind::mass}))
    return true;
  if (m.order[r] == 1 &&
      homogeneous_degree(m.phi[r], [](const Node& n) { return n.kind == Kind::jet && n.order == 1; }))
    return true;
  Expr rate = m.graph().zero();
  for (std::size_t a = 0; a < m.q.size(); ++a) rate += partial(m.N[a], m.lambda[r]) * m.qd[a];
  if (vanishes(rate)) return true;
  if (m.order[r] == 0) return vanishes(rate - total_derivative(m.phi[r]));
  for (int degree = 1; m.order[r] == 1 && degree <= 6; ++degree)
    if (vanishes(rate - Rational(degree) * m.phi[r])) return true;
  return false;
}

// Adds the potential of one force; returns false if the force is not conservative.
bool add_force(const Mechanics& m, const Force& f, Column& potentials) {
  Graph& g = m.graph();
  const Model& model = *m.model;
  if (f.kind == Force::Kind::generalized) {
    Expr power = g.zero(), product = g.zero();
    for (const auto& [a, component] : f.generalized) power += component * m.qd[a], product += component * m.q[a];
    if (vanishes(power)) return true;
    const auto u = homogeneous_potential(product, power);
    if (u) potentials.push_back(*u);
    return u.has_value();
  }
  if (f.kind == Force::Kind::torque) {
    Vector rate = model.bodies[f.on.body].orientation ? model.bodies[f.on.body].orientation->rate : zero_vector(g);
    if (f.from && model.bodies[f.from->body].orientation) rate = rate - model.bodies[f.from->body].orientation->rate;
    return each(rate, free_of_time) && vanishes(dot(f.vector, rate));
  }
  // At another point of application the velocity of the material point differs from that of the point.
  if (!f.on.at_center || (f.from && !f.from->at_center)) return false;
  Vector place = model.bodies[f.on.body].center;
  if (f.from) place = place - model.bodies[f.from->body].center;
  if (!each(place, free_of_time)) return false;
  // A tension k (|r| - l) is a sum of homogeneous ones.
  std::vector<Vector> forces;
  if (f.kind == Force::Kind::tension) {
    const Expr along = -pow(dot(place, place), {-1, 2}), tension = expanded(f.tension).value_or(f.tension);
    const bool sum = g.node(tension.id).kind == Kind::sum;
    std::vector<Expr> terms;
    if (sum)
      for (const Term& t : g.terms(tension.id)) terms.push_back(g.rational(t.weight) * Expr{&g, t.node});
    else
      terms.push_back(tension);
    for (Expr t : terms) forces.push_back((t * along) * place);
  } else {
    forces.push_back(f.vector);
  }
  for (const Vector& force : forces) {
    const Expr power = dot(force, total_derivative(place));
    if (vanishes(power)) continue;
    const auto u = homogeneous_potential(dot(force, place), power);
    if (!u) return false;
    potentials.push_back(*u);
  }
  return true;
}

bool add_gravity(const Body& body, Column& potentials) {
  if (is_zero(body.gravity) || is_zero(body.mass)) return true;
  const Expr product = body.mass * dot(body.gravity, body.center);
  if (each(body.gravity, constant)) {
    potentials.push_back(-product);
    return free_of_time(product);
  }
  if (!each(body.center, free_of_time)) return false;
  const auto u = homogeneous_potential(product, body.mass * dot(body.gravity, total_derivative(body.center)));
  if (u) potentials.push_back(*u);
  return u.has_value();
}

// Adds the potential -1/2 sum e u.(dg/dr u) of the torque of a field that varies over the body; returns false if the
// centre moves through the field.
bool add_gravity_gradient(const Body& body, Column& potentials) {
  if (body.gravity_gradient.empty()) return true;
  Graph& g = *body.mass.graph;
  Expr u = g.zero();
  Vector torque = zero_vector(g);
  for (const Axis& axis : body.axes) {
    const Vector x = axis.vector.x * body.gravity_gradient[0], y = axis.vector.y * body.gravity_gradient[1],
                 z = axis.vector.z * body.gravity_gradient[2];
    const Vector field = x + y + z;
    u += Rational(-1, 2) * (axis.weight * dot(axis.vector, field));
    torque = torque + axis.weight * cross(axis.vector, field);
  }
  const Expr power = dot(torque, body.orientation->rate), rate = total_derivative(u);
  if (!free_of_time(u) || !vanishes(power + rate)) return false;
  potentials.push_back(u);
  return true;
}

bool add_observer(const Mechanics& m, Column& potentials) {
  const Observer& o = m.model->observer;
  if (!each(o.origin_acceleration, constant) || !each(o.spin, constant) || !free_of_time(m.V_O) ||
      !free_of_time(m.V_omega))
    return false;
  if (!is_zero(m.V_O)) potentials.push_back(m.V_O);
  if (is_zero(o.spin)) return true;
  potentials.push_back(m.V_omega);
  // Coriolis forces have no power if the positions do not depend on t.
  return std::all_of(m.points.begin(), m.points.end(),
                     [](const WeightedPoint& p) { return each(p.place, free_of_time); });
}

std::optional<Conserved> energy(const Mechanics& m) {
  const Model& model = *m.model;
  if (!model.masses.empty() || !free_of_time(m.T)) return std::nullopt;
  for (std::size_t r = 0; r < m.phi.size(); ++r)
    if (!without_power(m, r)) return std::nullopt;
  Expr dissipated = m.graph().zero();
  for (std::size_t a = 0; a < m.q.size(); ++a) dissipated += m.qd[a] * m.QD[a];
  if (!vanishes(dissipated)) return std::nullopt;
  Column parts;
  if (!add_observer(m, parts)) return std::nullopt;
  for (const Potential& p : model.potentials) {
    if (!free_of_time(p.value)) return std::nullopt;
    parts.push_back(p.value);
  }
  for (const Body& body : model.bodies)
    if (!add_gravity(body, parts) || !add_gravity_gradient(body, parts)) return std::nullopt;
  for (const Force& f : model.forces)
    if (!add_force(m, f, parts)) return std::nullopt;
  // A force without a potential would violate the balance.
  const Power balance = power(m);
  const Expr rate =
      balance.noncons + total_derivative(put_masses(model, sum(parts.empty() ? Column{m.graph().zero()} : parts)));
  if (!small_at_points(rate)) return std::nullopt;
  const bool scleronomic =
      std::all_of(m.points.begin(), m.points.end(), [](const WeightedPoint& p) { return each(p.place, free_of_time); });
  Conserved e;
  e.name = model.observer.inertial && scleronomic ? "energy" : "Jacobi integral";
  e.because = "every force has a potential or no power";
  e.terms.push_back(scleronomic ? m.T : balance.h);
  for (Expr u : parts)
    if (!is_zero(u)) e.terms.push_back(u);
  e.terms = put_masses(model, e.terms);
  e.value = sum(e.terms);
  return e;
}

// ---- momenta -----------------------------------------------------------------------------------

// dT/dq' and dT/dq + G + sum mdot d(dT/dq')/dm, and Phi, with masses substituted. If the observer rotates, the momentum
// is that of the velocities v + omega x rho, which a symmetry conserves: Coriolis forces are then the rate of its
// second part.
struct Rates {
  Column momentum, rate;
  std::vector<Column> phi;
};
Rates rates(const Mechanics& m) {
  const Model& model = *m.model;
  Graph& g = m.graph();
  Rates r;
  r.momentum = gradient(m.T, m.qd);
  r.rate = gradient(m.T, m.q) + forces(m);
  if (!is_zero(model.observer.spin)) {
    Column places, seeds;
    for (const WeightedPoint& p : m.points) {
      const Vector carried = p.weight * cross(model.observer.spin, p.place);
      for (int i = 0; i < 3; ++i) places.push_back(p.place[i]), seeds.push_back(carried[i]);
    }
    const Column carried = pullback(places, seeds, m.q);
    r.momentum = r.momentum + carried;
    r.rate = r.rate + total_derivative(carried);
  }
  for (std::size_t i = 0; i < model.masses.size(); ++i) {
    const Expr flow = total_derivative(model.masses[i].value);
    for (std::size_t a = 0; a < m.q.size(); ++a) {
      const Expr by_mass = partial(r.momentum[a], g.mass(static_cast<std::uint32_t>(i)));
      if (!is_zero(by_mass)) r.rate[a] += flow * by_mass;
    }
  }
  r.momentum = put_masses(model, r.momentum);
  r.rate = put_masses(model, r.rate);
  for (const Column& row : m.Phi) r.phi.push_back(put_masses(model, row));
  return r;
}

Expr rate_along(const Mechanics& m, const Rates& r, const Column& field) {
  std::vector<Expr> terms;
  for (std::size_t a = 0; a < field.size(); ++a) {
    if (is_zero(field[a])) continue;
    terms.push_back(field[a] * r.rate[a]);
    terms.push_back(total_derivative(field[a]) * r.momentum[a]);
  }
  return terms.empty() ? m.graph().zero() : sum(terms);
}

// Returns solutions x of A x = 0, one for each column that is a combination of the columns before it; its entries in
// other such columns are 0.
std::vector<std::vector<double>> kernel(std::vector<std::vector<double>> a, std::size_t columns) {
  std::vector<std::size_t> pivots, free;
  std::size_t row = 0;
  for (auto& line : a) {
    double largest = 0;
    for (double v : line) largest = std::max(largest, std::abs(v));
    if (largest > 0)
      for (double& v : line) v /= largest;
  }
  for (std::size_t j = 0; j < columns; ++j) {
    std::size_t best = row;
    for (std::size_t i = row; i < a.size(); ++i)
      if (std::abs(a[i][j]) > std::abs(a[best][j])) best = i;
    if (row == a.size() || !(std::abs(a[best][j]) > kRankThreshold)) {
      free.push_back(j);
      continue;
    }
    std::swap(a[row], a[best]);
    const double pivot = a[row][j];
    for (double& v : a[row]) v /= pivot;
    for (std::size_t i = 0; i < a.size(); ++i) {
      if (i == row || a[i][j] == 0) continue;
      const double factor = a[i][j];
      for (std::size_t k = 0; k < columns; ++k) a[i][k] -= factor * a[row][k];
    }
    pivots.push_back(j);
    ++row;
  }
  std::vector<std::vector<double>> list;
  for (std::size_t j : free) {
    std::vector<double> x(columns, 0.0);
    x[j] = 1;
    for (std::size_t i = 0; i < pivots.size(); ++i) x[pivots[i]] = -a[i][j];
    list.push_back(x);
  }
  return list;
}

std::optional<Rational> as_fraction(double x) {
  for (int d = 1; d <= kLargestDenominator; ++d) {
    const double n = std::round(x * d);
    if (std::abs(n) < 1e6 && std::abs(x - n / d) < kFraction) {
      return Rational(static_cast<long>(n), d);
    }
  }
  return std::nullopt;
}

// Returns the affine fields that are candidates.
std::vector<Column> fields(const Mechanics& m, const Rates& r) {
  const std::size_t n = m.q.size();
  Graph& g = m.graph();
  if (n > kMostConstant) return {};
  // The term (a, b) is q_b d/dq_a, (a, n) is d/dq_a; the latter come last, so they are the free ones.
  std::vector<std::pair<std::size_t, std::size_t>> terms;
  if (n <= kMostAffine)
    for (std::size_t a = 0; a < n; ++a)
      for (std::size_t b = 0; b < n; ++b) terms.push_back({a, b});
  for (std::size_t a = n; a-- > 0;) terms.push_back({a, n});
  std::vector<std::vector<double>> lines;
  for (std::uint64_t k = 0; k < terms.size() + 4; ++k) {
    PointValues at = random_point(k);
    std::vector<double> q(n + 1, 1.0), qd(n + 1, 0.0), rate(n), momentum(n);
    for (std::size_t a = 0; a < n; ++a)
      q[a] = at(m.q[a]), qd[a] = at(m.qd[a]), rate[a] = at(r.rate[a]), momentum[a] = at(r.momentum[a]);
    const auto add = [&](const auto& coefficient) {
      std::vector<double> line;
      for (const auto& [a, b] : terms) line.push_back(coefficient(a, b));
      // A point outside the domain of a formula gives no condition.
      if (std::all_of(line.begin(), line.end(), [](double v) { return std::isfinite(v); }))
        lines.push_back(std::move(line));
    };
    add([&](std::size_t a, std::size_t b) { return q[b] * rate[a] + qd[b] * momentum[a]; });
    for (const Column& row : r.phi) {
      std::vector<double> phi;
      for (Expr e : row) phi.push_back(at(e));
      add([&](std::size_t a, std::size_t b) { return q[b] * phi[a]; });
    }
  }
  if (lines.size() < terms.size()) return {};
  std::vector<Column> list;
  for (const std::vector<double>& x : kernel(std::move(lines), terms.size())) {
    std::vector<std::vector<std::pair<Rational, Expr>>> parts(n);
    bool plain = true;
    for (std::size_t k = 0; k < terms.size() && plain; ++k) {
      const auto c = as_fraction(x[k]);
      plain = c.has_value();
      const auto [a, b] = terms[k];
      if (plain && *c != 0) parts[a].push_back({*c, b < n ? m.q[b] : g.one()});
    }
    if (!plain) continue;
    Column field;
    for (const auto& p : parts) field.push_back(g.sum(p));
    list.push_back(field);
  }
  return list;
}

std::string name_of(const Model& model, const Column& field) {
  Graph& g = *model.graph;
  std::string name;
  std::size_t terms = 0;
  std::size_t last = 0;
  for (std::size_t a = 0; a < field.size(); ++a) {
    if (is_zero(field[a])) continue;
    ++terms;
    last = a;
    std::string part = print(field[a], model.names, Format::text);
    if (g.node(field[a].id).kind == Kind::sum && g.terms(field[a].id).size() > 1) part = "(" + part + ")";
    part = (part == "1" ? "" : part == "-1" ? "-" : part + "*") + "d/d" + model.coordinates[a].name;
    if (!name.empty()) name += part[0] == '-' ? " - " : " + ";
    name += name.empty() || part[0] != '-' ? part : part.substr(1);
  }
  return terms == 1 && field[last] == g.one() ? "momentum of " + model.coordinates[last].name
                                              : "momentum along " + name;
}

// Sets the coordinates that determine the unit of c, from a component of the field that is a number, or a coordinate
// times a number.
void find_units(const Model& model, const Column& field, Conserved& c) {
  Graph& g = *model.graph;
  for (std::size_t a = 0; a < field.size(); ++a) {
    if (is_zero(field[a])) continue;
    if (g.node(field[a].id).kind == Kind::number) {
      c.along = a, c.by.reset();
      return;
    }
    for (std::size_t b = 0; b < field.size(); ++b)
      for (const Expr& q : {g.jet(static_cast<std::uint32_t>(b), 0), -g.jet(static_cast<std::uint32_t>(b), 0)})
        if (field[a] == q) c.along = a, c.by = b;
  }
}

std::optional<Dimension> dimension_of(const Model& model, std::size_t coordinate) {
  if (coordinate >= model.coordinate_units.size() || model.coordinate_units[coordinate].empty()) return std::nullopt;
  if (model.coordinate_units[coordinate] == "1") return Dimension{};
  const std::optional<Unit> unit = read_unit(model.coordinate_units[coordinate]);
  return unit ? std::optional(unit->dimension) : std::nullopt;
}

}  // namespace

std::string unit_of(const Model& model, const Conserved& c) {
  if (std::all_of(model.coordinate_units.begin(), model.coordinate_units.end(),
                  [](const std::string& unit) { return unit.empty(); }))
    return "";
  if (!c.along) return c.name.rfind("momentum", 0) == 0 ? "" : "J";
  Dimension d = read_unit("J*s")->dimension;
  const auto along = dimension_of(model, *c.along), by = c.by ? dimension_of(model, *c.by) : Dimension{};
  if (!along || !by) return "";
  for (std::size_t k = 0; k < d.size(); ++k) d[k] += (*by)[k] - (*along)[k];
  return print(d);
}

Expr momentum_rate(const Mechanics& m, const Column& field) { return rate_along(m, rates(m), field); }

// True if a potential may jump where a motion along the field leads: there its force is a pulse.
static bool meets_jump(const Model& model, const Mechanics& m, const Column& field) {
  return std::any_of(model.potentials.begin(), model.potentials.end(), [&](const Potential& p) {
    return may_jump(model, put_controls(model, {&p.value, 1})[0], [&](Expr s) {
      Expr along = m.graph().zero();
      for (std::size_t a = 0; a < field.size(); ++a) along += partial(s, m.q[a]) * field[a];
      return !vanishes(along);
    });
  });
}

// True if a constraint may jump: velocities then jump, and energy is lost.
static bool constraints_may_jump(const Mechanics& m) {
  const auto jumps = [&](Expr e) { return may_jump(*m.model, put_controls(*m.model, {&e, 1})[0]); };
  for (const Expr& phi : m.phi)
    if (jumps(phi)) return true;
  for (const Column& row : m.Phi)
    if (std::any_of(row.begin(), row.end(), jumps)) return true;
  return false;
}

static std::vector<Conserved> conserved_between_jumps(const Mechanics& m) {
  std::vector<Conserved> list;
  if (auto e = energy(m)) list.push_back(std::move(*e));
  const Model& model = *m.model;
  const Rates r = rates(m);
  for (const Column& field : fields(m, r)) {
    bool admissible = true;
    for (const Column& row : r.phi) {
      Expr along = m.graph().zero();
      for (std::size_t a = 0; a < field.size(); ++a) along += row[a] * field[a];
      admissible = admissible && vanishes(along);
    }
    Expr reaction = m.graph().zero();
    for (std::size_t a = 0; a < field.size(); ++a) reaction += put_masses(model, m.N[a]) * field[a];
    if (!admissible || !vanishes(reaction) || !vanishes(rate_along(m, r, field))) continue;
    Conserved p;
    for (std::size_t a = 0; a < field.size(); ++a)
      if (!is_zero(field[a])) p.terms.push_back(field[a] * r.momentum[a]);
    p.value = sum(p.terms);
    if (vanishes(p.value)) continue;
    p.name = name_of(model, field);
    find_units(model, field, p);
    p.jumps = meets_jump(model, m, field);
    p.because = "the kinetic energy, the forces and the constraints do not change along it";
    list.push_back(std::move(p));
  }
  return list;
}

std::vector<Conserved> conserved(const Mechanics& m) {
  std::vector<Conserved> list = conserved_between_jumps(m);
  const bool of_constraints = constraints_may_jump(m);
  for (Conserved& c : list)
    c.jumps = c.jumps || may_jump(*m.model, c.value) || (of_constraints && c.name.rfind("momentum", 0) != 0);
  return list;
}

void for_each_expression(Conserved& c, const ExprVisitor& f) {
  auto& [name, because, value, terms, jumps, along, by] = c;
  for_each_expression_of(f, name, because, value, terms, jumps, along, by);
}

}  // namespace anholon
