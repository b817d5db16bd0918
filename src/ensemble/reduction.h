// Numbers that sum up the whole motion of a case: the extremes, the mean, the last value of a formula; how often an event
// fired, and when first.
//
// Those of a formula are those of its Taylor polynomials, step by step, not of its values at some times. The steps are
// as short as the tolerance asks for the series of these formulas (StepSettings::known). Where a polynomial is not the
// formula over the whole step (the radius of convergence of the formula is shorter than that of the motion, or the formula
// has no series, as a norm that is zero), pieces of the step get polynomials of their own, through values of the formula;
// they begin and end where a function that is all but constant at the start of the step may vary, as exp in a pulse.
// A formula that is not bounded has no greatest or no least value, and one whose integral diverges has no mean: NaN.
// A last value is that of the formula at the end alone: no step is shorter for its sake.
#pragma once
#include <string>
#include <vector>

#include "ensemble/reduce/pieces.h"
#include "integrate/series/hidden_points.h"
#include "modelfile/contacts.h"
#include "modelfile/read.h"
#include "setup/scenario.h"

namespace anholon {

struct Reduction {
  enum class Kind : std::uint8_t { greatest, least, mean, last, count, first } kind = Kind::greatest;
  std::size_t of = 0;  // of a last value among the ends, of a count or a first time the event, else the formula
  std::string name;    // "max(height)", as it was written
  bool of_event() const { return kind == Kind::count || kind == Kind::first; }
};

struct Reductions {
  std::vector<Expr> formulas;       // whose values along the motion are asked for
  std::vector<Expr> ends;           // whose last values are asked for
  std::vector<std::string> events;  // their names in the report of a motion
  std::vector<Reduction> list;

  // KIND(FORMULA), KIND one of max, min, mean, last; the formula is a monitor or any formula that a monitor may be, without
  // multipliers if contacts move. Or count(EVENT), first(EVENT); the event is one of the model or of a contact that moves.
  // Builds in the graph of the model. Throws MistakeInWord.
  void add(const std::string& word, const OpenModel& model, const std::vector<Contact>& moving = {});
};

// A step of length h in which the reductions see the formulas.
struct HidingPolynomial {
  Hiding function;
  std::vector<double> argument;  // the coefficients of x^k
};

struct ReducedStep {
  double h = 0;
  int degree = 0;                                           // of the polynomials; 0: they hold at the beginning alone
  std::function<double(std::size_t i, int k)> coefficient;  // of formula i, k <= degree
  std::function<FormulaValue(std::size_t i, double x)> value;  // of formula i at x from the beginning
  // There: the arguments of the functions in formula i that may hide their variation; without it there are none.
  std::function<std::vector<HidingArgument>(std::size_t i, double x)> hiding;
  bool look = true;       // whether the polynomials are compared with values; else the next step tells
  std::size_t kinks = 0;  // met in the motion so far, at which formulas may jump
  // The polynomials of these arguments, where they are known; else `hiding` tells values.
  std::function<std::vector<HidingPolynomial>(std::size_t i)> hiding_polynomials = {};
};

// Collects the values of the reductions over the steps and events of a motion.
class Reducer {
 public:
  explicit Reducer(const Reductions& of, double tolerance = 1e-12);
  void restart();
  // False if a formula begins elsewhere than its polynomial in the step before has ended, which nobody has looked at:
  // what was collected is wrong.
  [[nodiscard]] bool step(const ReducedStep& step);
  void event(const std::string& name, double t);
  // The values of the ends where the motion is; those at its end are told last.
  void ends(std::vector<double> values) { ends_ = std::move(values); }
  // The motion has stretches without polynomials: no formula has a value, and no end.
  void lose_formulas();
  // Of a formula NaN without a step or without a value on the way, of first(EVENT) NaN without an occurrence.
  void values(std::vector<double>& to) const;

 private:
  struct Seen {
    bool greatest = false, least = false, mean = false;  // what is asked for and can still be had
    bool lost = false;                                   // a value is missing
    bool done() const { return lost || !(greatest || least || mean); }
    double most = 0, fewest = 0, last = 0, integral = 0, carry = 0;
  };
  struct Fired {
    double times = 0, first = 0;
  };
  bool agrees(double is, double foretold, double size) const;
  bool holds(const ReducedStep& step, std::size_t formula);
  void find_hidden(const ReducedStep& step, std::size_t formula);
  void find_by_values(const ReducedStep& step, std::size_t formula,
                      const std::function<void(const Hiding&, const std::vector<double>&)>& add);
  void see(Seen& s, double h, double scale);
  void see_by_values(const ReducedStep& step, std::size_t formula);

  const Reductions* of_;
  double tolerance_;
  std::vector<Seen> seen_;
  std::vector<double> ends_;
  std::vector<Fired> fired_;
  std::vector<double> polynomial_;
  std::vector<double> hidden_;  // points within the step where the formula may do what its polynomial does not show
  double length_ = 0;
  std::size_t kinks_ = 0;
  bool foretold_ = false;  // whether the last values are those of polynomials that nobody has looked at
};

}  // namespace anholon
