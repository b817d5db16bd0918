// Decides what is zero up to round-off at a state of a motion with contacts: gaps, their velocities, and motions that
// end within the round-off of the place (theory: contact).
#pragma once
#include "contact/law/contact_dynamics.h"

namespace anholon {

class RoundOff {
 public:
  // All three objects have to outlive this one; `dynamics` has been evaluated at the state.
  RoundOff(const std::vector<Contact>& contacts, const ContactDynamics& dynamics, const ContactState& at)
      : contacts_(contacts), dynamics_(dynamics), at_(at), reached_(contacts.size(), false) {}

  // Notes that a segment of this length has ended at the state, by no event that closes a gap.
  void segment_has_ended(long double length);
  // Notes that the event at its end closes this gap.
  void reached(std::size_t contact) { reached_[contact] = true; }
  bool has_reached(std::size_t contact) const { return reached_[contact]; }

  // A place is known to this part of the size of its terms.
  static constexpr long double kPlace = 1e-14L;

  // True if an event has closed the gap, or if the gap is at most round-off, because the state is rounded to doubles.
  bool closed(std::size_t contact) const;
  // True if a negative gap is within the error with which an event is located.
  bool negligible(std::size_t contact) const;
  // True if a gap of either sign is within this error.
  bool missed(std::size_t contact) const;
  // The same for a gap at the start of the motion: the terms of the gap give the size of the model, and no event has
  // been located.
  bool negligible_at_start(std::size_t contact) const;
  // True if the value of a closed gap is the round-off of its terms. If its terms are smaller, the value is the way
  // within the round-off of the time at which an event has closed the gap.
  bool gap_is_round_off(std::size_t contact) const;
  // The factor, at least 1, by which accelerations may differ by more than round-off from those at an event, because
  // the time of the event is rounded.
  long double late() const;
  // The depth below which a gap that begins at zero hits: more than what the watch of events takes for the round-off of the
  // terms of the gap.
  long double depth(std::size_t contact) const;
  // The size of the terms of a gap.
  long double place_size(std::size_t contact) const;
  // The velocity of the gap; 0 within the round-off of the earlier velocities.
  long double gap_rate(std::size_t contact) const;
  // hardly_rises(): true if a gap that is pressed together would rise, with its velocity, by no more than the round-off
  // of its place. hardly_slips(): true if friction ends a slip within this distance.
  bool hardly_rises(std::size_t contact) const;
  bool hardly_slips(std::size_t contact) const;

 private:
  // The uncertainty of a gap: the round-off of its terms, of the way of its coordinates in the last segment, and of its
  // way within a round-off of t.
  long double uncertainty(std::size_t contact) const;
  // The terms of the gap at the place: those of the coordinates along its gradient, and the rest.
  struct Terms {
    long double largest = 0, sum = 0;  // of the absolute values
  };
  Terms terms(std::size_t contact) const;
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
