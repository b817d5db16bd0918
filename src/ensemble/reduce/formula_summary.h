// The extremes and the mean of a formula over a motion.
//
// They come from Taylor polynomials, step by step, not from values at some times. If a polynomial is not the formula over
// the whole step (the formula has a smaller radius of convergence than the motion, or no series, like a norm that is
// zero), pieces of the step get polynomials of their own, through values of the formula. A formula that is unbounded has
// no greatest or no least value, and one whose integral diverges, or converges too slowly to show it, has no mean: the
// number is NaN.
#pragma once
#include <functional>
#include <limits>
#include <vector>

#include "ensemble/reduce/pieces.h"
#include "ensemble/reduce/reductions.h"

namespace anholon {

// True if a value agrees with a polynomial as far as a good polynomial can be told from a wrong one, also in formulas
// whose terms cancel. `size`: of the terms.
bool agrees(double is, double foretold, double size, double tolerance);

class FormulaSummary {
 public:
  // Asks for the greatest or the least value or the mean.
  void ask(Reduction::Kind kind);
  // True if nothing more can be seen: nothing is asked for, or every value is lost.
  bool done() const { return lost_ || !(greatest_ || least_ || mean_); }
  double last() const { return last_; }  // the value at the end of what was seen; NaN before
  void lose() { lost_ = true; }
  // Sees the polynomial c over x in [0, h], with the values of the formula; may change c. `kink`: the step ends a little
  // beyond a kink.
  void see(std::vector<double>& c, double h, const std::function<FormulaValue(double)>& f, bool kink);
  // Sees the values of the formula over [0, h], and looks at pieces that begin and end at the `hidden` points in it,
  // which are in order from 0 on.
  void see_by_values(const std::function<FormulaValue(double)>& f, double h, const std::vector<double>& hidden,
                     double tolerance);
  // Returns what was asked for over a motion of this length, NaN if there is no value.
  double value(Reduction::Kind kind, double length) const;

 private:
  class ByValues;
  void integrate(const std::vector<double>& c, double h, double scale);
  bool greatest_ = false, least_ = false, mean_ = false;  // asked for, and still available
  bool lost_ = false;                                     // a value is missing
  double most_ = -std::numeric_limits<double>::infinity(), fewest_ = std::numeric_limits<double>::infinity();
  double last_ = std::numeric_limits<double>::quiet_NaN();
  double integral_ = 0, carry_ = 0;
  double beyond_ = 0;              // the length of the pieces where the motion has no solution
  double weight_ = 0, doubt_ = 0;  // the integral of magnitudes, and the part of it that may diverge
};

}  // namespace anholon
