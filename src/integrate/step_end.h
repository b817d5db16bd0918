// Decides where a step ends: before the first kink, at an event, where the equations hold that the series foretell, or
// where the caller has set the end (theory: taylor).
#pragma once
#include "integrate/end_check.h"
#include "integrate/look_ahead.h"
#include "integrate/series/events.h"
#include "integrate/series/kinks.h"
#include "kernel/plan/plan.h"

namespace anholon {

// The result of a look at the equations at the end of a step. good: the step is good. elsewhere: the next look is
// elsewhere. shorten: the step has to be shorter. by_reference: the reference has to make the step, because the
// velocities from the kernel's unknowns differ there, or its solutions have lost their digits.
enum class LookAtEnd : std::uint8_t { good, elsewhere, shorten, by_reference };

template <Number N>
class StepEnd {
 public:
  using W = Wider<N>;
  StepEnd(const Program& program, double log_tolerance, int order);
  // Sets the slots of the tape that may have kinks: those before `end`. `others`: the slots that decide only for what
  // watches the motion; their kinks are ignored once they come too often.
  void set_slots(std::uint32_t end, std::vector<bool> others);
  const std::vector<bool>& others() const { return others_.slots; }
  // Ignores the kinks of these slots, which decide only for what watches the motion, and are round-off over the whole
  // step.
  void pass_over(const std::vector<std::uint32_t>& slots);
  std::uint32_t slots() const { return slots_; }

  // Begins another motion, or another state of it: the next step is not shortened by what was seen before.
  void restart();
  // begin(): a step begins. again(): restores the count of kinks, because the step has to be made shorter.
  void begin() { kinks_before_ = kinks_; }
  void again() { kinks_ = kinks_before_; }
  // Notes that the step is made.
  void finish();
  // The length that a look at the end has left of the horizon.
  W horizon(const N& of_series) const { return limit_ > W(0) ? limit_ : convert<W>(of_series); }

  // True if the step ended at a kink.
  bool at_kink() const { return at_kink_; }
  // A constraint that is missed by a larger part after a kink turns there.
  static constexpr double kTurned = 1e-6;
  // Call it when the expansion after a step at t is made or has failed, with its outcome. It also fails if the motion
  // does not pass the kink at which the step ended, because a constraint turns there, or passes such kinks at ever
  // shorter intervals.
  Outcome pass_turn(const MissedConstraint<N>& missed, const Machine<N>& machine, const W& t, Outcome made);
  // Shortens a step over h to the length over which the equations hold, and to its first kink. `whole`: the length of
  // the step without an end. Fails if the motion stays at a kink.
  Outcome shorten(PresentStep<N>& step, const EventWatch<N>& events, W& h, const W& whole);
  // True if an ordinary step may follow, which no kink cuts short.
  bool free_of_kinks() const { return in_a_row_.short_kinks == 0; }
  // True if the next step may be made without this class: nothing of the step before is pending.
  bool idle() const { return in_a_row_.short_kinks == 0 && limit_ == W(0); }
  bool passes_at_once(const N& rate, const N& h) const { return check_.passes_at_once(rate, h); }
  // True if this step and the one before are cut by a kink at their start: the reference makes the next step, because
  // it looks at the ends of such steps.
  bool meets_again() const { return in_a_row_.met_again > 1; }
  // set_free(): the step has no kink, and its end is looked at. set_one_sided(): the step begins at a kink.
  void set_free(const W& h);
  void set_one_sided();
  // The distance over which series hold; nullopt if that is the whole step.
  std::optional<N> kink() const { return at_kink_ ? std::optional<N>(convert<N>(looked_)) : std::nullopt; }

  // Ends the step at time t. `arrives`: t is the caller's end. A kernel is sent there, or first to where the equations
  // are looked at.
  void aim(PresentStep<N>& step, const W& t, bool arrives);
  // Judges the equations where the kernel has gone.
  LookAtEnd look(KernelExpansion& kernel, const W& t, const N& horizon);

