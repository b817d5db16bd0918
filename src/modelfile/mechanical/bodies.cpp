#include "modelfile/mechanical/bodies.h"

#include <algorithm>
#include <cmath>
#include <tuple>

#include "expr/diff.h"
#include "expr/normal.h"
#include "model/jumps.h"
#include "modelfile/mechanical/shapes.h"
#include "modelfile/names/constant.h"
#include "modelfile/text/collect.h"
#include "modelfile/text/keys.h"
#include "tape/tape.h"

namespace anholon {

void BodyReader::declare(const Item& root) {
  std::vector<Entry> found;
  for (const char* key : {"body", "particle"}) {
    const Item* list = root.find(key);
    if (!list) continue;
    for_each_table(*list, key, diagnostics_,
                   [&](const Item& item, std::size_t) { found.push_back({&item, std::string(key) == "particle", 0}); });
  }
  const auto place = [](const Item& i) {
    const Item* name = i.find("name");
    const Span s = name ? name->key_span : i.items.empty() ? i.span : i.items[0].key_span;
    return std::tuple(-static_cast<long>(s.file), s.line, s.column);  // base files come before the files that use them
  };
  std::stable_sort(found.begin(), found.end(),
                   [&](const Entry& a, const Entry& b) { return place(*a.item) < place(*b.item); });
  for (Entry& e : found)
    collect(
        diagnostics_,
        [&] {
          const Item* name = e.item->find("name");
          if (!name || name->kind != Item::Kind::string)
            throw Failure(e.item->span, std::string("a ") + (e.particle ? "particle" : "body") + " has no name",
                          "name = \"…\"");
          e.index = scope_.body_names().size();
          Scope::BodyParts parts;
          parts.particle = e.particle;
          parts.center = e.item->find(e.particle ? "position" : "center");
          if (!e.particle) {
            parts.orientation = e.item->find("orientation");
            parts.angle = e.item->find("angle");
          }
          try {
            scope_.declare_body(normal_name(name->text()), name->formula.whole());
          } catch (...) {
            scope_.parts(e.index) = parts;
            throw;
          }
          scope_.parts(e.index) = parts;
          entries_.push_back(e);
        },
        *e.item);
}

Expr BodyReader::frozen(Expr value, const std::string& name, Span span) {
  Graph& g = *model_.graph;
  for (NodeId id : symbols({&value, 1}))
    if (const Node& n = g.node(id); n.kind == Kind::control)
      if (Control& u = model_.controls[n.index]; u.value && u.put_into.empty()) u.put_into = "the mass '" + name + "'";
  value = put_controls(model_, {&value, 1})[0];
  const bool varies = [&] {
    for (NodeId id : symbols({&value, 1})) {
      const Kind k = g.node(id).kind;
      if (k == Kind::multiplier) throw Failure(span, "a mass cannot depend on a multiplier");
      if (k != Kind::parameter) return true;
    }
    return false;
  }();
  if (!varies) {
    const auto v = constant_value(model_, value);
    if (v && !(*v >= 0) && name.find(" weight") == std::string::npos)
      throw Failure(span, "the mass is " + number_text(*v, 6) + ": a mass is not negative");
    return value;
  }
  const std::size_t index = model_.masses.size();
  model_.masses.push_back({name, name.find(" weight") != std::string::npos, value, span});
  model_.names.masses.push_back("mu." + name);
  return g.mass(static_cast<std::uint32_t>(index));
}

// Checks a position. Positions in a chain are parts of one another, so nodes that were checked are not checked again.
void BodyReader::check_position(const Vector& place, const Item& item, const std::string& what) {
  const Graph& g = *model_.graph;
  for (int i = 0; i < 3; ++i) {
    if (const auto name = scope_.has_tables() ? too_rough(place[i], 2) : std::nullopt)
      throw Failure(
          item.span,
          what + " holds the table '" + *name +
              "', whose fit has no continuous derivative: velocities would jump, and accelerations hold pulses",
          "fit = \"monotone\" has one continuous derivative, fit = \"spline\" two");
    std::vector<NodeId> open = {place[i].id}, symbols;
    bool switches = false;
    while (!open.empty()) {
      const NodeId id = open.back();
      open.pop_back();
      if (!position_nodes_.insert(id).second) continue;
      switches = switches || may_switch(g.node(id));
      if (g.summands(id).empty()) symbols.push_back(id);
      for (const Term& t : g.summands(id)) open.push_back(t.node);
    }
    std::sort(symbols.begin(), symbols.end());
    for (NodeId id : symbols) {
      const Node& n = g.node(id);
      const auto refuse = [&](const std::string& why, const std::string& hint) {
        position_nodes_.clear();  // the next position that contains it is refused as well
        throw Failure(item.span, what + why, hint);
      };
      if (n.kind == Kind::multiplier) refuse(" depends on a multiplier", "");
      if (n.kind == Kind::control &&
          (!model_.controls[n.index].value || jet_order(*model_.controls[n.index].value) >= 0))
        refuse(" depends on the input '" + model_.controls[n.index].name +
                   "', which is not a function of time and states",
               "bind the coordinate by a constraint kept by this input");
      if (n.kind == Kind::jet && n.order > 0)
        refuse(" depends on a velocity (" + derivative_name(model_.names.coordinates[n.index], n.order, Format::text) +
                   ")",
               "positions are formulas of coordinates and t; write velocities as constraints");
      switches = switches || n.kind == Kind::control;
    }
    if (switches) check_jumps(place[i], item, what);
  }
}

// Refuses positions that jump or have a kink in time: a kink in a coordinate acts only if the motion reaches it, but
// one in time makes every acceleration a pulse.
void BodyReader::check_jumps(Expr position, const Item& item, const std::string& what) {
  const Expr e = put_controls(model_, {&position, 1})[0];
  const bool itself = jumps_at_a_point(model_, e, holds_time);
  if (!itself && !jumps_at_a_point(model_, partial(e, model_.graph->time()), holds_time)) return;
  position_nodes_.clear();  // the next position that contains it is refused as well
  throw Failure(item.span,
                what + (itself ? " jumps" : " moves with a velocity that jumps") +
                    ": velocities would jump, and accelerations hold pulses",
                "write a smooth function of t");
}

void BodyReader::read() {
  for (const Entry& e : entries_)
    scope_.parts(e.index).body_failed = !collect(diagnostics_, [&] { read_body(e); }, *e.item);
}

void BodyReader::read_body(const Entry& e) {
  Graph& g = *model_.graph;
  const Item& item = *e.item;
  Body body;
  body.name = scope_.body_names()[e.index];
  body.span = item.find("name")->formula.whole();
  body.particle = e.particle;
  body.mass = g.zero();
  body.center = body.gravity = body.exit_point = zero_vector(g);
  // The list keeps its order even if this body is invalid.
  if (model_.bodies.size() <= e.index) model_.bodies.resize(e.index + 1, body);
  const std::string what = (e.particle ? "particle '" : "body '") + body.name + "'";
  check_keys(item, what, e.particle ? "particle" : "body", diagnostics_);

  const Item* center = scope_.parts(e.index).center;
  if (!center)
    throw Failure(body.span, what + " has no " + (e.particle ? "position" : "center"),
                  e.particle ? "position = \"…\"" : "center = \"…\" (its mass centre)");
  body.center = scope_.center(e.index, center->span);
  check_position(body.center, *center, "the position of " + what);

  // Keys of bodies in a particle are reported as unknown keys.
  const Item* inertia = e.particle ? nullptr : item.find("inertia");
  const Item* axes = e.particle ? nullptr : item.find("axes");
  Expr mass_value = body.mass;
  if (const Item* mass = item.find("mass"))
    mass_value = scope_.number(*mass), body.mass = frozen(mass_value, body.name, mass->span);
  else if (e.particle)
    throw Failure(body.span, what + " has no mass", "mass = …");

  if (const Item* both = item.find("angle"); both && item.find("orientation") && !e.particle)
    throw Failure(both->key_span, what + " has both 'angle' and 'orientation'",
                  "angle = a is orientation = \"rotz(a)\"");
  if (scope_.has_orientation(e.index)) {
    const Item& source = item.find("orientation") ? *item.find("orientation") : *item.find("angle");
    body.orientation = scope_.orientation(e.index, source.span);
    for (int k = 0; k < 3; ++k) check_position((*body.orientation)[k], source, "the orientation of " + what);
  }
  if (const Item* shape = e.particle ? nullptr : item.find("shape")) {
    body.shape = read_shape(*shape, scope_, model_);
    // A shape without a mass, or beside an inertia, only serves the picture.
    if (!inertia && !axes && !is_zero(mass_value)) shape_axes(body, mass_value, shape->span);
  }
  if (inertia || axes) read_axes(body, inertia, axes);

  body.exit_point = body.center;
  if (const Item* u = item.find("expelled_velocity")) {
    body.expelled_velocity = scope_.vector(*u);
    if (const Item* p = item.find("exit_point")) {
      if (p->kind == Item::Kind::array && body.orientation)
        body.exit_point = body.center + *body.orientation * scope_.vector(*p);
      else
        body.exit_point = scope_.vector(*p);
      check_position(body.exit_point, *p, "the exit point of " + what);
      if (!body.orientation && !is_zero(body.exit_point - body.center))
        throw Failure(p->key_span, what + " has no orientation: matter can leave at its centre only");
    }
  } else if (const Item* p = item.find("exit_point")) {
    throw Failure(p->key_span, what + " has an exit_point but no expelled_velocity");
  }
  if (scope_.gravity_gradient && !body.axes.empty()) {
    if (!body.orientation)
      throw Failure(body.span, what + " has axes but no orientation: [gravity] gradient finds no torque on it",
                    "give its inertia and orientation instead of axes");
    body.gravity_gradient = scope_.gravity_gradient_at(body.center, body.span);
  }
  if (!is_zero(body.mass)) {
    try {
      body.gravity = scope_.gravity_at(body.center, body.span);
    } catch (const Failure& f) {
      if (f.diagnostic.message != "there is no [gravity] field") throw;
    }
  }
  model_.bodies[e.index] = std::move(body);
}

// Represents the second moments by weighted axes. For J about the body axes, E = 1/2 tr(J) 1 - J; a principal E gives
// the weights of the three axes. Products of inertia are included exactly and without division by E_kl (x_k x_l^T + x_l
// x_k^T) = E_kl [(x_k + x_l)(x_k + x_l)^T - x_k x_k^T - x_l x_l^T].
void BodyReader::read_axes(Body& body, const Item* inertia, const Item* axes) {
  Graph& g = *model_.graph;
  if (inertia && axes) throw Failure(axes->key_span, "the body has both 'inertia' and 'axes'");
  if (axes) {
    for_each_table(*axes, "axes", diagnostics_, [&](const Item& a, std::size_t k) {
      check_keys(a, "an axis", "body.axes", diagnostics_);
      const Item *w = a.find("weight"), *v = a.find("vector");
      if (!w || !v)
        throw Failure(a.span, "an axis has weight and vector",
                      "{weight = \"J/2\", vector = [\"cos(th)\", \"sin(th)\", \"0\"]}");
      Axis axis;
      axis.weight = frozen(scope_.number(*w), body.name + " weight " + std::to_string(k + 1), w->span);
      axis.vector = scope_.vector(*v);
      check_position(axis.vector, *v, "an axis vector of the body");
      body.axes.push_back(axis);
    });
    return;
  }
  if (!body.orientation)
    throw Failure(inertia->key_span, "the body '" + body.name + "' has an inertia but no orientation",
                  "give it orientation = \"…\", or angle = \"…\" in the plane");
  const Expr zero = g.zero(), half = g.number(Rational(1, 2));
  const Column unit[3] = {{g.one(), zero, zero}, {zero, g.one(), zero}, {zero, zero, g.one()}};
  const auto add = [&](Expr weight, const Column& own, const std::string& tag) {
    add_axis(body, weight, own, tag, inertia->span);
  };
  if (inertia->kind != Item::Kind::array) {  // plane: about the z axis, e1 + e2 = J
    const Expr j = scope_.number(*inertia);
    const auto v = constant_value(model_, j);
    if (v && *v < 0)
      throw Failure(inertia->span, "the moment of inertia is " + number_text(*v, 6) + ", and none is negative");
    if (const Vector& w = body.orientation->own_rate; !proved_zero(w.x) || !proved_zero(w.y))
      diagnostics_.warning(inertia->span,
                           "the body '" + body.name +
                               "' turns about other axes than its z axis, and a number J as its "
                               "inertia stands for the moments J/2, J/2, J of a flat disc",
                           "three moments: inertia = [Ixx, Iyy, Izz]");
    add(half * j, unit[0], "x");
    add(half * j, unit[1], "y");
    return;
  }
  if (inertia->items.size() != 3)
    throw Failure(inertia->span, "an inertia is a number (plane), three moments or a 3 x 3 matrix");
  Expr moment[3][3];
  const bool full = inertia->items[0].kind == Item::Kind::array;
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t j = 0; j < 3; ++j) {
      if (full) {
        const Item& row = inertia->items[i];
        if (row.kind != Item::Kind::array || row.items.size() != 3)
          throw Failure(row.span, "an inertia matrix has three rows of three numbers");
        moment[i][j] = scope_.number(row.items[j]);
      } else {
        moment[i][j] = i == j ? scope_.number(inertia->items[i]) : zero;
      }
    }
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t j = 0; j < i; ++j)
      if (!(moment[i][j] == moment[j][i]) && !proved_zero(moment[i][j] - moment[j][i]))
        throw Failure(inertia->span, "the inertia matrix is not symmetric",
                      "J_xy stands twice, with the sign of -∫ x y dm");
  const Item& about_z = full ? inertia->items[2].items[2] : inertia->items[2];
  check_inertia(body, moment, inertia->span,
                about_z.kind == Item::Kind::string ? "\"" + about_z.text() + "\"" : about_z.text());
  const Expr trace2 = half * (moment[0][0] + moment[1][1] + moment[2][2]);
  Expr weight[3];
  for (int k = 0; k < 3; ++k) weight[k] = trace2 - moment[k][k];
  for (int k = 0; k < 3; ++k)
    for (int l = k + 1; l < 3; ++l) {
      const Expr e = -moment[k][l];
      if (is_zero(e)) continue;
      weight[k] = weight[k] - e;
      weight[l] = weight[l] - e;
      Column both = unit[k];
      both[static_cast<std::size_t>(l)] = g.one();
      add(e, both, std::string(1, "xyz"[k]) + "xyz"[l]);
    }
  for (int k = 0; k < 3; ++k) add(weight[k], unit[k], std::string(1, "xyz"[k]));
}

