// The rows of one run: each is computed where it is due, by the kernel beside the motion or by the reference, and is
// then watched, judged and written.
#pragma once
#include <algorithm>
#include <bit>
#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include "simulation/kernel_rows.h"
#include "simulation/schedule.h"
#include "simulation/shown_motion.h"

namespace anholon {

// The ranges of monitors are watched at the ends of some steps: of the first ones, then of ever fewer, so that this
// does not dominate the time of a run.
inline std::size_t steps_between_looks(std::size_t step) {
  constexpr std::size_t kFirst = 1024;
  return std::bit_ceil(step / kFirst + 1);
}
inline bool is_looked_at(std::size_t step) { return step % steps_between_looks(step) == 0; }
// Returns the number of steps from this one to the next one at which the ranges are watched.
inline std::size_t steps_to_next_look(std::size_t step) {
  std::size_t next = step + 1;
  while (!is_looked_at(next)) {
    const std::size_t between = steps_between_looks(next);
    next += between - next % between;
  }
  return next - step;
}

template <Number N>
class RunRows {
 public:
  using W = Wider<N>;

  // The objects that the rows read and the watches that see them; all outlive the rows.
  struct Parts {
    Workspace& s;
    const SimulationOptions& options;
    int stages;  // orders beyond the leading derivatives that rows show
    Course<N>& course;
    ShownMotion<N>& shown;
    Watch<W>& watch;
    Judge<N>& judge;
    std::optional<FloorWatch>& floors;
    SimulationReport& report;  // its outcome becomes the reason why a row has no solution
  };

  RunRows(const Parts& parts, RowSink& sink) : of_(parts), writer_(sink, parts.options.digits) {}

  // ---- at the start --------------------------------------------------------------------------------

  void begin(const RowSchedule<W>& schedule) { schedule_ = schedule; }
  RowSchedule<W>& schedule() { return schedule_; }
  const RowSchedule<W>& schedule() const { return schedule_; }
  void columns() { writer_.columns(run_columns(of_.s, highest())); }
  // Rows and steps since the start of the motion.
  RowWriter<N>& writer() { return writer_; }
  const RowWriter<N>& writer() const { return writer_; }

  // Lets rows of Taylor's steps be computed side by side, if possible. `known`: the object that computes them, if it
  // was made before.
  void begin_beside(std::optional<std::shared_ptr<WaitingRows>>& known) {
    if constexpr (std::same_as<N, double>) {
      const Motion<N>& motion = of_.course.taylor();
      if (!motion.stepper().accelerated()) return;
      const double end = to_double(schedule_.end());
      if (!known)
        known = WaitingRows::make(of_.s, of_.options.conserved, of_.stages, motion.start_parameters(),
                                  motion.start_state(), end, watches_ranges() ? 0 : schedule_.left());
      const std::shared_ptr<WaitingRows>& rows = *known;
      if (!rows) return;
      rows->set_parameters(motion.parameters());
      rows->set_end(end);
      beside_ = std::make_unique<KernelRows>(of_.s, of_.options, motion, of_.stages, rows,
                                             RowTakers{of_.watch, of_.judge, of_.floors, writer_, of_.report});
    }
  }
  // Makes the reference compute all further rows.
  void by_reference() { beside_.reset(); }

  // ---- during the motion ---------------------------------------------------------------------------

  // Makes the rows in the last step up to `stop`; those at times that the user asked for, up to `told` (told_until).
  void until(const W& stop, const W& told) {
    W given = stop;
    while (of_.report.outcome.ok() && schedule_.due(told)) {
      const auto due = schedule_.take();
      in_step(due.t, due.label);
      if (schedule_.reaches(due.t, stop)) given = due.t;
    }
    if (schedule_.reaches(*schedule_.given(), stop)) return;
    if (schedule_.every_step())
      in_parts(*schedule_.given(), stop);
    else if (watches_ranges() && is_looked_at(of_.course.steps()) && of_.course.by_taylor() &&
             of_.report.outcome.ok() && !schedule_.took(stop))
      look(stop);
    schedule_.set_given(given);
  }
  // True if the ranges of monitors are watched at the ends of Taylor's steps, too.
  bool watches_ranges() const { return of_.options.watches_ranges && of_.watch.any_ranges() && !of_.shown.second(); }

  // Passes on the end of a step. While rows are in work, their thread passes it on, after the rows before it.
  void tell_step(const W& end) {
    if (beside_)
      beside_->step(to_double(end));
    else
      writer_.step(end);
  }

