// The numbers that summarize the whole motion of a case, collected over its steps and events.
//
// The steps are as short as the tolerance requires for the series of the formulas (StepSettings::known_from). Where a
// polynomial does not hold over the step, values of the formula are seen, in pieces that begin and end where a function
// that is nearly constant at the start of the step may vary, such as exp in a pulse. A last value needs the formula at
// the end alone, and shortens no step.
#pragma once
#include <functional>
#include <string>
#include <vector>

#include "ensemble/reduce/formula_summary.h"
#include "ensemble/reduce/reductions.h"
#include "integrate/series/hidden_points.h"

namespace anholon {

// A function that may hide its variation, with the polynomial of its argument over a step.
struct HidingPolynomial {
  Hiding function;
  std::vector<double> argument;  // the coefficients of x^k
};

// A step of length h in which the reductions see the formulas.
struct ReducedStep {
  double h = 0;
  int degree = 0;                                           // of the polynomials; 0: they hold at the beginning alone
  std::function<double(std::size_t i, int k)> coefficient;  // of formula i, k <= degree
  std::function<FormulaValue(std::size_t i, double x)> value;  // of formula i at x from the beginning
  // The arguments, at x, of the functions in formula i that may hide their variation; without it there are none.
  std::function<std::vector<HidingArgument>(std::size_t i, double x)> hiding;
  bool look = true;       // compare the polynomials with values; otherwise the next step compares
  std::size_t kinks = 0;  // met in the motion so far; formulas may jump at them
  // The polynomials of these arguments, if they are known; otherwise `hiding` gives values.
  std::function<std::vector<HidingPolynomial>(std::size_t i)> hiding_polynomials = {};
};

// Collects the values of the reductions over the steps and events of a motion.
class Reducer {
 public:
  explicit Reducer(const Reductions& of, double tolerance = 1e-12);
  void restart();
  // Returns false if a formula begins at another value than its polynomial of the step before has ended, if that was
  // not compared with values: then what was collected is wrong.
  [[nodiscard]] bool step(const ReducedStep& step);
  void event(const std::string& name, double t);
  // Sets the values of the ends where the motion is; the last call gives those at its end.
  void ends(std::vector<double> values) { ends_ = std::move(values); }
  // Notes that the motion has stretches without polynomials: no formula and no end has a value.
  void lose_formulas();
  // Returns the values: for a formula NaN without a step or if it lacked a value, for first(EVENT) NaN without an
  // occurrence.
  void values(std::vector<double>& to) const;

 private:
  struct Fired {
    double times = 0, first = 0;
  };
  bool holds(const ReducedStep& step, std::size_t formula);
  void find_hidden(const ReducedStep& step, std::size_t formula);
  void find_by_values(const ReducedStep& step, std::size_t formula,
                      const std::function<void(const Hiding&, const std::vector<double>&)>& add);

  const Reductions* of_;
  double tolerance_;
  std::vector<FormulaSummary> seen_;  // of the formulas
  std::vector<double> ends_;
  std::vector<Fired> fired_;
  std::vector<double> polynomial_;
  // Points within the step where the formula may do something that its polynomial does not show.
  std::vector<double> hidden_;
  bool arguments_reach_ = true;  // the polynomials of the arguments of hiding functions reach over the step
  double length_ = 0;
  std::size_t kinks_ = 0;
  bool foretold_ = false;  // the last values are those of polynomials that were not compared with values
};

}  // namespace anholon
