// Borders at which the surface of a contact continues with another formula: max, min, abs, sign and piecewise choose a
// branch there, and tables of steps have knots, so the gap or the slip velocity has a kink or a jump (theory: contact).
//
// On one side of a border the surface has one formula, which is defined beyond the border as well. A motion keeps this
// formula up to the border and changes it there, as at an event: contacts that touch then have an impact, or leave, and
// no force follows a jump.
#pragma once
#include <functional>

#include "contact/law/contact_dynamics.h"

namespace anholon {

// Returns the contacts with the branches of their gaps and slip velocities chosen by parameters, 1 or -1 for each
// border, which come after those of the model. The expressions belong to the graph of `s`.
std::vector<Contact> with_borders(Workspace& s, std::vector<Contact> contacts);

class SurfaceBorders {
 public:
  // `contacts`: the result of with_borders().
  SurfaceBorders(Workspace& s, const std::vector<Contact>& contacts);

  // Puts the state on the side of each border on which it is, or to which it goes.
  void begin(ContactState& at);
  // segment_has_ended(): the last segment has ended by no event of a border. reached(): it has ended by the event of
  // this border.
  void segment_has_ended() { here_.assign(count_, Here::unknown); }
  void reached(std::size_t border) { here_[border] = Here::reached; }
  // Puts the state on the other side of each border at which it is and which it passes; returns true if there is one. A
  // border that an event has reached is passed unless the velocities, after impacts, lead back.
  bool pass(ContactState& at);

  // Returns the borders at which the state is at rest: relative to the largest velocities of the coordinates, the state
  // moves across them by no more than round-off.
  std::vector<std::size_t> at_rest(const ContactState& at, const std::function<long double(std::size_t)>& most);

 private:
  // A border at a state: the value that passes zero, its rate, and the round-off of both.
  struct Place {
    long double value = 0, rate = 0, near = 0, slow = 0, by_time = 0;
    std::vector<long double> by_place;
  };
  std::vector<Place> places(const ContactState& at);

  std::size_t count_, coordinates_;
  std::vector<bool> of_velocity_;  // its rate needs accelerations
  enum class Here : std::uint8_t { unknown, reached, passed };
  std::vector<Here> here_;
  std::vector<long double> parameters_;
  Graph& graph_;
  Tape tape_;
  Machine<long double> machine_;
};

}  // namespace anholon