// Adds a weighted axis, given along the body's own axes.
void BodyReader::add_axis(Body& body, Expr weight, const Column& own, const std::string& tag, Span span) {
  if (is_zero(weight)) return;
  const Rotation& r = *body.orientation;
  Axis axis;
  axis.weight = frozen(weight, body.name + " weight " + tag, span);
  axis.vector = r * Vector{own[0], own[1], own[2]};
  if (r.by_turns) axis.own = own;
  body.axes.push_back(axis);
}

// Adds the axes of a shape. If the mass varies, the moments vary, and they are frozen with it.
void BodyReader::shape_axes(Body& body, Expr mass, Span span) {
  if (!body.orientation)
    throw Failure(span, "the body '" + body.name + "' has the inertia of its shape but no orientation",
                  "give it orientation = \"…\", or angle = \"…\" in the plane");
  Graph& g = *model_.graph;
  const Column j = moments(*body.shape, mass);
  const Expr half = g.number(Rational(1, 2)), trace2 = half * sum(j);
  for (std::size_t k = 0; k < 3; ++k) {
    Column own(3, g.zero());
    own[k] = g.one();
    add_axis(body, trace2 - j[k], own, std::string(1, "xyz"[k]), span);
  }
}

// Checks that E = 1/2 tr(J) 1 - J has no negative eigenvalue (for principal axes: each moment is at most the sum of the
// two others).
void BodyReader::check_inertia(const Body& body, const Expr (&moment)[3][3], Span span, const std::string& of_plane) {
  double j[3][3];
  for (int i = 0; i < 3; ++i)
    for (int k = 0; k < 3; ++k) {
      const auto v = constant_value(model_, moment[i][k]);
      if (!v) return;
      j[i][k] = *v;
    }
  for (int i = 0; i < 3; ++i)
    if (j[i][i] < 0)
      throw Failure(span, "the moment of inertia of '" + body.name + "' about " + "xyz"[i] + " is " +
                              number_text(j[i][i], 6) + ", and none is negative");
  const double trace = j[0][0] + j[1][1] + j[2][2], slack = 1e-9 * std::abs(trace);
  double e[3][3];
  for (int i = 0; i < 3; ++i)
    for (int k = 0; k < 3; ++k) e[i][k] = (i == k ? trace / 2 : 0) - j[i][k];
  const double det = e[0][0] * (e[1][1] * e[2][2] - e[1][2] * e[2][1]) -
                     e[0][1] * (e[1][0] * e[2][2] - e[1][2] * e[2][0]) +
                     e[0][2] * (e[1][0] * e[2][1] - e[1][1] * e[2][0]);
  bool wrong = det < -slack * trace * trace;
  for (int i = 0; i < 3; ++i) {
    const int k = (i + 1) % 3;
    if (e[i][i] < -slack || e[i][i] * e[k][k] - e[i][k] * e[k][i] < -slack * std::abs(trace)) wrong = true;
  }
  // A single moment, about z, is meant for a motion in the plane.
  const auto about_one_axis = [&] {
    int moments = 0;
    for (const auto& row : j)
      for (const double v : row) moments += v != 0 ? 1 : 0;
    return moments == 1 && j[2][2] != 0;
  };
  if (wrong)
    throw Failure(span, "no body has this inertia: '" + body.name + "' violates the triangle inequality",
                  about_one_axis() ? "in a motion in the plane one number is enough: inertia = " + of_plane
                                   : "each principal moment is at most the sum of the two others");
}

