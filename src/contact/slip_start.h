// How contacts at rest begin to slip where friction no longer holds them (theory: contact).
#pragma once
#include <functional>

#include "contact/joined_report.h"
#include "contact/touching_bodies.h"

namespace anholon {

// Follows the motion in the present modes of the bodies to a time, without rows; returns whether the modes last so long, with the
// state at their end.
using Ahead = std::function<bool(const Rational& to, ContactState& at)>;

// Whether friction of a contact that sticks, which has come to its bound by the event at which the last segment ended, does not go
// beyond it: it only touches the bound where the forces have a kink there, as those of a table at a knot, or jump. The contact
// has forces of its own. Returns false if something else changes before that is told.
bool only_touches_bound(TouchingBodies& bodies, std::size_t contact, const Ahead& ahead);

class SlipStart {
 public:
  // Follows the motion in the present modes to a time, or to their end; returns false if the motion ends there.
  using Segment = std::function<bool(const Rational& to, Outcome& outcome)>;
  // Refers to the bodies and the report. `end`: of the motion.
  SlipStart(TouchingBodies& bodies, JoinedReport& joined, Rational end, Segment segment)
      : bodies_(bodies), joined_(joined), end_(std::move(end)), segment_(std::move(segment)),
        told_(bodies.contacts.size(), false), held_(bodies.contacts.size()) {}

  // The event at which a segment has ended tells that the contact slips.
  void told(std::size_t contact) { told_[contact] = true; }
  // Where a slip with two components begins without acceleration, its velocity grows by the square of the time, and as long
  // as it is small its direction is stiff. The contact is held for the time h of time_to_grow; the error is of the order of h^3
  // (theory: contact). Returns false if the motion ends meanwhile.
  bool hold(Outcome& outcome);
  // Of contacts that shared friction, those that slip with the one at which the last segment ended; one that sticks on, as it only
  // touched its limit or the others hold it, has not slipped.
  void tell_who_slips_too(const ContactModes& now);
  // Puts in the directions against the friction that held, as first guesses.
  void guess_directions(ContactProblem& problem) const;
  // Gives slips with two components the velocities with which they begin. `list`: the contacts of the present modes. A single
  // one that begins with an acceleration waits instead: its direction stays the same for a moment, which wait() follows.
  void begin(const std::vector<std::size_t>& list, const std::vector<long double>& accelerations);
  bool waits() const { return waits_.has_value(); }
  // Follows the motion for this moment, after which the slip has a velocity. Returns false if the motion ends meanwhile.
  bool wait(Outcome& outcome);
  // Whether the slip of this contact has begun with the last segment, so that its velocity is small.
  bool has_just_begun(std::size_t c) const { return begun_ == c; }

 private:
  // Whether a contact shared friction and may begin to slip.
  bool was_held(std::size_t c) const;
  // The slip velocity from which a slip with two components is followed. After held_ it has grown with the acceleration.
  long double first_slip(std::size_t c, const std::vector<long double>& accelerations) const;
  void begin_alone(std::size_t c, const std::vector<long double>& accelerations);
  // Lets the direction of the slip stay the same for the moment after which it is large against round-off, unless something else
  // than this slip changes now.
  bool lets_wait(std::size_t c, const std::vector<long double>& accelerations);
  // Slips that begin at once on bodies that join them have velocities as their accelerations are.
  void begin_together(const std::vector<std::size_t>& list, const std::vector<long double>& accelerations);
  // How long these accelerations may act until a slip that goes on has half of its velocity: infinite if none becomes slower.
  long double time_to_reverse(const std::vector<long double>& accelerations) const;
  // Where contacts share friction, one at its limit may leave the rest to the others. Then they share it anew, which is no
  // event; else they are held until those that begin to slip are told by their accelerations. Returns false if the motion
  // ends meanwhile.
  bool share_anew(Outcome& outcome);
  // Holds all contacts that stick; returns false if the motion ends meanwhile.
  bool hold_together(long double time, Outcome& outcome);
  // As hold() does for one contact: those of two components are held until their slip has a velocity by which it is followed.
  bool hold_to_grow(Outcome& outcome);
  // How long a contact is to be held until the slip velocity is kHeld of its terms, by the rate of its slip acceleration.
  long double time_to_grow(std::size_t c, long double rate) const;
  // Whether the friction that is needed to hold a contact, which was too large, no longer is: a disc that rocks needs most
  // where it turns back.
  bool holds_again(std::size_t c);
  // Whether the last segment ended with a slip of this contact that has two components and one coefficient of friction.
  bool begins_at_rest(std::size_t c) const;
  enum class Hold : std::uint8_t { to_its_end, something_else_happens, motion_ends };
  Hold hold_for(std::size_t c, long double time, Outcome& outcome);
  // The time after a moment, rounded as the times of events are.
  Rational later(long double time) const;

  TouchingBodies& bodies_;
  JoinedReport& joined_;
  Rational end_;
  Segment segment_;
  std::vector<bool> told_;
  long double together_ = 0;  // for how long contacts that share friction were held last
  double held_until_ = 0;     // the time at which that ended
  // The time for which a contact that begins to slip was held. The acceleration of the slip then
  struct Held {
    long double time = 0;
    long double rate = 0;  // is zero where the slip begins, and has this rate there
  };
  std::vector<Held> held_;
  struct Waiting {
    std::size_t contact;
    long double time;
  };
  std::optional<Waiting> waits_;
  std::optional<std::size_t> begun_;  // the contact that has waited just now
};

}  // namespace anholon