  // Ends a step, after its rows. `now`: when the clock was read last.
  void end_step(const W& end, std::chrono::steady_clock::time_point now) {
    tell_step(end);
    if (!beside_) return;
    beside_->look_at_the_time(now);
    if (beside_->failed()) settle();
  }

  // Waits for the rows in work. If one of them has no solution, the outcome becomes its reason.
  void settle() {
    if (!beside_) return;
    if (Outcome o = beside_->settle(); !o.ok()) of_.report.outcome = std::move(o);
  }

  // Sets the present parameters of the motion for the rows that follow. Call it after settle().
  void set_parameters() {
    if constexpr (std::same_as<N, double>)
      if (beside_) beside_->set_parameters(of_.course.taylor().parameters());
  }

  void at(const typename RowSchedule<W>::Due& due) { at(due.t, due.label); }
  // Makes a row by the reference. `judged`: the row counts for the estimate of the error.
  void at(const W& t, const std::string& label, bool judged = true) {
    of_.report.outcome = of_.shown.at(t);
    if (of_.report.outcome.ok()) of_present_point(t, label, judged);
  }
  // Makes a row of the point where the motion is shown.
  void of_present_point(const W& t, const std::string& label, bool judged = true) {
    last_ = t;
    ++of_.report.rows_looked_at;
    of_.report.outcome = of_.watch.see(of_.shown.point(), of_.report);
    row_values(of_.s, highest(), of_.shown.point(), of_.watch, numbers_);
    if (judged) of_.judge.row(t, label, numbers_, of_.course);
    if (of_.floors)
      of_.floors->see(to_double(t), [&](std::size_t r) { return to_double(of_.watch.multiplier(r)); }, numbers_);
    writer_.row(t, label, numbers_);
    ++of_.report.rows;
    if (of_.options.rows_lost) of_.options.rows_lost();
  }

  // Makes a row by the reference with the state after an event, at the time of the row before. Only the row before
  // counts for the estimate of the error.
  void after_event(const W& t) { at(t, "", false); }

  // The time of the last row.
  const std::optional<W>& last() const { return last_; }
  // True if rows were written up to t or beyond it.
  bool has_passed(const W& t) const { return last_ && schedule_.reaches(*last_, t); }

  // ---- for the report, after settle() --------------------------------------------------------------

  std::optional<Warning> warning() const { return beside_ ? beside_->warning() : std::nullopt; }
  // The object that computes the rows beside the motion; nullptr if the reference computes them.
  WaitingRows* waiting() { return beside_ ? &beside_->waiting() : nullptr; }

 private:
  int highest() const { return largest_order(of_.s, of_.course.taylor().program().d); }

  // Makes the rows within the last step, and at its end.
  void in_parts(const W& begin, const W& end) {
    int parts = 1;
    if (const auto& picture = of_.options.picture) {
      constexpr double kMostParts = 5000;
      const double wide = std::ceil(std::abs(to_double(W(end - begin))) / picture->widest);
      parts = std::max(picture->in_each_step, static_cast<int>(std::min(wide, kMostParts)));
    }
    for (int k = 1; k < parts && of_.report.outcome.ok(); ++k) in_step(begin + (end - begin) * W(k) / W(parts), "");
    if (of_.report.outcome.ok()) in_step(end, "");
  }

  void in_step(const W& t, const std::string& label) {
    if constexpr (std::same_as<N, double>)
      if (const Motion<N>& motion = of_.course.taylor();
          beside_ && of_.course.by_taylor() && !motion.stepper().one_sided()) {
        beside_->add(motion, t, label, of_.judge.wanted(of_.course));
        last_ = t;
        if (beside_->failed()) settle();
        return;
      }
    settle();
    if (of_.report.outcome.ok()) at(t, label);
  }

  // Watches the monitors at a time of the last step.
  void look(const W& t) {
    if constexpr (std::same_as<N, double>)
      if (const Motion<N>& motion = of_.course.taylor(); beside_ && !motion.stepper().one_sided()) {
        beside_->look(motion, t);
        if (beside_->failed()) settle();
        return;
      }
    settle();
    if (of_.report.outcome.ok() && of_.shown.at(t).ok()) of_.watch.look_at_ranges(of_.shown.point());
  }

  Parts of_;
  RowSchedule<W> schedule_;
  std::optional<W> last_;   // the time of the last row
  std::vector<W> numbers_;  // of one row
  RowWriter<N> writer_;
  // Null if the reference computes the rows; the last member, because it uses the others.
  std::unique_ptr<KernelRows> beside_;
};

}  // namespace anholon