// ---- forces ----------------------------------------------------------------------------------

Force::Place BodyReader::place(const Item& item) {
  Force::Place p;
  if (item.kind == Item::Kind::string) {
    p.body = scope_.body(normal_name(item.text()), item.formula.whole());
    p.point = scope_.center(p.body, item.span);
    return p;
  }
  if (item.kind != Item::Kind::table) throw Failure(item.span, "a body name or {body = \"…\", at = …} is expected");
  check_keys(item, "the place of a force", "force.on", diagnostics_);
  const Item* body = item.find("body");
  if (!body || body->kind != Item::Kind::string)
    throw Failure(item.span, "the place of a force names a body", "{body = \"…\", at = …}");
  p.body = scope_.body(normal_name(body->text()), body->formula.whole());
  p.point = scope_.center(p.body, item.span);
  if (const Item* at = item.find("at")) {
    const Vector a = scope_.vector(*at);
    p.point =
        at->kind == Item::Kind::array ? scope_.center(p.body, at->span) + scope_.orientation(p.body, at->span) * a : a;
    p.at_center = is_zero(p.point - scope_.center(p.body, at->span));
    if (!p.at_center) scope_.orientation(p.body, at->span);  // the body must have an orientation
  }
  return p;
}

void BodyReader::read_forces(const Item& root) {
  if (const Item* list = root.find("force"))
    for_each_table(*list, "force", diagnostics_, [&](const Item& f, std::size_t k) { read_force(f, k); });
}

