// Numbers that summarize the whole motion of a case: the extremes, the mean and the last value of a formula; how often
// an event fired, and when first.
//
// The numbers of a formula come from its Taylor polynomials, step by step, not from its values at some times. The steps
// are as short as the tolerance requires for the series of these formulas (StepSettings::known_from). If a polynomial
// is not the formula over the whole step (the formula has a smaller radius of convergence than the motion, or no
// series, like a norm that is zero), pieces of the step get polynomials of their own, through values of the formula.
// Pieces begin and end where a function that is nearly constant at the start of the step may vary, such as exp in a
// pulse. A formula that is unbounded has no greatest or no least value, and one whose integral diverges, or
// converges too slowly to show it, has no mean: the number is NaN. A last value needs the formula at the end alone, and
// shortens no step.
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
  // The index: for a last value among the ends, for a count or a first time the event, otherwise the formula.
  std::size_t of = 0;
  std::string name;  // "max(height)", as it was written
  bool of_event() const { return kind == Kind::count || kind == Kind::first; }
};

struct Reductions {
  std::vector<Expr> formulas;       // formulas whose values along the motion are needed
  std::vector<Expr> ends;           // formulas whose last values are needed
  std::vector<std::string> events;  // their names in the report of a motion
  std::vector<Reduction> list;

  // Adds KIND(FORMULA), KIND one of max, min, mean, last; the formula is a monitor or any formula that a monitor may
  // be, without multipliers if contacts move. Or adds count(EVENT) or first(EVENT); the event is one of the model or of
  // a contact that moves. Builds in the graph of the model. Throws MistakeInWord.
  void add(const std::string& word, const OpenModel& model, const std::vector<Contact>& moving = {});
};

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
  struct Seen {
    bool greatest = false, least = false, mean = false;  // requested, and still available
    bool lost = false;                                   // a value is missing
    bool done() const { return lost || !(greatest || least || mean); }
    double most = 0, fewest = 0, last = 0, integral = 0, carry = 0;
    double beyond = 0;             // the length of the pieces where the motion has no solution
    double weight = 0, doubt = 0;  // the integral of magnitudes, and the part of it that may diverge
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
  // Points within the step where the formula may do something that its polynomial does not show.
  std::vector<double> hidden_;
  bool arguments_reach_ = true;  // the polynomials of the arguments of hiding functions reach over the step
  double length_ = 0;
  std::size_t kinks_ = 0;
  bool foretold_ = false;  // the last values are those of polynomials that were not compared with values
};

}  // namespace anholon
