// The end of a motion before its requested end: why and when it ends, and the row of the last good state.
#pragma once
#include <optional>
#include <utility>

#include "numeric/told_time.h"
#include "observe/options.h"
#include "simulation/followed_value.h"
#include "simulation/run_rows.h"

namespace anholon {

template <Number N>
class RunEnd {
 public:
  using W = Wider<N>;

  // The objects that outlive this one; `first`: the first followed formula among the quadratures of the motion.
  struct Parts {
    Workspace& s;
    const SimulationOptions& options;
    int stages;  // orders beyond the leading derivatives in rows
    std::size_t first;
    Course<N>& course;
    RunRows<N>& rows;
    SimulationReport& report;
  };

  explicit RunEnd(const Parts& parts) : of_(parts) {}

  // Notes that the motion ends at t.
  void reach(const W& t) { reached_ = t; }
  // Notes that events could not be applied to this state, which becomes the last good one. `has_row`: whether there is a
  // row of it.
  void keep_before_event(Start<W> state, bool has_row) { before_event_.emplace(std::move(state), has_row); }
  // The time at which the motion ends.
  W time() const { return reached_ ? *reached_ : of_.course.time(); }

  // Tells the followed formulas at the start of a motion that ends there.
  void end_at_start() {
    if (of_.report.outcome.ok() && of_.options.stopped && !of_.options.followed.empty() && of_.course.by_taylor())
      tell_last_values(time());
  }

  // Explains why the motion cannot be continued, and makes the row of the last good state.
  void stop() {
    explain();
    if (of_.course.steps() == 0) return;
    const Outcome why = std::exchange(of_.report.outcome, {});
    if (before_event_)
      row_before_event();
    else if (const std::optional<W> last = last_good_state(why);
             last && of_.options.stopped && !of_.options.followed.empty() && of_.course.by_taylor())
      tell_last_values(*last);
    of_.report.outcome = why;
  }

 private:
  Motion<N>& motion() { return of_.course.taylor(); }

  // An outcome that tells a time has been explained where it arose.
  void explain() {
    Outcome& outcome = of_.report.outcome;
    if (outcome.t) return;
    tell_time(outcome, to_double(of_.course.time()));
    // The user did not ask for an end here.
    const bool by_itself =
        outcome.kind == OutcomeKind::interrupted && !(of_.options.cancelled && of_.options.cancelled());
    if (outcome.kind == OutcomeKind::step_collapse || outcome.kind == OutcomeKind::singular ||
        outcome.kind == OutcomeKind::no_convergence || outcome.kind == OutcomeKind::not_a_number || by_itself)
      explain_stop(of_.s, motion(), outcome);
  }

  void row_before_event() {
    const auto& [state, has_row] = *before_event_;
    motion().go_back();
    if (!has_row && motion().settle_at(state).ok()) of_.rows.of_present_point(state.t, "");
  }

  // Gives the last good state a row of its own, unless it has one: the end of the motion, the state reached, or that
  // before if the motion cannot go on from there. Returns the time of this row.
  std::optional<W> last_good_state(const Outcome& why) {
    Course<N>& course = of_.course;
    RunRows<N>& rows = of_.rows;
    const W before = course.before(), last = reached_ || why.kind == OutcomeKind::interrupted ? time() : before;
    if (rows.schedule().every_step() || rows.has_passed(last)) return rows.last();
    rows.at(last, "");
    if (of_.report.outcome.ok()) return last;
    if (!course.by_taylor()) return std::nullopt;
    // So near to a singular J, the equations cannot be solved to all digits. The series hold as far back as forward, so
    // the row is made at the mirrored time.
    of_.report.outcome = {};
    const W mirrored = before - (course.time() - before);
    rows.at(mirrored, "");
    return of_.report.outcome.ok() ? std::optional(mirrored) : std::nullopt;
  }

  // Tells the values of the followed formulas at t, a time of the last step.
  void tell_last_values(const W& t) {
    std::optional<Expansion<W>> point;
    of_.options.stopped([&](std::size_t i) {
      if (!point) point.emplace(motion().program(), motion().parameters(), std::max(1, of_.stages));
      return value_of_quadrature(motion().stepper(), t, of_.first + i, *point).first;
    });
  }

  Parts of_;
  std::optional<W> reached_;
  std::optional<std::pair<Start<W>, bool>> before_event_;
};

}  // namespace anholon
