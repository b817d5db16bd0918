// Borders at which the surface of a contact goes on by another formula: max, min, abs, sign and piecewise choose a branch
// there, and tables of steps have knots, so the gap or the slip velocity has a kink or a jump (theory: contact).
//
// On one side of a border the surface has one formula, which holds beyond the border as well. A motion keeps this formula up to the
// border and changes it there, as at an event: what touches then has an impact, or leaves, and no force follows a jump.
#pragma once
#include <functional>

#include "contact/law/contact_dynamics.h"

namespace anholon {

// The contacts with the branches of their gaps and slip velocities chosen by parameters, 1 or -1 of each border, which stand
// after those of the model. The expressions belong to the graph of `s`.
std::vector<Contact> with_borders(Workspace& s, std::vector<Contact> contacts);

class SurfaceBorders {
 public:
  // contacts: those of with_borders().
  SurfaceBorders(Workspace& s, const std::vector<Contact>& contacts);

  // Puts the state on the side of each border on which it is, or to which it goes.
  void begin(ContactState& at);
  // The last segment has ended, by no event of a border; or by that of this one.
  void segment_has_ended() { here_.assign(count_, Here::unknown); }
  void reached(std::size_t border) { here_[border] = Here::reached; }
  // Puts the state on the other side of each border at which it is and which it passes; returns whether there is one. A border that an
  // event has reached is passed unless the velocities, after impacts, lead back.
  bool pass(ContactState& at);

  // The borders at which the state is, and along which it moves at most as slowly as is round-off of these velocities of the
  // coordinates.
  std::vector<std::size_t> at_rest(const ContactState& at, const std::function<long double(std::size_t)>& most);

 private:
  // A border at a state: the value that passes zero, its rate, and what is round-off of both.
  struct Place {
    long double value = 0, rate = 0, near = 0, slow = 0, by_time = 0;
    std::vector<long double> by_place;
  };
  std::vector<Place> places(const ContactState& at);

  std::size_t count_, coordinates_;
  std::vector<bool> of_velocity_;  // a rate needs accelerations
  enum class Here : std::uint8_t { unknown, reached, passed };
  std::vector<Here> here_;
  std::vector<long double> parameters_;
  Graph& graph_;
  Tape tape_;
  Machine<long double> machine_;
};

}  // namespace anholon
