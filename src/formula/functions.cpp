#include "formula/functions.h"

namespace anholon {

const std::vector<FunctionRow>& function_table() {
  static const std::vector<FunctionRow> table = [] {
    std::vector<FunctionRow> rows = {
        {"sqrt", "sqrt(a)", "root; where its argument touches zero the motion goes on one-sided", "sqrt(x^2 + y^2)",
         DimensionRule::root},
        {"atan2", "atan2(y, x)", "angle of the direction (x, y), between -pi and pi; it jumps at the negative x axis",
         "atan2(y, x)", DimensionRule::angle},
        {"min", "min(a, b)", "the smaller of two numbers; the switch is located and stepped to", "min(x, 1)",
         DimensionRule::alike},
        {"max", "max(a, b)", "the larger of two numbers", "max(x, 0)", DimensionRule::alike},
        {"piecewise", "piecewise(c1, v1, c2, v2, …, else)",
         "the value of the first condition that holds; numbers or vectors", "piecewise(x > 1, 1, x > 0, x, 0)",
         DimensionRule::cases},
        {"choose", "choose(k, v1, v2, …)",
         "the k-th value, k rounded; the first where k is below 1, the last where it is above their number",
         "choose(2, x, y, 0)", DimensionRule::choice},
        {"dot", "dot(a, b)", "scalar product; also `a · b`", "dot(vel(P), B.x)", DimensionRule::dot},
        {"cross", "cross(a, b)", "vector product; also `a × b`", "cross(angvel(plate), B.x)", DimensionRule::cross},
        {"norm", "norm(a)", "length", "norm(vel(P))", DimensionRule::length},
        {"norm2", "norm2(a)", "its square, a·a", "norm2(P)", DimensionRule::square},
        {"unit", "unit(a)", "the vector of length 1 in its direction", "unit(ex + ey)", DimensionRule::direction},
        {"D", "D(a, k)", "the k-th total derivative by time, k = 1…20; `a'`, `a''` are the first two", "D(x, 3)",
         DimensionRule::derivative},
        {"sum", "sum(i, a)", "sum over the range of the letter i of `[index]`", "", DimensionRule::open},
        {"prod", "prod(i, a)", "product over that range", "", DimensionRule::open},
        {"rotx", "rotx(a)", "rotation about x by the angle a; likewise `roty`, `rotz`", "rotx(theta)",
         DimensionRule::rotation},
        {"roty", "roty(a)", "about y", "roty(theta)", DimensionRule::rotation},
        {"rotz", "rotz(a)", "about z", "rotz(theta)", DimensionRule::rotation},
        {"rot", "rot(axis, a)", "about a vector of any length but 0", "rot(ex + ez, theta)", DimensionRule::turn_about},
        {"quat", "quat(e0, e1, e2, e3)",
         "of a quaternion, scalar first; its norm is made a constraint where it is not 1 anyway",
         "quat(cos(theta/2), 0, 0, sin(theta/2))", DimensionRule::rotation},
        {"euler", "euler(zxz, a, b, c)",
         "turns about these axes, one after the other, each about the axis where it then is",
         "euler(zxz, theta, 0.1, x)", DimensionRule::turns},
        {"matrix", "matrix([[…], […], […]])", "by rows; the columns are the new axes",
         "matrix([[0, -1, 0], [1, 0, 0], [0, 0, 1]])", DimensionRule::matrix},
    };
#define ROW(name, derivative, antiderivative, parity, exact, beyond, latex, c, numpy, domain)                          \
  rows.push_back({#name, #name "(a)", std::string(domain).empty() ? "" : std::string("not defined ") + (domain),       \
                  #name "(0.3)", DimensionRule::pure});
#include "expr/elementary.def"
#undef ROW
    for (FunctionRow& r : rows) {
      if (r.name == "acosh") r.example = "acosh(2)";
      if (r.name == "log") r.meaning = "natural logarithm; " + r.meaning;
      if (r.name == "abs") r.meaning = "|a|; its kink is located and stepped to", r.dimension = DimensionRule::same;
      if (r.name == "sign")
        r.meaning = "1, -1, and 0 at 0; its jump is located and stepped to", r.dimension = DimensionRule::number;
    }
    return rows;
  }();
  return table;
}

std::vector<std::string> function_names() {
  std::vector<std::string> names;
  for (const FunctionRow& r : function_table()) names.push_back(r.name);
  return names;
}

}  // namespace anholon
