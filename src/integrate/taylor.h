// The motion by Taylor steps: order from the tolerance, step size after Jorba & Zou, a look at the equations where
// a step ends, projection on all hidden constraints at every step, compensated update of the state, dense output.
#pragma once
#include <functional>
#include <memory>
#include <optional>
#include <utility>

#include "integrate/end_check.h"
#include "integrate/events.h"
#include "integrate/regular.h"
#include "kernel/pivots.h"
#include "kernel/plan.h"

namespace anholon {

struct StepSettings {
  double log_tolerance = -27.6310211159;  // natural logarithm: 1e-400 is a tolerance too
  int order = 0;                          // of the Taylor polynomials; 0: from the tolerance
  std::size_t most_steps = 50'000'000;
  std::function<bool()> cancelled;  // asked between steps
  bool kernel = true;               // where there is one
  bool measure = true;              // how regular J is, where the kernel does not ask for it
  std::size_t integrals =
      0;  // so many of the first quadratures are integrated to the tolerance; the others as the motion's steps have it
  bool multipliers = false;  // their series are asked for (Stepper::dense): by kernels in the motion's unknowns
};

// ceil(-ln(tolerance)/2 + 1), and at least 4: the order of least work for the tolerance if that grows with the square
// of the order (Jorba & Zou 2005).
int least_work_order(double log_tolerance);
// Four more: here it grows more slowly (measured, bench/RESULTS.md). Not where the last digits are asked for, which
// longer steps would lose to round-off.
int taylor_order(double log_tolerance);
// Below 1e-14.
bool asks_for_last_digits(double log_tolerance);

template <Number To, Number From>
void convert_all(const std::vector<From>& from, std::vector<To>& to) {
  to.resize(from.size(), To(0));
  for (std::size_t i = 0; i < from.size(); ++i) to[i] = convert<To>(from[i]);
}

class Kernel;
class KernelPlan;

// The smallest singular value of J is looked at again after so many steps, and whenever the kernel's pivots have become
// this much smaller.
constexpr bool due_for_a_look(std::size_t steps) { return steps % 256 == 0 || (steps & (steps - 1)) == 0; }
inline constexpr double kNewsOfPivots = 0.8;

// What a stepper has found on its way so far.
template <Number N>
struct StepperRecord {
  using W = Wider<N>;
  W branch_step{0};
  std::size_t steps = 0;
  W worst_constraint{0}, worst_equation{0};
  N first_sigma{0}, smallest_sigma{1};
  W smallest_sigma_t{0};
  std::size_t weakest = 0;
  N sigma_before{0};     // where the last step began
  W last_step{0};        // its length
  N least_health{1};     // of the kernel's pivots
  bool careful = false;  // the step that follows was, or has to be, made without the kernel
};

// All that it carries where an expansion is made: from here the same steps follow, bit by bit.
template <Number N>
struct StepperState : StepperRecord<N> {
  using W = Wider<N>;
  W t{0};
  std::vector<W> state, carry, leading, integrals, integral_carry;
  std::vector<W> own, own_leading;  // the state and first guesses in the unknowns of a kernel that has its own, and has
                                    // begun the expansion
  std::vector<N> direction;         // of the iteration for sigma
  std::vector<int> sides;           // of the series watched for events
};

// Taylor coefficients are computed in N; the state, the projection on the constraints and the
// leading derivatives in the wider type W, with the LU of N (mixed-precision refinement). A state
// rounded to N at every step would be projected on the constraints of another point, which is what
// limits the energy of a fast spinning body over many steps.
template <Number N>
class Stepper {
 public:
  using W = Wider<N>;

  Stepper(const Program& program, const std::vector<N>& parameters, const std::vector<W>& wide_parameters,
          const StepSettings& settings);
  ~Stepper();

