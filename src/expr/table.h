// Tabulated functions: polynomials between knots, whose coefficients are step functions of the argument.
//
//   f(x) = c0(x) + d (c1(x) + d (c2(x) + d c3(x))),  d = x - knot(x)
//
// so differentiation, Taylor arithmetic and kinks reduce to those of step functions. All coefficients are exact
// rationals.
#pragma once
#include <optional>
#include <string_view>

#include "expr/expr.h"

namespace anholon {

enum class Fit : std::uint8_t {
  hold,      // the value of the knot below; jumps
  linear,    // continuous
  monotone,  // cubic, one continuous derivative, no overshoot (Fritsch & Carlson 1980, Butland's harmonic mean)
  spline,    // cubic, two continuous derivatives, natural (second derivative 0 at the ends)
};
// The rule beyond the first and the last knot: the value there, the tangent there, or an error.
enum class Outside : std::uint8_t { hold, linear, error };

struct Table {
  std::string name;
  std::vector<Rational> x, y;  // x strictly ascending, as many y, at least two
  Fit fit = Fit::linear;
  Outside outside = Outside::hold;
};

// A table whose coefficients are stored in a graph.
class TableFunction {
 public:
  TableFunction(Graph& g, const Table& table);
  Expr operator()(Expr x) const;

 private:
  std::uint32_t knot_;
  std::vector<std::uint32_t> coefficients_;
};

// True if `member` names a piece of a table f, f.knot or f.c0, f.c1, …, which is a step function.
bool is_piece_of_table(std::string_view member);

// Returns the number of continuous derivatives of a fit; -1 if the fit jumps.
int smoothness(Fit fit);

// Returns the name of a table in e whose derivative of this order would be wrong because lower ones are not continuous;
// nullopt if there is none.
std::optional<std::string> too_rough(Expr e, int derivative);

}  // namespace anholon