void BodyReader::read_force(const Item& item, std::size_t number) {
  Graph& g = *model_.graph;
  check_keys(item, "a force", "force", diagnostics_);
  Force f;
  f.span = item.span;
  const Item* name = item.find("name");
  f.name = name && name->kind == Item::Kind::string ? name->text() : "force" + std::to_string(number + 1);
  f.vector = f.on.point = zero_vector(g);
  f.tension = g.zero();
  const Item* value = nullptr;
  for (const auto& [key, kind] : {std::pair{"vector", Force::Kind::vector},
                                  {"torque", Force::Kind::torque},
                                  {"tension", Force::Kind::tension},
                                  {"generalized", Force::Kind::generalized}}) {
    const Item* i = item.find(key);
    if (!i) continue;
    if (value)
      throw Failure(i->key_span, "a force is given by one of vector, torque, tension, generalized; here are two");
    value = i;
    f.kind = kind;
  }
  if (!value) throw Failure(item.span, "a force has none of vector, torque, tension, generalized");
  if (f.kind == Force::Kind::generalized) {
    if (value->kind != Item::Kind::table)
      throw Failure(value->span, "generalized forces are a table", "generalized = {theta = \"…\"}");
    for (const Item& component : value->items) {
      const auto it = std::find(model_.names.coordinates.begin(), model_.names.coordinates.end(), component.key);
      if (it == model_.names.coordinates.end()) {
        const std::string near = did_you_mean(component.key, model_.names.coordinates);
        throw Failure(component.key_span, "there is no coordinate '" + component.key + "'" +
                                              (near.empty() ? "" : "; did you mean '" + near + "'?"));
      }
      f.generalized.push_back(
          {static_cast<std::size_t>(it - model_.names.coordinates.begin()), scope_.number(component)});
    }
    model_.forces.push_back(std::move(f));
    return;
  }
  const Item *on = item.find("on"), *from = item.find("from");
  if (!on)
    throw Failure(item.span, "the force '" + f.name + "' does not say on what it acts",
                  "on = \"…\", the name of a body or particle");
  f.on = place(*on);
  if (from) f.from = place(*from);
  if (f.kind == Force::Kind::tension) {
    if (!from) throw Failure(item.span, "a tension acts between two places", "from = \"…\"");
    f.tension = scope_.number(*value);
    if (is_zero(f.from->point - f.on.point)) throw Failure(item.span, "a tension between one place and itself");
  } else {
    f.vector = scope_.vector(*value);
  }
  if (f.kind == Force::Kind::torque) {
    for (const Force::Place* p : {&f.on, f.from ? &*f.from : nullptr})
      if (p) scope_.orientation(p->body, value->span);
  }
  model_.forces.push_back(std::move(f));
}

}  // namespace anholon
