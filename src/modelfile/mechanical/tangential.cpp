#include "modelfile/mechanical/tangential.h"

#include <algorithm>
#include <cmath>

#include "expr/normal.h"
#include "modelfile/names/constant.h"

namespace anholon {

// The part of a vector of length 1 that counts as round-off.
static constexpr double kRoundOff = 1e-9;

static void check_tangential(const std::vector<Vector>& directions, const Vector& normal, const Model& model,
                             Span along, const char* hint, std::vector<Identity>& identities) {
  for (const Vector& d : directions) {
    const Expr part = dot(d, normal);
    if (const auto known = constant_value(model, part); known && std::abs(*known) > kRoundOff)
      throw Failure(along, "a direction of the slip has a part along the normal, which is no slip", hint);
    add_identity(
        identities, part, kRoundOff,
        [line = along.line](double) {
          return "a direction of the slip, in line " + std::to_string(line) +
                 ", has a part along the normal, which is no slip";
        },
        hint, along);
  }
}

void check_tangential(const std::vector<Vector>& directions, const Vector& normal, const Model& model, Span along,
                      std::vector<Identity>& identities) {
  check_tangential(directions, normal, model, along, "leave out 'along': two tangential directions are chosen",
                   identities);
}

static Column velocities(const Model& model) {
  Column list;
  for (std::uint32_t a = 0; a < model.coordinates.size(); ++a) list.push_back(model.graph->jet(a, 1));
  return list;
}

// Returns the derivatives of a vector by the velocities.
static std::vector<Vector> columns(const Vector& v, const Column& by) {
  const Column rows[3] = {gradient(v[0], by), gradient(v[1], by), gradient(v[2], by)};
  std::vector<Vector> list;
  for (std::size_t a = 0; a < by.size(); ++a) list.push_back({rows[0][a], rows[1][a], rows[2][a]});
  return list;
}

static bool is_constant(const Model& model, const Vector& v, Expr e) {
  const std::vector<Expr> all = {v[0], v[1], v[2], e};
  const std::vector<NodeId> found = symbols(all);
  return std::all_of(found.begin(), found.end(),
                     [&](NodeId id) { return model.graph->node(id).kind == Kind::parameter; });
}

static bool proved_zero(const Vector& v) { return proved_zero(v[0]) && proved_zero(v[1]) && proved_zero(v[2]); }

static Vector of_length_one(const Vector& v) { return pow(dot(v, v), Rational(-1, 2)) * v; }

// Returns the vector e, a sum of columns, with e*columns[a] = row[a] for all a, scaled to length 1; nullopt if the
// constant columns, made orthogonal, do not give such a vector.
static std::optional<Vector> constant_direction(const Column& row, const std::vector<Vector>& columns,
                                                const Model& model) {
  Graph& g = *model.graph;
  Vector e = zero_vector(g);
  std::vector<Vector> axes;
  for (std::size_t a = 0; a < row.size() && axes.size() < 3; ++a) {
    if (!is_constant(model, columns[a], row[a])) continue;
    Vector u = columns[a];
    for (const Vector& axis : axes) u = u - (dot(u, axis) / dot(axis, axis)) * axis;
    if (proved_zero(u)) continue;
    e = e + ((row[a] - dot(e, columns[a])) / dot(u, u)) * u;
    axes.push_back(u);
  }
  for (std::size_t a = 0; a < row.size(); ++a)
    if (!proved_zero(dot(e, columns[a]) - row[a])) return std::nullopt;
  if (proved_zero(e)) return std::nullopt;
  return of_length_one(e);
}

static Vector owned(Graph& g, const Vector& v) { return {g.own(v[0]), g.own(v[1]), g.own(v[2])}; }

// The check builds in a copy: its nodes in the graph of the model would change the order of terms in later formulas,
// and so their round-off.
void check_tangential(std::vector<Vector> directions, Expr gap, const Vector& v, const Model& of, Span along,
                      std::vector<Identity>& identities) {
  const std::shared_ptr<Model> model = clone(of);
  Graph& g = *model->graph;
  const Column by = velocities(*model);
  const auto normal = constant_direction(gradient(total_derivative(g.own(gap)), by), columns(owned(g, v), by), *model);
  for (Vector& d : directions) d = owned(g, d);
  if (normal)
    check_tangential(directions, *normal, *model, along,
                     "the normal is the gradient of the gap: name one or two directions at right angles to it",
                     identities);
}

// The derivatives of gap' and of a slip velocity by the velocities that they contain.
struct Rows {
  Column velocities, gap, slip;
};

static bool are_proportional(const Rows& rows) {
  for (std::size_t i = 0; i < rows.gap.size(); ++i)
    for (std::size_t j = 0; j < i; ++j)
      if (!proved_zero(rows.gap[i] * rows.slip[j] - rows.gap[j] * rows.slip[i])) return false;
  return !rows.gap.empty();
}

// True if the quotient of proportional rows is proved to hold parameters only.
static bool have_constant_quotient(const Rows& rows) {
  for (std::size_t i = 0; i < rows.gap.size(); ++i) {
    const Expr n = rows.gap[i], t = rows.slip[i];
    if (proved_zero(n)) continue;
    for (const NodeId id : symbols(std::vector<Expr>{n, t}))
      if (const Expr x{n.graph, id};
          n.graph->node(id).kind != Kind::parameter && !proved_zero(partial(t, x) * n - t * partial(n, x)))
        return false;
    return true;
  }
  return false;
}

// True if the velocities move all bodies along fixed directions, without turning them.
static bool move_straight(const Column& velocities, const Model& model) {
  for (const Body& b : model.bodies) {
    if (b.orientation)
      for (const Vector& rate : columns(b.orientation->rate, velocities))
        if (!proved_zero(rate)) return false;
    for (const Vector& v : columns(total_derivative(b.center), velocities))
      if (!is_constant(model, v, model.graph->zero())) return false;
  }
  return true;
}

// True if a slip velocity is a multiple of gap' and is known to be along the normal: the factor is constant, or the
// bodies move along fixed directions. Otherwise a multiple may be tangential: a point that moves on a curve has one
// coordinate, and each component of its velocity is a multiple of the rate of this coordinate.
static bool is_along_normal(Expr gap, Expr slip, const Model& of) {
  Rows rows;
  const Expr rate = total_derivative(gap);
  for (const NodeId id : symbols(std::vector<Expr>{rate, slip}))
    if (const Node& n = slip.graph->node(id); n.kind == Kind::jet && n.order == 1)
      rows.velocities.push_back(slip.graph->jet(n.index, 1));
  rows.gap = gradient(rate, rows.velocities), rows.slip = gradient(slip, rows.velocities);
  if (!are_proportional(rows)) return false;
  const std::shared_ptr<Model> model = clone(of);
  for (Column* c : {&rows.velocities, &rows.gap, &rows.slip})
    for (Expr& e : *c) e = model->graph->own(e);
  return have_constant_quotient(rows) || move_straight(rows.velocities, *model);
}

// The derivatives of gap and slip by the velocities of the coordinates that they contain, and the velocity of all
// bodies that move with these coordinates.
struct MovedTogether {
  Column gap, slip;
  std::vector<Vector> velocity;
};

// Returns nullopt if the bodies move differently or turn, because then it is not known which of their points touches.
static std::optional<MovedTogether> moved_together(Expr gap, Expr slip, const Model& model) {
  const Column by = velocities(model), n = gradient(total_derivative(gap), by), t = gradient(slip, by);
  MovedTogether m;
  std::vector<std::size_t> moved;
  for (std::size_t a = 0; a < by.size(); ++a)
    if (!is_zero(n[a]) || !is_zero(t[a])) moved.push_back(a), m.gap.push_back(n[a]), m.slip.push_back(t[a]);
  const auto of_moved = [&](const Vector& v) {
    const std::vector<Vector> all = columns(v, by);
    std::vector<Vector> list;
    for (const std::size_t a : moved) list.push_back(all[a]);
    return list;
  };
  for (const Body& b : model.bodies) {
    if (b.orientation)
      for (const Vector& rate : of_moved(b.orientation->rate))
        if (!proved_zero(rate)) return std::nullopt;
    const std::vector<Vector> own = of_moved(total_derivative(b.center));
    if (std::all_of(own.begin(), own.end(), [](const Vector& c) { return proved_zero(c); })) continue;
    for (std::size_t k = 0; k < m.velocity.size(); ++k)
      if (!proved_zero(own[k] - m.velocity[k])) return std::nullopt;
    m.velocity = own;
  }
  if (m.velocity.empty()) return std::nullopt;
  return m;
}

static bool is_partly_normal(Expr gap, Expr slip, const Model& model) {
  const std::optional<MovedTogether> m = moved_together(gap, slip, model);
  if (!m) return false;
  const auto n = constant_direction(m->gap, m->velocity, model), t = constant_direction(m->slip, m->velocity, model);
  const auto part = n && t ? constant_value(model, dot(*n, *t)) : std::nullopt;
  return part && std::abs(*part) > kRoundOff;
}

void check_slips(Expr gap, const std::vector<Expr>& slip, const std::string& contact, Span place, const Model& of,
                 Diagnostics& diagnostics) {
  constexpr const char* kTangential =
      "the components that are tangential to the contact: slip = \"vel(B, P)\", along = [\"ex\", \"ey\"]";
  for (const Expr v : slip)
    if (is_along_normal(gap, v, of))
      throw Failure(place, "a slip velocity is that of the gap: it is along the normal", kTangential);
  const std::shared_ptr<Model> model = clone(of);
  const Column by = velocities(*model);
  bool partly_normal = false;
  for (const Expr v : slip) {
    const Expr own = model->graph->own(v);
    for (const Expr coefficient : gradient(own, by))
      for (const Expr further : gradient(coefficient, by))
        if (!proved_zero(further))
          throw Failure(place, "a slip velocity is linear in the velocities: its sign is that of the slip",
                        kTangential);
    partly_normal = partly_normal || is_partly_normal(model->graph->own(gap), own, *model);
  }
  if (partly_normal)
    diagnostics.warning(place,
                        "the slip velocity of the contact '" + contact +
                            "' has a part along the normal, the gradient of the gap: friction has one, too",
                        kTangential);
}

}  // namespace anholon