  // Starts at a consistent state; `leading` is a first guess and names the branch. What the stepper did before leaves
  // no trace. Without the kernel the first expansion is the reference's, as it is in lanes.
  Outcome start(const W& t, const std::vector<W>& state, const std::vector<W>& leading = {}, bool kernel = true);
  // The same, but for the expansion, which the first step makes.
  void place(const W& t, const std::vector<W>& state, const std::vector<W>& leading = {});
  // Goes on where another stepper for the same unknowns is, with its sums and counts.
  Outcome take_over(const Stepper& other);
  // Makes the expansions by a kernel wherever that serves (double only): not where its pivots have become small, nor
  // for motions with kinks or events. Before the start.
  void accelerate(std::shared_ptr<const KernelPlan> plan);
  // The same by one lane of a kernel that others use, too; its parameters are those of this motion. Steps are then made
  // side by side, see below.
  void accelerate(std::shared_ptr<Kernel> kernel, int lane);
  bool accelerated() const { return kernel_ != nullptr; }
  std::size_t expansions_by_kernel() const { return by_kernel_count_; }
  // Series to be watched for changes of sign; a step ends where one does that asks for it.
  void watch(std::vector<WatchedSeries> series) {
    events_ = EventWatch<N>(std::move(series));
    find_hiding(kinks_end());
  }
  // What fired in the last step, in order.
  const std::vector<Fired<N>>& fired() const { return fired_; }
  // Goes on from another state at the same time (after `adopt`, if another stepper was there): an event has changed it.
  // It is projected on the constraints by least change.
  Outcome restart(const std::vector<W>& state);
  void adopt(const Stepper& other);
  const std::vector<W>& state() const {
    settle();
    return state_;
  }
  // First guesses of what leads it, out of the last step's polynomial.
  const std::vector<W>& leading() const {
    settle();
    return leading_;
  }
  // Where the present expansion was made: the start of the last step, or of the next one if that is expanded already. A
  // step cut short by its end is thus repeated in full by whoever resumes.
  const StepperState<N>& begun() const;
  std::size_t expansions() const { return expansions_; }  // made so far
  Outcome resume(const StepperState<N>& begun);
  // One step towards `end`, at most up to it.
  Outcome step(const W& end);
  // Its parts, for steppers in the lanes of one kernel: after `begin_step` of all of them the kernel is to be expanded,
  // after `aim` of all it is to advance and to start the next expansion, again as long as one of them then asks for
  // another end (`look_at_end`), and nothing else may happen to it in between. Where one fails, `trouble` is what there
  // was, asked for once.
  [[nodiscard]] bool begin_step() { return begins(); }
  [[nodiscard]] bool aim(const W& end) { return aims(end); }
  [[nodiscard]] EndOfStep look_at_end(const W& end) { return looks_at_end(end); }
  [[nodiscard]] bool finish_step() { return finishes(); }
  Outcome trouble() { return outcome(false); }

  const W& time() const { return t_; }
  const W& before() const { return before_; }
  std::size_t steps() const { return record_.steps; }
  std::size_t kinks() const { return kinks_; }  // steps that one has cut short
  int order() const { return order_; }

  // The solution where the last step began, or at the start: projected and solved. Its derivatives; with `values` those
  // of all formulas, too. Where a formula has no value there, the leading derivatives are those right after it.
  const Expansion<W>& point(bool values = false) const;
  // … and anywhere in the last step, in an expansion of the caller; on request without what leads the state.
  Outcome at(const W& t, Expansion<W>& point, bool leading = true) const;

  // The dense output of the last step as it is: x_j is the sum of dense(j, k) (t - before())^k, k = 0..degree(j).
  // Coefficients up to that of the leading derivative come from the wider point.
  std::size_t unknowns() const { return program_->unknowns(); }
  int degree(std::size_t j) const { return order_ - 1 + program_->d[j]; }
  W dense(std::size_t j, int k) const {
    return k <= program_->d[j] ? point().coefficient(j, k) : convert<W>(coefficient(j, k));
  }

  // Quadrature i as a polynomial in t - before() over the last step: its value there.
  W quadrature(std::size_t i, const W& dt) const;
  // Integrals of the quadratures since the start.
  const std::vector<W>& integrals() const { return integrals_; }
  const W& worst_constraint() const { return record_.worst_constraint; }
  const W& worst_equation() const { return record_.worst_equation; }
  // Of the scaled system Jacobian: the smallest so far, when it was met, the unknown that J determined least there; the
  // first one.
  const N& smallest_sigma() const { return record_.smallest_sigma; }
  const W& smallest_sigma_time() const { return record_.smallest_sigma_t; }
  std::size_t weakest_unknown() const { return record_.weakest; }
  const N& first_sigma() const { return record_.first_sigma; }

