// Vectors by their components along the observer's axes, and rotations composed turn by turn.
#include "formula/formula.h"

namespace anholon {

Vector operator+(const Vector& a, const Vector& b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
Vector operator-(const Vector& a, const Vector& b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
Vector operator*(Expr k, const Vector& a) { return {k * a.x, k * a.y, k * a.z}; }
Expr dot(const Vector& a, const Vector& b) {
  const Expr parts[] = {a.x * b.x, a.y * b.y, a.z * b.z};
  return sum(parts);
}
Vector cross(const Vector& a, const Vector& b) {
  // Operands are created one after the other: otherwise the compiler's order of evaluation would number the nodes.
  const auto difference = [](Expr p, Expr q, Expr r, Expr s) {
    const Expr second = r * s, first = p * q;
    return first - second;
  };
  return {difference(a.y, b.z, a.z, b.y), difference(a.z, b.x, a.x, b.z), difference(a.x, b.y, a.y, b.x)};
}
Vector zero_vector(Graph& g) { return {g.zero(), g.zero(), g.zero()}; }
bool is_zero(const Vector& a) { return is_zero(a.x) && is_zero(a.y) && is_zero(a.z); }
Vector total_derivative(const Vector& a) {
  const Expr parts[] = {a.x, a.y, a.z};
  const Column d = total_derivative(std::span<const Expr>(parts));
  return {d[0], d[1], d[2]};
}
Vector operator*(const Rotation& r, const Vector& a) {
  const Vector z = a.z * r[2], y = a.y * r[1], x = a.x * r[0];
  return x + y + z;
}
Vector transpose_times(const Rotation& r, const Vector& a) { return {dot(r[0], a), dot(r[1], a), dot(r[2], a)}; }
Rotation operator*(const Rotation& a, const Rotation& b) {
  return {{a * b[0], a * b[1], a * b[2]},
          a.rate + a * b.rate,
          transpose_times(b, a.own_rate) + b.own_rate,
          a.by_turns && b.by_turns};
}
Rotation identity_rotation(Graph& g) {
  const Vector zero = zero_vector(g);
  return {
      {{g.one(), g.zero(), g.zero()}, {g.zero(), g.one(), g.zero()}, {g.zero(), g.zero(), g.one()}}, zero, zero, true};
}

Rotation turn(int axis, Expr angle) {
  Graph& g = *angle.graph;
  const int j = (axis + 1) % 3, k = (axis + 2) % 3;
  Rotation r = identity_rotation(g);
  r.columns[j][j] = r.columns[k][k] = cos(angle);
  r.columns[j][k] = sin(angle);
  r.columns[k][j] = -sin(angle);
  r.rate[axis] = r.own_rate[axis] = total_derivative(angle);
  return r;
}

// Rodrigues' formula: R v = v cos + (a x v) sin + a (a.v)(1 - cos).
Rotation turn(const Vector& a, Expr angle) {
  Graph& g = *angle.graph;
  Rotation r = identity_rotation(g);
  const Rotation e = r;
  const Expr c = cos(angle), s = sin(angle);
  for (int k = 0; k < 3; ++k) r.columns[k] = c * e[k] + s * cross(a, e[k]) + ((1 - c) * a[k]) * a;
  if (!is_zero(total_derivative(a))) return rotation_from_axes(r[0], r[1], r[2]);
  r.rate = r.own_rate = total_derivative(angle) * a;
  return r;
}

Rotation rotation_from_axes(const Vector& x, const Vector& y, const Vector& z) {
  Graph& g = *x.x.graph;
  Rotation r{{x, y, z}, zero_vector(g), zero_vector(g), false};
  for (const Vector& u : r.columns) r.rate = r.rate + cross(u, total_derivative(u));
  r.rate = g.number(Rational(1, 2)) * r.rate;
  r.own_rate = transpose_times(r, r.rate);
  return r;
}

}  // namespace anholon
