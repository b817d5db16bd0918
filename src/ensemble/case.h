// The data of an ensemble: its options, the result of a case, the report of all cases.
#pragma once
#include <functional>
#include <map>

#include "ensemble/reduce/reductions.h"
#include "modelfile/names/declared_unit.h"
#include "simulation/simulate.h"

namespace anholon {

// A number that differs from case to case.
struct Varied {
  enum class Kind : std::uint8_t { parameter, initial } kind = Kind::parameter;
  std::size_t index = 0;  // of the parameter, or of the coordinate
  unsigned order = 0;     // initial value of q^(order)
  std::string name;
  DeclaredUnit unit = {};  // of a parameter
};

struct EnsembleCase {
  std::vector<Rational> values;  // of the varied numbers: parameters in the units that the file declares for them
  std::optional<Rational> to;    // the end, if the case has one of its own
};

// The constraints that parameters switch: [[constraint]] with active = "…".
struct Switches {
  Column active;                         // a constraint holds while its formula of parameters is positive
  std::function<void(Model&)> put;       // puts the constraints that hold with the parameters of a model into it
  std::vector<std::string> multipliers;  // the names of the multipliers in formulas of reductions
};

struct EnsembleOptions {
  StateChoice state;  // common to all cases
  std::vector<Varied> varied;
  std::size_t cases = 0;
  std::function<EnsembleCase(std::size_t)> numbers;  // of the case with this number; called by many threads at once
  // For cases that come bit by bit: called when all cases so far have begun, it returns the number of further ones, 0
  // at the end. `cases` is then the most there may be. Without it, all cases are known.
  std::function<std::size_t()> more;
  Rational to;
  std::vector<Rational> at;  // rows at these times, ascending; empty: the final state alone is kept
  Reductions reductions;     // of formulas of the scenario
  Rational tolerance{1, 1000000000000};
  int order = 0;                        // of the Taylor polynomials; 0: from the tolerance
  Method method = Method::automatic;    // rk, bdf: one case after the other, as `simulate` does; else Taylor's, and
                                        // `simulate` for what it cannot finish
  std::size_t most_steps = 50'000'000;  // of a case
  ErrorEstimate estimate = ErrorEstimate::never;  // of the cases that `cases_to_compare` names
  bool kernel = true;       // as in SimulationOptions; without a kernel, a case has the bits of `simulate`
  std::size_t threads = 0;  // 0: as many as the machine has
  std::function<void(std::size_t done)> progress;  // by one thread at a time
  std::function<bool()> cancelled;                 // called by many threads at once
  // If set, computes the motion of a case in place of `simulate`: the equations of every case are then made anew, and
  // its rows have these columns after those of the model.
  std::function<SimulationReport(Workspace&, const SimulationOptions&, RowSink&)> own_motion;
  std::vector<std::string> own_columns;
  std::vector<Identity> identities;  // a case in which one does not hold is refused
  // If set, the equations of every case are made anew, from this model and the numbers of the case.
  std::shared_ptr<const Model> each_anew;
  // If set, a case in which other constraints hold than in the scenario of all cases is derived anew.
  std::optional<Switches> switches;
};

struct CaseResult {
  std::size_t number = 0;
  std::vector<double> values;  // of the varied numbers, as in EnsembleCase
  Outcome outcome;
  double t = 0;  // the time reached
  std::size_t steps = 0;
  std::vector<double> last;  // the `ensemble_columns` at the end or at the last good state; empty if there is none
  std::vector<std::vector<double>> rows;  // the same at the times asked for, t first
  std::vector<double> reduced;       // the values of the reductions, over the motion as far as it came; may be empty
  bool without_polynomials = false;  // BDF computed a part of the motion: reductions of formulas have no values
  std::string event;                 // the event that ended the motion; empty if none did
  std::string replaced;              // the note on initial values of the file that give way to those that are given
};

class CaseSink {
 public:
  virtual ~CaseSink() = default;
  // Takes the results in the order of the cases, from one thread at a time.
  virtual void result(const CaseResult& result) = 0;
};

// The error of the results, from some cases, evenly spaced among all, that are compared with sharper runs.
struct CasesError {
  std::vector<std::size_t> cases;    // the compared ones
  std::optional<ErrorReport> error;  // the largest error of each kind in any of these cases
  std::size_t worst = 0;             // the case with the largest error
  std::string none;                  // the reason why there is none although it was requested
};
// The residual reports of the same cases, which `simulate` computes again with all rows.
struct CasesResiduals {
  struct Worst {
    double residual = 0;
    std::size_t number = 0;  // of the case
  };
  std::vector<std::size_t> cases;
  Worst newton, constraints, power;  // relative to their terms, as in SimulationReport
  std::string none;                  // the reason why there are none although they were requested
};

// The number of finished cases in which a reduction of a formula has no value.
struct CasesWithoutValue {
  std::size_t all = 0, without_polynomials = 0;
  void add(const CasesWithoutValue& more) { all += more.all, without_polynomials += more.without_polynomials; }
};

// The cases in which initial values of the file give way to values that are given or vary.
struct CasesReplaced {
  std::size_t cases = 0;
  std::string note;  // of the first of them
  void add(const CasesReplaced& more) {
    if (cases == 0) note = more.note;
    cases += more.cases;
  }
};

struct EnsembleReport {
  Outcome outcome;  // interrupted, or finished; cases may have stopped either way
  std::size_t done = 0, finished = 0;
  std::map<std::string, std::size_t> events;               // finished cases by the event that ended them
  std::map<std::string, CasesWithoutValue> without_value;  // by the reduction
  CasesReplaced replaced;
  std::size_t in_workspaces = 0;  // cases that were not computed by the shared tapes
  std::size_t most_held = 0;      // the largest number of results that were in memory at once
  std::size_t threads = 0;
  double seconds = 0;
  CasesError error;
  CasesResiduals residuals;
};

}  // namespace anholon
