#include "model/loads.h"

namespace anholon {

namespace {

void apply(std::vector<Load>& loads, const Model& model, const Force::Place& place, const Vector& force) {
  Load& load = loads[place.body];
  load.force = load.force + force;
  if (!place.at_center) load.torque = load.torque + cross(place.point - model.bodies[place.body].center, force);
}

}  // namespace

std::vector<Load> given_loads(const Model& model) {
  Graph& g = *model.graph;
  std::vector<Load> loads(model.bodies.size(), Load{zero_vector(g), zero_vector(g)});
  for (std::size_t b = 0; b < model.bodies.size(); ++b)
    if (!is_zero(model.bodies[b].gravity)) loads[b].force = model.bodies[b].mass * model.bodies[b].gravity;
  // A field that varies over the body turns the body: sum e_k u_k x (dg/dr u_k), to first order in the body's size.
  for (std::size_t b = 0; b < model.bodies.size(); ++b) {
    const std::vector<Vector>& by = model.bodies[b].gravity_gradient;
    if (by.empty()) continue;
    for (const Axis& axis : model.bodies[b].axes) {
      const Vector x = axis.vector.x * by[0], y = axis.vector.y * by[1], z = axis.vector.z * by[2];
      loads[b].torque = loads[b].torque + axis.weight * cross(axis.vector, x + y + z);
    }
  }
  const Expr minus = g.number(-1);
  for (const Force& f : model.forces) {
    switch (f.kind) {
    case Force::Kind::vector:
      apply(loads, model, f.on, f.vector);
      if (f.from) apply(loads, model, *f.from, minus * f.vector);
      break;
    case Force::Kind::torque:
      loads[f.on.body].torque = loads[f.on.body].torque + f.vector;
      if (f.from) loads[f.from->body].torque = loads[f.from->body].torque - f.vector;
      break;
    case Force::Kind::tension: {
      const Vector line = f.from->point - f.on.point;
      const Vector pull = (f.tension * pow(dot(line, line), {-1, 2})) * line;
      apply(loads, model, f.on, pull);
      apply(loads, model, *f.from, minus * pull);
      break;
    }
    case Force::Kind::generalized:
      break;
    }
  }
  return loads;
}

std::vector<Load> reactive_loads(const Model& model) {
  Graph& g = *model.graph;
  std::vector<Load> loads(model.bodies.size(), Load{zero_vector(g), zero_vector(g)});
  for (std::size_t b = 0; b < model.bodies.size(); ++b) {
    const Body& body = model.bodies[b];
    if (!body.expelled_velocity) continue;
    const Expr mdot = total_derivative(put_masses(model, body.mass));
    const Vector thrust = mdot * *body.expelled_velocity;
    loads[b].force = thrust;
    loads[b].torque = cross(body.exit_point - body.center, thrust);
  }
  return loads;
}

namespace {

// Returns the force and torque that the body's motion requires.
Load of_motion(const Model& model, const Body& body) {
  Graph& g = *model.graph;
  const Vector &omega = model.observer.spin, &a0 = model.observer.origin_acceleration;
  const Vector omega_dot = total_derivative(omega);
  const auto acceleration = [&](const Vector& place) {
    const Vector v = total_derivative(place), two_v = g.number(2) * v;
    Vector a = total_derivative(v);
    if (!is_zero(omega)) a = a + cross(omega_dot, place) + cross(omega, cross(omega, place)) + cross(omega, two_v);
    return a;
  };
  Load total{zero_vector(g), zero_vector(g)};
  if (!is_zero(body.mass)) {
    const Vector a = acceleration(body.center);
    total.force = total.force + body.mass * (a + a0);
  }
  for (const Axis& axis : body.axes) {
    const Vector a = acceleration(axis.vector);
    total.torque = total.torque + cross(axis.vector, axis.weight * a);
  }
  return total;
}

using Put = Column (*)(const Model&, std::span<const Expr>);

Load difference(const Model& model, const Load& total, const Load& given, const Load& reactive, Put put) {
  const Expr parts[] = {
      total.force.x - given.force.x - reactive.force.x,    total.force.y - given.force.y - reactive.force.y,
      total.force.z - given.force.z - reactive.force.z,    total.torque.x - given.torque.x - reactive.torque.x,
      total.torque.y - given.torque.y - reactive.torque.y, total.torque.z - given.torque.z - reactive.torque.z};
  const Column r = put(model, std::span<const Expr>(parts));
  return {{r[0], r[1], r[2]}, {r[3], r[4], r[5]}};
}

}  // namespace

std::vector<Load> reactions(const Model& model) {
  std::vector<Load> total;
  for (const Body& body : model.bodies) total.push_back(of_motion(model, body));
  const std::vector<Load> given = given_loads(model), reactive = reactive_loads(model);
  for (std::size_t b = 0; b < total.size(); ++b)
    total[b] = difference(model, total[b], given[b], reactive[b], put_masses);
  return total;
}

Load reaction(const Model& model, std::size_t b) {
  const Load total = of_motion(model, model.bodies[b]);
  const std::vector<Load> given = given_loads(model), reactive = reactive_loads(model);
  return difference(model, total, given[b], reactive[b], put_varying_masses);
}

}  // namespace anholon
