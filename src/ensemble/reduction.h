// Numbers that sum up the whole motion of a case: the extremes, the mean, the last value of a formula; how often an event
// fired, and when first.
//
// Those of a formula are those of its Taylor polynomials, step by step, not of its values at some times. The steps are
// as short as the tolerance asks for the series of these formulas (StepSettings::known). A step whose polynomials end
// with the leading derivatives (integrate/one_sided_start.h) shows the formula at its beginning alone.
#pragma once
#include <array>
#include <string>
#include <vector>

#include "modelfile/contacts.h"
#include "modelfile/read.h"
#include "setup/scenario.h"

namespace anholon {

struct Reduction {
  enum class Kind : std::uint8_t { greatest, least, mean, last, count, first } kind = Kind::greatest;
  std::size_t of = 0;  // the formula, or the event
  std::string name;    // "max(height)", as it was written
  bool of_event() const { return kind == Kind::count || kind == Kind::first; }
};

struct Reductions {
  std::vector<Expr> formulas;
  std::vector<std::string> events;  // their names in the report of a motion
  std::vector<Reduction> list;

  // KIND(FORMULA), KIND one of max, min, mean, last; the formula is a monitor or any formula that a monitor may be, without
  // multipliers if contacts move. Or count(EVENT), first(EVENT); the event is one of the model or of a contact that moves.
  // Builds in the graph of the model. Throws MistakeInWord.
  void add(const std::string& word, const OpenModel& model, const std::vector<Contact>& moving = {});
};

// The greatest value of sum c_k x^k, k <= degree, for x from 0 to h, h of either sign; `known` if no value is greater. A
// value is found wherever the derivative changes its sign.
double greatest_on(const double* c, int degree, double h, double known);

// Collects the values of the reductions over the steps and events of a motion.
class Reducer {
 public:
  explicit Reducer(const Reductions& of) : of_(&of) { restart(); }
  void restart();
  // A step of length h: coefficient(i, k) of formula i, k <= degree.
  template <class Coefficient>
  void step(int degree, double h, const Coefficient& coefficient) {
    for (std::size_t i = 0; i < seen_.size(); ++i) {
      polynomial_.resize(static_cast<std::size_t>(degree) + 1);
      for (int k = 0; k <= degree; ++k) polynomial_[static_cast<std::size_t>(k)] = coefficient(i, k);
      see(i, h);
    }
    length_ += h;
  }
  void event(const std::string& name, double t);
  // The motion has stretches without polynomials: no formula has a value.
  void lose_formulas();
  // Of a formula NaN without a step, of first(EVENT) NaN without an occurrence.
  void values(std::vector<double>& to) const;

 private:
  struct Seen {
    bool greatest = false, least = false, mean = false;  // what is asked for
    double most = 0, fewest = 0, last = 0, integral = 0, carry = 0;
  };
  struct Fired {
    double times = 0, first = 0;
  };
  void see(std::size_t formula, double h);

  const Reductions* of_;
  std::vector<Seen> seen_;
  std::vector<Fired> fired_;
  std::vector<double> polynomial_;
  double length_ = 0;
};

}  // namespace anholon
