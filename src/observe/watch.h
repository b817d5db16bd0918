// Watches a motion point by point: the residual report, by another way than the equations that were integrated, and the
// reactions N in the rows.
//
//   C1, C2  Newton's law by the points themselves, with and without multipliers  (theory: certificate)
//   C3      hidden constraints
//   power   h - h(0) - W, W the integral of the right side of the power identity
// each relative to the greatest of its terms so far, so that a motion that comes to rest is measured by its past,
// and the model's [monitor] formulas and the integrals of the motion  (theory: integrals).
#pragma once
#include "mechanics/conserved.h"
#include "motion/motion.h"
#include "numeric/relative.h"
#include "observe/evaluate.h"
#include "observe/report.h"
#include "setup/outputs/redundant.h"

namespace anholon {

// The formulas that have to be integrated: the power of all forces first, then the masses that vary.
std::vector<Expr> watched_quadratures(Workspace& s, const Power& p);

// The reports of the constraints, with zero residuals for each derivative that has to vanish.
std::vector<ConstraintReport> constraint_reports(const Scenario& s);

// True if [output] conserved = true declares a monitor constant; for a vector, all its components.
bool declared_conserved(const Model& model, const Monitor& m);

// A number along the motion: its range, and its distance from its first value.
template <Number W>
struct Track {
  bool any = false;
  W first{0}, last{0}, least{0}, greatest{0}, change{0}, size{0}, missed{0};
  W made{0};  // the greatest of the numbers that the terms are made of, if these are known
  void see(const W& value);
  // Sees a number that should be constant. `terms`: the sum of the magnitudes of its terms; `made_of`: of the numbers
  // from which the terms are made (numeric/relative.h); `moved`: of the numbers with which it may change by round-off.
  void see(const W& value, const W& terms, const W& made_of, const W& moved);
  // Sees such a number that was computed in doubles.
  void see_double(double value, double terms, double made_of);
  // The change relative to its size; for a number that should be constant, relative to its terms, or to the numbers
  // that the terms are made of, if the change is large relative to the terms and small relative to these: if terms
  // cancel, their error is that of the motion.
  double relative_change() const;
};

template <Number W>
class Watch {
 public:
  Watch(Workspace& scenario, const Power& power, const std::vector<Conserved>& conserved,
        const std::vector<W>& parameters);

  // Sees a point of the motion, and fills the residuals of the report. Fails if a redundant constraint does not follow
  // from the others any more.
  Outcome see(const Expansion<W>& point, SimulationReport& report);
  // Sees the tracked numbers alone, at a row that was computed in doubles: value(k) and terms(k) of the k-th sum of the
  // monitors and the integrals, one after the other.
  template <class Value, class Terms>
  void track(Value value, Terms terms) {
    ++times_;
    std::size_t at = 0;
    for (std::size_t i = 0; i < tracks_.size(); ++i) {
      double sum = 0, size = 0;
      for (std::size_t k = 0; k < terms_[i]; ++k, ++at) sum += value(at), size += constant_[i] ? terms(at) : 0;
      if (constant_[i])
        tracks_[i].see_double(sum, size, made_of_[i]);
      else
        tracks_[i].see(W(sum));
    }
  }
  // any_declared(): true if outputs are declared conserved. look(): sees only the numbers that should be constant, at a
  // point between rows.
  bool any_declared() const {
    const auto end = constant_.begin() + static_cast<std::ptrdiff_t>(s_.model->monitors.size());
    return std::find(constant_.begin(), end, true) != end;
  }
  void look(const Expansion<W>& point);
  // any_ranges(): true if there are monitors whose range is reported. look_at_ranges() sees these alone at a point
  // between rows, track_ranges() at one that was computed in doubles: value(i) of the i-th monitor.
  bool any_ranges() const {
    const auto end = constant_.begin() + static_cast<std::ptrdiff_t>(s_.model->monitors.size());
    return std::find(constant_.begin(), end, false) != end;
  }
  void look_at_ranges(const Expansion<W>& point);
  template <class Value>
  void track_ranges(Value value) {
    for (std::size_t i = 0; i < s_.model->monitors.size(); ++i)
      if (!constant_[i]) tracks_[i].see(W(value(i)));
    ++times_;
  }
  // The number of times from which the ranges come: the rows, and the points between them. The start is counted by
  // count_start() if it has no row; the two sides of an event are at the end of a step, and are not counted again.
  void count_start() { ++times_; }
  std::size_t times() const { return times_; }
  // True if there are redundant constraints, which have to follow from the others.
  bool any_redundant() const { return redundant_.any(); }
  // The dependencies of the constraints at the last point that was seen.
  UndeterminedMultipliers undetermined() const { return redundant_.undetermined(); }
  // Fails if they do not follow any more.
  Outcome still_redundant(const Expansion<W>& point, SimulationReport& report);
  // The monitors of the model, then the integrals.
  const std::vector<Track<W>>& tracks() const { return tracks_; }
  // save() and resume() pass what was seen to a continued run.
  void save(SavedRun& to) const;
  void resume(const SavedRun& from, const std::vector<W>& parameters);
  // The multiplier of a constraint, the reaction N and the monitors at the last point.
  const W& multiplier(std::size_t constraint) const { return multipliers_[constraint]; }
  const W& reaction(std::size_t coordinate) const { return outputs_[coordinate]; }
  const W& monitor(std::size_t i) const { return tracks_[i].last; }
  // At the last point: the numbers that a monitor is made of (numeric/relative.h); and the size of what the terms of
  // Newton's law are made of, relative to the greatest of these terms so far.
  double made_of_monitor(std::size_t i) const { return to_double(outputs_.made_of(first_monitor_ + i)); }
  double cancellation() const { return forces_ > W(0) ? to_double(W(made_of_forces() / forces_)) : 1; }

