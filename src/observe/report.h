// The report of a motion: where it ended and why, its residuals, events and errors.
#pragma once
#include "motion/course.h"
#include "observe/defect.h"
#include "observe/rows/row_comparison.h"
#include "observe/second_opinion.h"
#include "result/table.h"

namespace anholon {

// A number watched from the start to the end, at the rows; a monitor also at the ends of Taylor's steps (at ever fewer
// of them in long motions), and before and after events. The numbers are in the precision of the rows.
struct WatchedReport {
  std::string name;
  WrittenNumber first, last, least, greatest;
  double largest_change = 0;  // from the start, relative to the greatest of its terms
  double size = 0;            // the greatest of its terms; 0 in reports that were read from a file
  std::size_t times = 0;      // the number of times at which a monitor was seen; 0 if unknown
};

// The derivatives k = 0, 1, … of a constraint that have to vanish: the largest at the rows, relative to their terms.
struct ConstraintReport {
  std::string name;
  std::vector<double> residuals;
};

// A warning for the user, and what to do about it.
struct Warning {
  std::string message, hint;
};

// An output that is declared conserved is not conserved if it changes by more than this, relative to the greatest of its
// terms. The limit is far above the errors of integration and round-off.
inline constexpr double kConserved = 1e-6;
inline Warning not_conserved(const std::string& name, double change) {
  return {"the output '" + name + "' is not conserved: it changes by " + number_text(change, 3) + " of its terms",
          "look for a force, an impact, an event or an observer that changes it, or leave out conserved = true"};
}

// The time at which an event fired, and what it changed: name, before, after.
struct EventReport {
  std::string name;
  WrittenNumber t;
  struct Change {
    std::string name;
    WrittenNumber before, after;
  };
  std::vector<Change> changes;
  double correction = 0;  // the change by which constraints made consistent what was set
  bool stop = false;
};

struct SimulationReport {
  std::string model, form;  // the title of the model, the name of the form whose equations were integrated
  Outcome outcome;
  double t = std::numeric_limits<double>::quiet_NaN();  // the time reached
  std::size_t steps = 0, rows = 0;
  std::size_t rows_looked_at = 0;  // the number of rows in the residual report
  int order = 0;
  double seconds = 0;
  // Relative to the greatest of their terms so far (theory: certificate).
  double newton = 0;            // C1: Newton's law with ideal reactions
  double projected = 0;         // C2: the same without multipliers
  double constraints = 0;       // C3: worst hidden constraint, before it was projected
  double constraints_kept = 0;  // C3 at the rows, after projection
  double power = 0;             // |h - h0 - work| relative to the largest energy and work along the motion
  double turned_over = 0;       // the largest energy and work, to which power refers
  double smallest_sigma = 1;    // scaled, of the system Jacobian
  double smallest_sigma_t = std::numeric_limits<double>::quiet_NaN();  // the time of smallest_sigma
  std::vector<ConstraintReport> constraints_each;
  std::optional<ErrorReport> error;
  std::string no_error;  // the reason why there is no estimate, if one was requested
  std::vector<Warning> warnings;
  std::vector<std::string> notes;  // limits that are passed at the start, floors that pull, rolling that slips
  bool looks_for_events = false;   // the model has events
  std::vector<EventReport> events;
  std::optional<RigorousReport> rigorous;
  std::optional<std::size_t> eliminations;  // changes of the eliminated coordinates, if the form eliminates
  MethodReport method;
  std::optional<SecondOpinion>
      second;  // if another integrator was requested; steps, order and sigma are those of the motion beside it
  std::vector<WatchedReport> monitors;   // of the model's [monitor]
  std::vector<WatchedReport> conserved;  // integrals of the motion
};

}  // namespace anholon