 private:
  // The parts of a step and of its expansion; where they fail, trouble_ says why.
  bool begins();
  bool aims(const W& end) {
    return (expanded_ || ends_expansion(leading_)) && (aims_freely(end) || aims_with_care(end));
  }
  EndOfStep looks_at_end(const W& end);
  bool may_end_at(const W& h);
  W horizon() const { return limit_ > W(0) ? limit_ : convert<W>(horizon_); }
  N defect_at(const W& h);
  bool aims_freely(const W& end);
  bool aims_with_care(const W& end);
  bool aims_one_sided(const W& left);
  bool finishes();
  bool goes_on(const W& h);
  bool ends_expansion(const std::vector<W>& guess);
  // Where the next expansion is made already, its polynomial is what is left, not that of the last step.
  bool fail(Outcome o) {
    if (expanded_) before_ = t_;
    return trouble_ = std::move(o), false;
  }
  Outcome outcome(bool good) { return good ? Outcome{} : std::exchange(trouble_, {}); }
  Outcome expand(const std::vector<W>& guess);
  void begin_expansion(const std::vector<W>& guess);
  Outcome expand_here(const std::vector<W>& guess);
  Outcome expand_by_reference(const std::vector<W>& guess);
  Outcome expand_regularly(const std::vector<W>& guess);
  bool expand_one_sided(Outcome& fault);
  Outcome open_direction(const W& h);
  std::optional<std::vector<W>> leading_beyond(const W& h, std::vector<W> leading);
  std::optional<std::vector<W>> settled_leading(const W& h, std::vector<W> leading);
  std::optional<std::vector<W>> one_sided_leading(const W& h);
  bool take_one_sided(const W& h);
  W one_sided_step() const;
  void note_begun(const std::vector<W>& guess);
  bool kernel_serves() const;
  double trusted_health() const;
  void load_kernel(const std::vector<W>& guess);
  void settle() const;
  StepperState<N>& settled(int which) const;
  bool mapped() const;
  void read(const W& t, const std::vector<W>& own, std::vector<W>& state) const;
  void fetch_own_base(std::vector<W>& own) const;
  void fetch_base(std::vector<W>& state) const;
  std::optional<std::size_t> kernel_unknown(std::size_t j) const;
  void settle_as_begun();
  void settle_at_base();
  bool take_from_kernel();
  void show_roots();
  N coefficient(std::size_t j, int k) const;
  void expand_again(const StepperState<N>& last);
  Outcome look_back();
  void note_sigma(const N& sigma);
  // The slots that may have kinks: also those of what is watched for events.
  std::uint32_t kinks_end() const {
    return events_.empty() ? program_->tape.main_end : static_cast<std::uint32_t>(program_->tape.code.size());
  }
  N quadrature_coefficient(std::size_t i, int k) const;
  N step_size() const;
  double shrink() const;
  void heed_integrals();
  std::vector<W> leading_at_base() const;
  W on_the_branch(W h);
  bool near_in_branch(const W& h);
  Expansion<N>* ahead(const W& h);
  Expansion<N>* prepared(const W& t, const std::vector<W>& state, const std::vector<W>& leading);
  Expansion<N>& loaded_ahead(const W& t, const std::vector<W>& state, const std::vector<W>& leading);
  std::optional<N> quadrature_ahead(std::size_t i, const N& h);
  std::optional<Mode<N>> mode_at(const W& t, const std::vector<W>& state);
  static std::optional<Mode<N>> mode_of(Expansion<N>* there);
  std::optional<W> singular_within(const W& h);
  bool end_out_of_reach(const W& h, const W& left) const;
  bool nothing_in_the_way() const;
  void aim_at(const W& t, bool arrives);
  void send_kernel(const W& h);
  N defect_by_kernel() const;
  void find_hiding(std::uint32_t end);
  void find_hidden(const W& h);
  void find_hidden_by_kernel(const N& h);
  std::optional<N> quadrature_there(std::size_t i);
  bool ends_as_foretold(W& h, const W& whole);
  void advance_kernel(const W& h) const;
  void advanced_by_kernel(const W& h, const std::vector<W>& base, std::vector<W>& state, std::vector<W>& leading) const;
  void on_polynomial(const W& h, std::vector<W>& state, std::vector<W>& leading) const;
  void polynomial(const W& h, std::vector<W>& increments, std::vector<W>& leading) const;