  // start() sees the first point, end() the last one: the energy balance goes from one to the other, with the work
  // between them.
  void start(const Expansion<W>& point);
  // The change of energy by an event is no work: leave() takes the energy before it, enter() the energy and the modes
  // after it.
  void leave(const Expansion<W>& point);
  void enter(const Expansion<W>& point, const std::vector<W>& parameters);
  // Takes the work so far, at the start of a step.
  void turn_over(const W& work) { turned_over_ = std::max(turned_over_, W(abs(work))); }
  void end(const Expansion<W>& point, const W& work, SimulationReport& report);

 private:
  Column expressions(const Power& power, const std::vector<Conserved>& conserved);
  enum class Which : std::uint8_t { all, constants, ranges };
  void track(Which which = Which::all);
  W made_of_forces() const;
  void see_moved(const Expansion<W>& point);
  std::vector<std::size_t> rows_at(const Expansion<W>& point) const;
  void constraints(const Expansion<W>& point, const std::vector<std::size_t>& rows, const Matrix<W>& phi,
                   SimulationReport& report) const;
  void newton(const NewtonResidual<W>& c, SimulationReport& report);
  W energy() const { return outputs_[s_.system.coordinates]; }

  const Scenario& s_;
  std::vector<std::size_t> rows_;  // the constraints that may take part, by their index in the model
  std::vector<Track<W>> tracks_;
  std::vector<std::size_t> terms_;  // the number of terms of each
  std::vector<bool> constant_;      // whether each should be constant
  std::size_t times_ = 0;           // the number of times at which monitors were seen
  std::vector<double> made_of_;     // of the numbers behind their terms, at the last point
  // Constraints without hidden derivatives: their accelerations, … are solved for with the equations.
  std::vector<std::size_t> open_;
  std::size_t first_open_ = 0, first_monitor_ = 0;  // indices among the outputs
  OutputTape<W> outputs_;
  Redundant<W> redundant_;
  std::vector<W> multipliers_;
  W h0_{0}, start_{0}, before_{0};
  // The greatest so far of the terms of Newton's law, and of energies and work.
  W forces_{0}, turned_over_{0};
  // The size of what Newton's law and the constants are made of if accelerations are as large as the terms of the
  // equations, at the last point (OutputTape::evaluate_moved).
  W moved_forces_{0};
  std::vector<W> moved_;
  std::vector<W> from_;  // the coordinates at the start
};

extern template class Watch<long double>;
extern template class Watch<Quad>;
extern template class Watch<Multi>;

}  // namespace anholon
