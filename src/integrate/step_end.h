// Where a step ends: before the first kink, at an event, where the equations hold that the series foretell, or where
// the caller has set the end (theory: taylor).
#pragma once
#include "integrate/end_check.h"
#include "integrate/look_ahead.h"
#include "integrate/series/events.h"
#include "integrate/series/kinks.h"
#include "kernel/plan/plan.h"

namespace anholon {

// What is said of the end of a step after a look at the equations there: it is good, the next look is elsewhere, the
// step has to be made shorter, or by the reference: the velocities that the kernel's unknowns give there are others, or
// its solutions have lost their digits.
enum class LookAtEnd : std::uint8_t { good, elsewhere, shorten, by_reference };

template <Number N>
class StepEnd {
 public:
  using W = Wider<N>;
  StepEnd(const Program& program, double log_tolerance, int order);
  // Slots of the tape that may have kinks: those before `end`. `others`: those that decide for what only watches the motion,
  // which gives up where its kinks come too often.
  void set_slots(std::uint32_t end, std::vector<bool> others);
  const std::vector<bool>& others() const { return others_.slots; }
  // These decide for what only watches, and are round-off over the whole step: they have no kinks.
  void pass_over(const std::vector<std::uint32_t>& slots);
  std::uint32_t slots() const { return slots_; }

  // Another motion, or another state of it: the next step is not shortened for what was seen before.
  void restart();
  // A step begins: what it counts is taken back by `again`, if it has to be made shorter.
  void begin() { kinks_before_ = kinks_; }
  void again() { kinks_ = kinks_before_; }
  // The step is made.
  void finish();
  // The length that a look at the end has left of the horizon.
  W horizon(const N& of_series) const { return limit_ > W(0) ? limit_ : convert<W>(of_series); }

  // The step ended at a kink.
  bool at_kink() const { return at_kink_; }
  // A constraint that is missed by a larger part after a kink turns there.
  static constexpr double kTurned = 1e-6;
  // After a step the next expansion is made at t, with this outcome, or is not. Not ok either where the motion does not pass
  // the kink at which the step ended, as a constraint turns there, or passes such kinks sooner and sooner.
  Outcome pass_turn(const MissedConstraint<N>& missed, const Machine<N>& machine, const W& t, Outcome made);
  // Shortens a step over h to what the equations hold for, and to its first kink. `whole`: what it would be without an
  // end. Not ok where the motion stays at a kink.
  Outcome shorten(PresentStep<N>& step, const EventWatch<N>& events, W& h, const W& whole);
  // Whether an ordinary step may follow, which nothing cuts short.
  bool free_of_kinks() const { return in_a_row_.short_kinks == 0; }
  // Whether the next step may be made without this class: nothing is left to be looked at of the one before.
  bool idle() const { return in_a_row_.short_kinks == 0 && limit_ == W(0); }
  bool passes_at_once(const N& rate, const N& h) const { return check_.passes_at_once(rate, h); }
  // Whether the step and the one before are cut by a kink at their start: the reference makes the next one, which looks at
  // the ends of such steps.
  bool meets_again() const { return in_a_row_.met_again > 1; }
  // The step has no kink; its end is looked at. Or it begins at one.
  void set_free(const W& h);
  void set_one_sided();
  // Up to where series hold; nullopt if that is all of the step.
  std::optional<N> kink() const { return at_kink_ ? std::optional<N>(convert<N>(looked_)) : std::nullopt; }

  // The step ends at that time, which is where the caller's end is, or not. A kernel is sent there, or to where the
  // equations are looked at before.
  void aim(PresentStep<N>& step, const W& t, bool arrives);
  // A kernel is where it was sent.
  LookAtEnd look(KernelExpansion& kernel, const W& t, const N& horizon);

  const W& time() const { return aimed_; }
  bool arrives() const { return arrives_; }
  std::size_t kinks() const { return kinks_; }  // that have cut a step short

 private:
  struct Others {
    std::vector<bool> slots, passed_over;
    bool give_up = false;
    int shortened = 0;  // steps in a row that their kinks have made much shorter
  };
  // What decides at a kink: its value there, and its rate before.
  struct Passing {
    std::uint32_t slot;
    N value, rate;
  };
  // Kinks at which constraints turn: what decides at the last one; when one was passed, the longest time between two, and how
  // many in a row were passed after a far shorter one; and how many expansions in a row were put back before the kink.
  struct Turns {
    std::vector<Passing> passed;
    std::optional<W> last = {};
    W longest{0};
    int soon = 0, put_back = 0;
    bool forward = true;
  };
  // Numbers of steps in a row.
  struct InARow {
    int short_kinks = 0;  // that were cut by a kink shortly after their start
    int met_again = 0;    // that were cut by a kink at their start or shortly after it
  };
  struct Hidden {
    std::uint32_t slot;
    Hiding function;
  };
  W length_past(PresentStep<N>& step, const W& where, const W& past, bool forward);
  // Where a step ends that meets the kink; `past`: what makes sure that it is past one.
  W beyond(PresentStep<N>& step, const EventWatch<N>& events, const Kink<N>& kink, const W& where, const W& past,
           bool forward) const;
  void note_passing(const Machine<N>& machine, const Kink<N>& kink, bool forward);
  bool put_back(const Machine<N>& machine) const;
  Outcome stays_at_constraint(std::size_t equation) const;
  Outcome note_kink(bool at_start, const W& where, const W& past);
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
  std::vector<Hidden> hiding_;  // slots whose function may do what its series do not show
  std::vector<N> hidden_;       // points within the step to be looked at
  std::vector<N> residual_, change_;
  W aimed_{0};            // the time where the step ends
  bool arrives_ = false;  // where the caller has set the end
  bool at_kink_ = false;  // it ends past a kink
  Turns turns_;
  W limit_{0};   // of its length, where a look at its end has shortened it; else 0
  W looked_{0};  // how far the equations are looked at: to its end, or shortly before a kink; 0 where they are not
  W sent_{0};    // how far the kernel was sent to look
  std::size_t kinks_ = 0, kinks_before_ = 0;
  InARow in_a_row_;
};

extern template class StepEnd<double>;
extern template class StepEnd<long double>;
extern template class StepEnd<Quad>;
extern template class StepEnd<Multi>;

}  // namespace anholon