  const W& time() const { return aimed_; }
  bool arrives() const { return arrives_; }
  std::size_t kinks() const { return kinks_; }  // the number of kinks that have cut a step short

 private:
  struct Others {
    std::vector<bool> slots, passed_over;
    bool give_up = false;
    int shortened = 0;  // steps in a row that their kinks have made much shorter
  };
  // A value that decides at a kink: the value there, and its rate before the kink.
  struct Passing {
    std::uint32_t slot;
    N value, rate;
  };
  // The kinks at which constraints turn: the deciding values at the last one; of the kinks that were passed, the
  // longest time between two, and the number in a row that came after a far shorter time; the number of expansions in a
  // row that were put back before the kink.
  struct Turns {
    std::vector<Passing> passed;
    std::optional<W> last = {};
    W longest{0};
    int soon = 0, put_back = 0;
    bool forward = true;
  };
  // The numbers of consecutive steps of some kinds.
  struct InARow {
    int short_kinks = 0;        // steps that were cut by a kink shortly after their start
    int met_again = 0;          // steps that were cut by a kink at their start or shortly after it
    W past{0}, past_before{0};  // how far the last step and the one before went past their kinks; 0 without a kink
  };
  // The points within a step to be looked at. known: the arguments of the functions have series that reach over the step.
  struct Hidden {
    std::vector<N> points;
    bool known = true;
  };
  W length_past(PresentStep<N>& step, const W& where, const W& past, bool forward);
  // Returns where a step ends that meets the kink; `past`: the distance that surely leads past a kink.
  W beyond(PresentStep<N>& step, const EventWatch<N>& events, const Kink<N>& kink, const W& where, const W& past,
           bool forward) const;
  void note_passing(const Machine<N>& machine, const Kink<N>& kink, bool forward);
  bool put_back(const Machine<N>& machine) const;
  Outcome stays_at_constraint(std::size_t equation) const;
  Outcome note_kink(bool at_start, const W& where, const W& past);
  bool is_short(const W& where, const W& past) const;
  W surely_past(const W& t, const W& length) const;
  W past_kink(const Kink<N>& kink, const W& t, const W& where, const W& h) const;
  bool are_too_many(const Kink<N>& kink, const W& where, const W& past, const W& whole);
  bool may_end_at(PresentStep<N>& step, const EventWatch<N>& events, const W& h);
  bool as_foretold(PresentStep<N>& step, const EventWatch<N>& events, const N& where) const;
  bool shows_events(PresentStep<N>& step, const EventWatch<N>& events, const W& h);
  N defect(PresentStep<N>& step, const W& h);
  void find_hidden(PresentStep<N>& step, const W& h);
  LookAtEnd send(KernelExpansion& kernel, const W& t, const W& h);
  bool velocities_jump(const KernelExpansion& kernel, const W& t, const N& horizon) const;

  const Program* program_;
  double log_tolerance_;
  int order_;
  EndCheck<N> check_;
  std::uint32_t slots_ = 0;
  Others others_;
  std::vector<HidingSlot> hiding_;  // slots whose function may do what its series do not show
  Hidden hidden_;
  std::vector<N> residual_, change_;
  W aimed_{0};            // the end of the step
  bool arrives_ = false;  // the step ends where the caller has set the end
  bool at_kink_ = false;  // the step ends past a kink
  Turns turns_;
  W limit_{0};   // of the step's length, if a look at its end has shortened it; else 0
  W looked_{0};  // where the equations are looked at: at the end, or shortly before a kink; 0 without a look
  W sent_{0};    // how far the kernel was sent for a look
  std::size_t kinks_ = 0, kinks_before_ = 0;
  InARow in_a_row_;
};

extern template class StepEnd<double>;
extern template class StepEnd<long double>;
extern template class StepEnd<Quad>;
extern template class StepEnd<Multi>;

}  // namespace anholon
