// Begins the slips of contacts at rest that friction does not hold any longer (theory: contact).
#pragma once
#include <functional>

#include "contact/joined_report.h"
#include "contact/touching_bodies.h"

namespace anholon {

// Follows the motion in the present modes of the bodies to a time, without rows. Returns true if the modes last so
// long, with the state at their end.
using Ahead = std::function<bool(const Rational& to, ContactState& at)>;

// True if friction of a contact that sticks, which has come to its bound by the event at the end of the last segment,
// does not go beyond it: it only touches the bound if the forces have a kink there, as those of a table at a knot, or
// jump. The contact has forces of its own. Returns false if something else changes before this is decided.
bool only_touches_bound(TouchingBodies& bodies, std::size_t contact, const Ahead& ahead);

class SlipStart {
 public:
  // Follows the motion in the present modes to a time, or to their end; returns false if the motion ends there.
  using Segment = std::function<bool(const Rational& to, Outcome& outcome)>;
  // The bodies and the report have to outlive this object. `end`: of the motion.
  SlipStart(TouchingBodies& bodies, JoinedReport& joined, Rational end, Segment segment)
      : bodies_(bodies), joined_(joined), end_(std::move(end)), segment_(std::move(segment)),
        told_(bodies.contacts.size(), false), held_(bodies.contacts.size()) {}

  // Notes that the event at the end of a segment reports a slip of the contact.
  void told(std::size_t contact) { told_[contact] = true; }
  // Holds contacts whose slip begins slowly. If a slip with two components begins without acceleration, its velocity
  // grows with the square of the time, and its direction is stiff as long as the velocity is small. The contact is held
  // for the time h of time_to_grow; the error is of the order of h^3 (theory: contact). Returns false if the motion
  // ends meanwhile.
  bool hold(Outcome& outcome);
  // Returns the consistent modes. If the last segment has ended only because contacts share their forces anew, the
  // bodies go on as before, even if they could do something else as well, and these are the present modes alone.
  std::vector<ContactSolution> modes(const ContactProblem& problem) const;
  // Among contacts that shared friction, reports those that slip together with the one at which the last segment ended.
  // A contact that still sticks, because it only touched its limit or the others hold it, has not slipped, and its
  // event is removed.
  void tell_who_slips_too(const ContactModes& now);
  // For how long contacts that share friction have been held before the present state.
  double held_for() const { return static_cast<double>(together_); }
  // Sets first guesses of directions: against the friction that held.
  void guess_directions(ContactProblem& problem) const;
  // Gives slips with two components their initial velocities. `list`: the contacts whose slip begins. A single one that
  // begins with an acceleration waits instead: its direction stays constant for a moment, which wait() follows.
  void begin(const std::vector<std::size_t>& list, const std::vector<long double>& accelerations);
  bool waits() const { return waits_.has_value(); }
  // Follows the motion for this moment, after which the slip has a velocity. Returns false if the motion ends
  // meanwhile.
  bool wait(Outcome& outcome);
  // True if the slip of this contact has begun with the last segment, so that its velocity is small.
  bool has_just_begun(std::size_t c) const { return begun_ == c; }

 private:
  // True if a contact shared friction and may begin to slip.
  bool was_held(std::size_t c) const;
  // The initial velocity of a slip with two components. After a time in held_ it has grown with the acceleration.
  long double first_slip(std::size_t c, const std::vector<long double>& accelerations) const;
  void begin_alone(std::size_t c, const std::vector<long double>& accelerations);
  // Keeps the direction of the slip constant for the moment after which the velocity is large compared with round-off,
  // unless something else changes now. Returns true if the slip waits.
  bool lets_wait(std::size_t c, const std::vector<long double>& accelerations);
  // Sets velocities, proportional to the accelerations, for slips that begin together on bodies that contacts join.
  void begin_together(const std::vector<std::size_t>& list, const std::vector<long double>& accelerations);
  // The time for which these accelerations may act until a slip that goes on has lost half of its velocity; infinite if
  // none becomes slower.
  long double time_to_reverse(const std::vector<long double>& accelerations) const;
  // If contacts share friction, one at its limit may leave the rest to the others. Then they share it anew, which is
  // not an event; otherwise they are held until the accelerations decide which begin to slip. Returns false if the
  // motion ends meanwhile.
  bool share_anew(Outcome& outcome);
  // Returns the solution of the present modes, if they are consistent.
  std::optional<ContactSolution> in_present_modes(const ContactProblem& problem) const;
  // Returns the solution in which each contact touches and sticks as it does now, or in which open ones touch besides.
  std::optional<ContactSolution> goes_on(const std::vector<ContactSolution>& list) const;
  // True if the bodies stay at rest, for the moment, without the contacts that leave at the end of the last segment, and
  // friction has not pressed contacts before.
  bool stand_without_what_leaves() const;
  // True if a contact has come to its limit and an open contact with a closed gap holds the bodies with it.
  bool closed_contact_may_hold();
  // True if another distribution of the forces holds the contacts at which the last segment ended. Their events are
  // removed then.
  bool finds_reserve();
  // Holds all contacts that stick; returns false if the motion ends meanwhile.
  bool hold_together(long double time, Outcome& outcome);
  // Like hold(), for several contacts: those with two components are held until their slip has a velocity.
  bool hold_to_grow(Outcome& outcome);
  // The time for which a contact is to be held until the slip velocity is kHeld of its terms, by the rate of its slip
  // acceleration.
  long double time_to_grow(std::size_t c, long double rate) const;
  // True if friction, which was too small to hold a contact, suffices again: a disc that rocks needs most where it
  // turns back.
  bool holds_again(std::size_t c);
  // True if the last segment ended with a slip of this contact that has two components and one coefficient of friction.
  bool begins_at_rest(std::size_t c) const;
  enum class Hold : std::uint8_t { to_its_end, something_else_happens, motion_ends };
  Hold hold_for(std::size_t c, long double time, Outcome& outcome);
  // The time after a moment, rounded like the times of events.
  Rational later(long double time) const;

  TouchingBodies& bodies_;
  JoinedReport& joined_;
  Rational end_;
  Segment segment_;
  std::vector<bool> told_;
  long double together_ = 0;  // for how long contacts that share friction were held last
  double held_until_ = 0;     // when that ended
  bool shared_anew_ = false;  // after the last segment
  // The holding of a contact that begins to slip.
  struct Held {
    long double time = 0;
    long double rate = 0;  // of the slip acceleration, which is zero at the start
  };
  std::vector<Held> held_;
  struct Waiting {
    std::size_t contact;
    long double time;
  };
  std::optional<Waiting> waits_;
  std::optional<std::size_t> begun_;  // the contact that has just waited
};

}  // namespace anholon
