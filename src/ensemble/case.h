// The cases of an ensemble: what is asked of them, and what each and all of them give.
#pragma once
#include <functional>

#include "simulation/simulate.h"

namespace anholon {

// A number that differs from case to case.
struct Varied {
  enum class Kind : std::uint8_t { parameter, initial } kind = Kind::parameter;
  std::size_t index = 0;  // of the parameter, or of the coordinate
  unsigned order = 0;     // initial value of q^(order)
  std::string name;
};

struct EnsembleCase {
  std::vector<Rational> values;  // of what is varied
  std::optional<Rational> to;    // where its end is another one
};

struct EnsembleOptions {
  StateChoice state;  // common to all cases
  std::vector<Varied> varied;
  std::size_t cases = 0;
  std::function<EnsembleCase(std::size_t)> numbers;  // of a case, by its number alone: many threads ask at once
  Rational to;
  std::vector<Rational> at;  // rows at these times, ascending; none: the final state alone is kept
  Rational tolerance{1, 1000000000000};
  int order = 0;                        // of the Taylor polynomials; 0: from the tolerance
  Method method = Method::automatic;    // rk, bdf: one case after the other, as `simulate` does; else Taylor's, and
                                        // `simulate` for what it cannot finish
  std::size_t most_steps = 50'000'000;  // of a case
  ErrorEstimate estimate = ErrorEstimate::never;  // of the cases that `cases_to_compare` names
  bool kernel = true;                             // as in SimulationOptions; without, a case has the bits of `simulate`
  std::size_t threads = 0;                        // 0: as many as the machine has
  std::function<void(std::size_t done)> progress;  // by one thread at a time
  std::function<bool()> cancelled;                 // many threads ask at once
};

struct CaseResult {
  std::size_t number = 0;
  std::vector<double> values;  // of what is varied
  Outcome outcome;
  double t = 0;  // reached
  std::size_t steps = 0;
  std::vector<double> last;  // of `ensemble_columns`, at the end or at the last good state; empty if there is none
  std::vector<std::vector<double>> rows;  // the same at the times asked for, t first
};

class CaseSink {
 public:
  virtual ~CaseSink() = default;
  // In the order of the cases, by one thread at a time.
  virtual void result(const CaseResult& result) = 0;
};

// How exact the results are: cases that lie evenly among all, each compared with a sharper run of it.
struct CasesError {
  std::vector<std::size_t> cases;    // that were compared
  std::optional<ErrorReport> error;  // of each kind the largest of any of them
  std::size_t worst = 0;             // the case with the largest
  std::string none;                  // why there is nothing to say, where an estimate was asked for
};
struct EnsembleReport {
  Outcome outcome;  // interrupted, or finished although cases may have stopped
  std::size_t done = 0, finished = 0;
  std::size_t in_workspaces = 0;  // cases that were not computed by the tapes all share
  std::size_t most_held = 0;      // results at once in memory
  std::size_t threads = 0;
  double seconds = 0;
  CasesError error;
};

}  // namespace anholon