  const Program* program_;
  StepSettings settings_;
  Outcome trouble_;
  int order_;
  std::vector<N> parameters_;
  Expansion<N> expansion_;
  mutable Expansion<W> point_;
  mutable bool point_loaded_ = true, point_valued_ = true;
  std::shared_ptr<Kernel> kernel_;
  int lane_ = 0;
  bool alone_ = true;    // in the kernel
  bool loaded_ = false;  // the kernel is to make the expansion that was begun
  // The state, what leads it and where it began are with the kernel, which goes on from there; whoever asks for them
  // settles that first.
  mutable bool away_ = false;
  W aimed_{0};                                            // where the step ends
  bool arrives_ = false;                                  // at what the caller has set
  EndCheck<N> check_;                                     // of the present step
  std::vector<std::pair<std::uint32_t, Hiding>> hiding_;  // slots of the tape
  std::vector<N> hidden_;                                 // points within the step to be looked at
  bool at_kink_ = false;                                  // the step ends past one
  W limit_{0};                                            // of its length, where that check has shortened it; else 0
  W looked_{0};  // how far the equations are looked at: to its end, or shortly before a kink; 0 where they are not
  W sent_{0};    // how far the kernel was sent to look
  std::vector<std::pair<std::uint32_t, std::uint32_t>>
      kink_series_;              // what kernel expansions have to show of possible kinks: slot, where the kernel has it
  bool may_touch_zero_ = false;  // one of them, within the present horizon
  bool by_kernel_ = false;       // the present expansion
  Pivots pivots_before_;         // of the kernel, at the last expansion
  bool suspected_ = false;  // J may have been singular within the last step by the kernel, or may be so within the next
  std::size_t by_kernel_count_ = 0;
  mutable std::vector<W> base_state_;    // where the kernel's expansion of the last step was made
  std::unique_ptr<Expansion<N>> ahead_;  // for looks at J further on the polynomial
  N sigma_{0};                           // where the present step began
  bool singular_ahead_ = false;          // right after the present state
  std::size_t kinks_ = 0, kinks_before_ = 0;
  // The present expansion ends with the leading derivatives, for a very short step, as formulas have no derivatives
  // there, or no value.
  struct OneSided {
    Outcome fault;            // of the expansion
    std::vector<W> at_point;  // the leading derivatives at the point, empty if the equations have none
  };
  std::optional<OneSided> one_sided_;
  int short_kinks_ = 0;  // steps in a row that were cut by a kink at their very start
  EventWatch<N> events_{{}};
  std::vector<Fired<N>> fired_;
  W started_{0}, t_{0}, before_{0};
  N horizon_{0};
  mutable std::vector<W> state_, leading_;
  mutable std::vector<W> own_, own_leading_;  // the same in the unknowns of the kernel, where it has its own and state_
                                              // is from there; else empty
  std::vector<W> carry_, integrals_, integral_carry_;
  std::vector<N> narrow_state_, narrow_leading_, narrow_r_, narrow_y_;
  StepperRecord<N> record_;
  bool expanded_ = false;             // at t_
  mutable StepperState<N> begun_[2];  // of the present expansion and the one before
  bool begun_by_kernel_[2] = {};      // which has the states of those, while they are away
  int now_ = 0;                       // which of them is the present one
  bool carried_ = false;              // nothing is left in carry_
  std::vector<W> change_, next_;
  std::size_t expansions_ = 0;
};

extern template class Stepper<double>;
extern template class Stepper<long double>;
extern template class Stepper<Quad>;
extern template class Stepper<Multi>;

}  // namespace anholon
