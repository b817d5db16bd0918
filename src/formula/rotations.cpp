#include "formula/rotations.h"

#include "expr/normal.h"

namespace anholon {

namespace {

// Throws if e is a constant other than `value`. (A varying expression may have this value on the constraints.)
void must_be(Expr e, int value, Span at) {
  const std::optional<Expr> constant = expanded(e - value);
  if (constant && is_number(*constant) && !is_zero(*constant))
    throw Failure(at, "this matrix is no rotation",
                  "its columns are the new axes: of length 1, at right angles, right-handed");
}

}  // namespace

Rotation quaternion(Expr e0, Expr e1, Expr e2, Expr e3) {
  // Products are made one after the other: nodes are numbered in the order of their creation, which must not depend on
  // the compiler.
  const Expr e00 = e0 * e0, e11 = e1 * e1, e22 = e2 * e2, e33 = e3 * e3;
  const Expr e01 = e0 * e1, e02 = e0 * e2, e03 = e0 * e3, e12 = e1 * e2, e13 = e1 * e3, e23 = e2 * e3;
  Vector columns[3];
  columns[0] = {e00 + e11 - e22 - e33, 2 * (e12 + e03), 2 * (e13 - e02)};
  columns[1] = {2 * (e12 - e03), e00 - e11 + e22 - e33, 2 * (e23 + e01)};
  columns[2] = {2 * (e13 + e02), 2 * (e23 - e01), e00 - e11 - e22 + e33};
  return rotation_from_axes(columns[0], columns[1], columns[2]);
}

Rotation euler(const Syntax& call, const std::vector<Value>& values, Graph& g) {
  // The letters arrive as a name: euler(zxz, a, b, c); quotes are part of the TOML string.
  const std::string& letters = call.args[0].text;
  if (letters.size() != values.size() || letters.empty())
    throw Failure(call.args[0].span, "euler takes one angle for each of its axis letters",
                  "euler(zxz, psi, theta, phi)");
  Rotation r = identity_rotation(g);
  for (std::size_t i = 0; i < letters.size(); ++i) {
    if (letters[i] < 'x' || letters[i] > 'z')
      throw Failure(call.args[0].span, "the axes of euler are the letters x, y and z");
    const Expr* angle = std::get_if<Expr>(&values[i]);
    if (!angle) throw Failure(call.args[i + 1].span, "an angle of euler is not a number");
    r = r * turn(letters[i] - 'x', *angle);
  }
  return r;
}

Rotation rotation_matrix(const Syntax& call, Names& names) {
  const Syntax* rows = call.args.size() == 1 ? &call.args[0] : nullptr;
  if (!rows || rows->op != Syntax::Op::array || rows->args.size() != 3)
    throw Failure(call.span, "matrix takes three rows of three numbers", "matrix([[1,0,0],[0,1,0],[0,0,1]])");
  Vector columns[3];
  for (int i = 0; i < 3; ++i) {
    const Syntax& row = rows->args[static_cast<std::size_t>(i)];
    if (row.op != Syntax::Op::array || row.args.size() != 3)
      throw Failure(row.span, "matrix takes three rows of three numbers");
    for (int j = 0; j < 3; ++j) columns[j][i] = evaluate_number(row.args[static_cast<std::size_t>(j)], names);
  }
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j <= i; ++j) must_be(dot(columns[i], columns[j]), i == j, call.span);
  must_be(dot(cross(columns[0], columns[1]), columns[2]), 1, call.span);
  return rotation_from_axes(columns[0], columns[1], columns[2]);
}

}  // namespace anholon
