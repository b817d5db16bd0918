// One motion: from the consistent state to the rows of a table, with its residual report.
#pragma once
#include <functional>

#include "mechanics/conserved.h"
#include "result/rows.h"
#include "run/course.h"
#include "run/defect.h"
#include "run/row_comparison.h"
#include "run/saved.h"
#include "run/scenario.h"
#include "run/second_opinion.h"

namespace anholon {

// Whether a second, sharper run is made for the estimate of the global error; it costs more than the run itself.
enum class ErrorEstimate : std::uint8_t { never, short_runs, always };
inline constexpr std::size_t kShortRun = 5000;  // steps

struct SimulationOptions {
  StateChoice state;
  std::optional<Rational> to;
  std::vector<Rational> at;  // exactly these rows, ascending, on one side of the start
  std::optional<Rational> every;
  Rational tolerance{1, 1000000000000};
  int order = 0;  // of the Taylor polynomials; 0: from the tolerance
  Integrator integrator =
      Integrator::taylor;  // another one: its rows, and how far they are from Taylor's (precision real only)
  // Whose motion it is. Where only Taylor's can give what is asked for, automatic means that; others by name compute in
  // double, do not save, and know neither events nor enclosures.
  Method method = Method::automatic;
  Precision precision = Precision::real;
  int digits = 16;                      // of the numbers written, where more than 16 (multi: also of the computation)
  std::optional<std::size_t> rigorous;  // the defect of the dense output, enclosed at so many times; at all times: 0
  std::vector<std::string> at_text;     // the times as written, to be printed as given
  std::function<void(double t, std::size_t steps)> progress;
  std::function<bool()> cancelled;
  std::function<void(const std::string&)> note;  // told of the notes of the report as soon as there is one
  std::size_t most_steps = 50'000'000;
  bool kernel = true;  // where there is one: its pivots, chosen at the start, are seen in the last digits
  ErrorEstimate estimate = ErrorEstimate::never;
  std::vector<Conserved> conserved;  // to be watched
  // Called at the end, and every few seconds: what is needed to go on.
  std::function<void(const SavedRun&)> save;
  double save_seconds = 10;
  const SavedRun* resume = nullptr;  // a run to go on with; only rows after its last are given
};

// A number watched from the start, at the rows and at the end; the numbers are in the precision of the rows.
struct WatchedReport {
  std::string name;
  std::string first, last, least, greatest;
  double largest_change = 0;  // from the start, in relation to the greatest of its terms
};

// Derivatives k = 0, 1, … of a constraint that have to vanish: the worst at the rows, in relation to their terms.
struct ConstraintReport {
  std::string name;
  std::vector<double> residuals;
};

// What the user should look at, and what to do.
struct Warning {
  std::string message, hint;
};

// Where an event fired, and what it changed: name, before, after.
struct EventReport {
  std::string name, t;
  struct Change {
    std::string name, before, after;
  };
  std::vector<Change> changes;
  double correction = 0;  // by which constraints made what was set consistent
  bool stop = false;
};

struct SimulationReport {
  Outcome outcome;
  std::string t;  // reached
  std::size_t steps = 0, rows = 0;
  int order = 0;
  double seconds = 0;
  // In relation to the greatest of their terms so far (theory: certificate).
  double newton = 0;             // C1: Newton's law with ideal reactions
  double projected = 0;          // C2: the same without multipliers
  double constraints = 0;        // C3: worst hidden constraint, before it was projected
  double constraints_kept = 0;   // C3 at the rows, after projection
  double power = 0;              // |h - h0 - work| in relation to the largest energy and work along the motion
  double smallest_sigma = 1;     // scaled, of the system Jacobian
  std::string smallest_sigma_t;  // when it was met
  std::vector<ConstraintReport> constraints_each;
  std::optional<ErrorReport> error;
  std::string no_error;  // why there is no estimate, where one was asked for
  std::vector<Warning> warnings;
  std::vector<std::string> notes;  // limits that are passed at the start, floors that pull
  std::vector<EventReport> events;
  std::optional<RigorousReport> rigorous;
  std::size_t eliminations = 0;  // how often other coordinates were eliminated on the way
  MethodReport method;
  std::optional<SecondOpinion>
      second;  // where another integrator was asked for; steps, order and sigma are those of the motion beside it
  std::vector<WatchedReport> monitors;   // of the model's [monitor]
  std::vector<WatchedReport> conserved;  // integrals of the motion
};

SimulationReport simulate(const Scenario& scenario, const SimulationOptions& options, RowSink& sink);

}  // namespace anholon
