// What is zero within round-off at a state of a motion with contacts: gaps, their velocities, and motions that end within
// round-off of the place (theory: contact).
#pragma once
#include "contact/law/contact_dynamics.h"

namespace anholon {

class RoundOff {
 public:
  // Refers to all three, which outlive it; `dynamics` has been evaluated at the state.
  RoundOff(const std::vector<Contact>& contacts, const ContactDynamics& dynamics, const ContactState& at)
      : contacts_(contacts), dynamics_(dynamics), at_(at), reached_(contacts.size(), false) {}

  // A segment of this length has ended at the state, by no event that closes a gap.
  void segment_has_ended(long double length);
  // The event at which it has ended closes this gap.
  void reached(std::size_t contact) { reached_[contact] = true; }

  // A place is known to this part of the size of its terms.
  static constexpr long double kPlace = 1e-14L;

  // A gap that an event closes is none, and neither is one of the size of round-off: the state is rounded to doubles.
  bool closed(std::size_t contact) const;
  // Whether a negative gap is the error with which an event is located.
  bool negligible(std::size_t contact) const;
  // Whether a gap of either sign is such an error.
  bool missed(std::size_t contact) const;
  // The same of a gap with which the motion starts: the terms of the gap tell the size of the model, and no event has been located.
  bool negligible_at_start(std::size_t contact) const;
  // Whether the value of a closed gap is round-off of its terms: one whose terms are smaller is known, and is the way in the
  // round-off of the time at which an event has closed it.
  bool gap_is_round_off(std::size_t contact) const;
  // By how much more than by round-off accelerations may differ from those at which an event is, as it comes at a time that
  // is rounded: at least 1.
  long double late() const;
  // The size of the terms of a gap.
  long double place_size(std::size_t contact) const;
  // The velocity of the gap, 0 within round-off of the velocities that the motion had.
  long double gap_rate(std::size_t contact) const;
  // Whether a gap that is pressed together would rise, with its velocity, by round-off of its place only; and whether
  // friction ends a slip within this distance.
  bool hardly_rises(std::size_t contact) const;
  bool hardly_slips(std::size_t contact) const;

 private:
  // How well a gap is known: to round-off of its terms, of the way that its coordinates have come in the last segment, and
  // of the way in the time that a round-off of t is.
  long double uncertainty(std::size_t contact) const;
  long double largest_term(std::size_t contact) const;  // of the gap at the place
  long double pressed(std::size_t contact) const;
  long double pressed_by_others(std::size_t contact) const;
  bool hardly_moves(std::size_t contact, long double v, long double a) const;

  const std::vector<Contact>& contacts_;
  const ContactDynamics& dynamics_;
  const ContactState& at_;
  std::vector<bool> reached_;
  long double length_ = 0;  // of the last segment
};

}  // namespace anholon
