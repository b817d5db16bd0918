// What is watched along a motion, point by point: the residual report by another way than the equations integrated, and
// the reactions N that the rows show.
//
//   C1, C2  Newton's law by the points themselves, with and without multipliers  (theory: certificate)
//   C3      hidden constraints
//   power   h - h(0) - W, W the integral of the right side of the power identity
// each in relation to the greatest of its terms so far: a motion that comes to rest is measured by what it was
// and the model's [monitor] formulas and the integrals of the motion  (theory: integrals).
#pragma once
#include "mechanics/conserved.h"
#include "motion/motion.h"
#include "numeric/relative.h"
#include "observe/evaluate.h"
#include "observe/report.h"
#include "setup/redundant.h"

namespace anholon {

// What has to be integrated for it: the power of all forces first, then the masses that vary.
std::vector<Expr> watched_quadratures(Workspace& s, const Power& p);

// The constraints with a residual for each derivative that has to vanish, none seen yet.
std::vector<ConstraintReport> constraint_reports(const Scenario& s);

// Whether [output] conserved = true says of a monitor that it keeps its value: of a vector all components do.
bool declared_conserved(const Model& model, const Monitor& m);

// A number along the motion: its range, and how far it went from its first value.
template <Number W>
struct Track {
  bool any = false;
  W first{0}, last{0}, least{0}, greatest{0}, change{0}, size{0}, missed{0};
  W made{0};  // the greatest of the numbers that the terms are made of, where these are known
  void see(const W& value);
  // What ought to be constant. `terms`: the sum of the magnitudes of its terms; `made_of`: of the numbers these are
  // made of (numeric/relative.h); `moved`: of those with which it may change by round-off.
  void see(const W& value, const W& terms, const W& made_of, const W& moved);
  // The same of a number that was computed in doubles.
  void see_double(double value, double terms, double made_of);
  // Of its size; or of its terms, if it ought to be constant; or of the numbers these are made of, if it is large
  // beside the terms and small beside those: where terms cancel, what is left of them is the error of the motion.
  double relative_change() const;
};

template <Number W>
class Watch {
 public:
  Watch(Workspace& scenario, const Power& power, const std::vector<Conserved>& conserved,
        const std::vector<W>& parameters);

  // At a point of the motion: fills the residuals of the report. Not ok if a redundant constraint no longer follows
  // from the others.
  Outcome see(const Expansion<W>& point, SimulationReport& report);
  // What is tracked alone, at a row that was computed in doubles: value(k) and terms(k) of the k-th sum of the monitors
  // and the integrals, one after the other.
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
  // Whether outputs are declared conserved; sees what is to be constant alone, at a point between rows.
  bool any_declared() const {
    const auto end = constant_.begin() + static_cast<std::ptrdiff_t>(s_.model->monitors.size());
    return std::find(constant_.begin(), end, true) != end;
  }
  void look(const Expansion<W>& point);
  // Whether there are monitors whose range is reported; these alone are seen at a point between rows, or at one that was
  // computed in doubles: value(i) of the i-th monitor.
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
  // How many times of the motion the ranges are made of: the rows, and the points between them. The start counts by
  // count_start() if it has no row; the two sides of an event are at the end of a step, and do not count again.
  void count_start() { ++times_; }
  std::size_t times() const { return times_; }
  // Whether constraints are left out that have to follow from the others.
  bool any_redundant() const { return redundant_.any(); }
  // Whether they do.
  Outcome still_redundant(const Expansion<W>& point, SimulationReport& report);
  // The monitors of the model, then the integrals.
  const std::vector<Track<W>>& tracks() const { return tracks_; }
  // What was seen, for a run that goes on.
  void save(SavedRun& to) const;
  void resume(const SavedRun& from, const std::vector<W>& parameters);
  // lambda of every constraint, N and the monitors at the point seen last.
  const W& multiplier(std::size_t constraint) const { return multipliers_[constraint]; }
  const W& reaction(std::size_t coordinate) const { return outputs_[coordinate]; }
  const W& monitor(std::size_t i) const { return tracks_[i].last; }
  // There: the numbers that a monitor is made of (numeric/relative.h); what the terms of Newton's law are made of, in
  // relation to the greatest of these so far.
  double made_of_monitor(std::size_t i) const { return to_double(outputs_.made_of(first_monitor_ + i)); }
  double cancellation() const { return forces_ > W(0) ? to_double(W(made_of_forces() / forces_)) : 1; }

  // The first and the last point: the energy balance goes from one to the other, between which the work is integrated.
  void start(const Expansion<W>& point);
  // What an event changes at a moment is no work: the energy before and after it, and the modes from there on.
  void leave(const Expansion<W>& point);
  void enter(const Expansion<W>& point, const std::vector<W>& parameters);
  // The work so far, where a step begins.
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
  std::vector<std::size_t> terms_;  // of which each is the sum
  std::vector<bool> constant_;      // which ought to be
  std::size_t times_ = 0;           // at which monitors were seen
  std::vector<double> made_of_;     // of the numbers behind their terms, at the point seen last
  // Constraints that no derivative hides: their accelerations, … are solved for with the equations.
  std::vector<std::size_t> open_;
  std::size_t first_open_ = 0, first_monitor_ = 0;  // among the outputs
  OutputTape<W> outputs_;
  Redundant<W> redundant_;
  std::vector<W> multipliers_;
  W h0_{0}, start_{0}, before_{0};
  // The greatest so far: of the terms of Newton's law, of energies and work.
  W forces_{0}, turned_over_{0};
  // What Newton's law and the constants are made of if accelerations are as large as the terms of the equations, at the
  // point seen last (OutputTape::evaluate_moved).
  W moved_forces_{0};
  std::vector<W> moved_;
  std::vector<W> from_;  // the coordinates at the start
};

extern template class Watch<long double>;
extern template class Watch<Quad>;
extern template class Watch<Multi>;

}  // namespace anholon
