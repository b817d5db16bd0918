// Tabulated functions: polynomials between knots, whose coefficients are step functions of the argument.
//
//   f(x) = c0(x) + d (c1(x) + d (c2(x) + d c3(x))),  d = x - knot(x)
//
// so that differentiation, Taylor arithmetic and kinks are those of step functions. All coefficients are exact
// rationals.
#pragma once
#include <optional>

#include "expr/expr.h"

namespace anholon {

enum class Fit : std::uint8_t {
  hold,      // the value of the knot below; jumps
  linear,    // continuous
  monotone,  // cubic, one continuous derivative, no overshoot (Fritsch & Carlson 1980, Butland's harmonic mean)
  spline,    // cubic, two continuous derivatives, natural (second derivative 0 at the ends)
};
// Beyond the first and the last knot: the value there, the tangent there, or not to be used.
enum class Outside : std::uint8_t { hold, linear, error };

struct Table {
  std::string name;
  std::vector<Rational> x, y;  // x strictly ascending, as many y, at least two
  Fit fit = Fit::linear;
  Outside outside = Outside::hold;
};

// The coefficients laid down in a graph.
class TableFunction {
 public:
  TableFunction(Graph& g, const Table& table);
  Expr operator()(Expr x) const;

 private:
  std::uint32_t knot_;
  std::vector<std::uint32_t> coefficients_;
};

// How many continuous derivatives a fit has; -1: it jumps.
int smoothness(Fit fit);

// The name of a table in e whose derivative of this order would be wrong, as it is not continuous below it; nothing if
// there is none.
std::optional<std::string> too_rough(Expr e, int derivative);

}  // namespace anholon
