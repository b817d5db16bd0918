// The report of a run that has ended: the figures of the motion, what was watched, warnings, digits to trust.
#pragma once
#include <algorithm>
#include <string>
#include <vector>

#include "setup/notes_on_multipliers.h"
#include "simulation/first_pull.h"
#include "simulation/run_end.h"
#include "simulation/run_rows.h"
#include "simulation/shown_motion.h"
#include "simulation/trust.h"

namespace anholon {

// Adds a note to the report, and tells it at once if that is asked for.
inline void add_note(SimulationReport& report, const SimulationOptions& options, const std::string& text) {
  report.notes.push_back(text);
  if (options.note) options.note(text);
}

template <Number N>
class RunReport {
 public:
  using W = Wider<N>;

  // The objects that a run has used, and its report, which has its events, residuals and outcome.
  struct Parts {
    Workspace& s;
    const SimulationOptions& options;
    const std::vector<Expr>& quadratures;  // of the motion without the followed formulas
    Course<N>& course;
    const ShownMotion<N>& shown;
    const Watch<W>& watch;
    const AngleWatch& angles;
    Judge<N>& judge;
    std::optional<FloorWatch>& floors;
    RunRows<N>& rows;
    const RunEnd<N>& end;
    SimulationReport& report;
  };

  explicit RunReport(const Parts& parts) : of_(parts) {}

  void fill() {
    SimulationReport& r = of_.report;
    fill_course();
    fill_watched();
    if (of_.floors) fill_floors();
    warn(warnings<N>(of_.s, of_.course, of_.watch, of_.angles, r.outcome));
    const bool set =
        std::any_of(r.events.begin(), r.events.end(), [](const EventReport& e) { return !e.changes.empty(); });
    warn(warnings_of_jumps<N>(of_.course, of_.watch, of_.options, set));
    if (const auto warning = of_.rows.warning()) r.warnings.push_back(*warning);
    of_.judge.estimate(of_.course, of_.quadratures, of_.rows.waiting(), r);
    if (of_.watch.any_redundant()) fill_undetermined();
  }

 private:
  void note(const std::string& text) { add_note(of_.report, of_.options, text); }
  void warn(const std::vector<Warning>& list) {
    of_.report.warnings.insert(of_.report.warnings.end(), list.begin(), list.end());
  }

  void fill_course() {
    const Course<N>& course = of_.course;
    SimulationReport& r = of_.report;
    r.order = course.order();
    r.method = course.report();
    r.t = to_double(of_.end.time());
    r.steps = course.steps();
    r.constraints = to_double(course.worst_constraint());
    r.smallest_sigma = to_double(course.smallest_sigma());
    r.smallest_sigma_t = to_double(course.smallest_sigma_time());
    const std::size_t eliminations = course.taylor().eliminations();
    if (of_.s.system.form->eliminates()) r.eliminations = eliminations;
    if (of_.watch.any_redundant() && eliminations > 0)
      note("other independent constraints are chosen " +
           (eliminations == 1 ? "once" : std::to_string(eliminations) + " times") +
           " on the way: those at the initial state come to depend on one another");
    if (of_.shown.second()) {
      r.second = of_.shown.second()->report();
      r.constraints = r.second->drift;
    }
  }

  void fill_floors() {
    const Follow follow = [](const Scenario& own, const SimulationOptions& o, RowSink& rows) {
      return simulate(own, o, rows);
    };
    if (!of_.options.resume) {
      of_.floors->supports.locate(
          [&](const Support& support, double t) { return first_pull(of_.s, of_.options, support, t, follow); });
      of_.floors->traction.locate([&](const std::function<Expr(const Model&)>& formula, int direction, double t) {
        return first_passing(of_.s, of_.options, formula, direction, t, follow);
      });
    }
    for (const std::string& text : of_.floors->notes()) note(text);
  }

  // Names the multipliers that are not determined at the start or at the end. The start has notes of its own.
  void fill_undetermined() {
    const Scenario& s = of_.s;
    const UndeterminedMultipliers end = of_.watch.undetermined();
    std::vector<std::size_t> all, later;
    for (std::size_t r = 0; r < s.model->constraints.size(); ++r) {
      const bool first = !s.undetermined.group_of(r).empty(), last = !end.group_of(r).empty();
      if (first || last) all.push_back(r);
      if (last && !first) later.push_back(r);
    }
    if (!later.empty())
      note("at the end also " + multiplier_names(*s.model, later) + (later.size() == 1 ? " is" : " are") +
           " not determined: constraints that depend on one another share forces");
    for (const NamedFormula& f : formulas_with_multipliers(*s.model))
      if (note_of_formula(*s.model, s.undetermined, s.state, f).empty())
        if (const std::string text = note_of_formula(*s.model, end, s.state, f); !text.empty()) note(text);
    if (of_.report.error)
      for (const std::size_t r : all) of_.report.error->undetermined.push_back(multiplier_name(*s.model, r));
  }

  void fill_watched() {
    const std::vector<Monitor>& monitors = of_.s.model->monitors;
    for (std::size_t i = 0; i < monitors.size(); ++i) {
      const bool conserved = declared_conserved(*of_.s.model, monitors[i]);
      WatchedReport& w = (conserved ? of_.report.conserved : of_.report.monitors)
                             .emplace_back(watched(monitors[i].name, of_.watch.tracks()[i]));
      if (!conserved) w.times = of_.watch.times();
    }
    for (std::size_t i = 0; i < of_.options.conserved.size(); ++i)
      of_.report.conserved.push_back(watched(of_.options.conserved[i].name, of_.watch.tracks()[monitors.size() + i]));
  }

  WatchedReport watched(const std::string& name, const Track<W>& track) const {
    const RowWriter<N>& writer = of_.rows.writer();
    return {name,
            writer.written(track.first),
            writer.written(track.last),
            writer.written(track.least),
            writer.written(track.greatest),
            track.relative_change(),
            to_double(track.size)};
  }

  Parts of_;
};

}  // namespace anholon
