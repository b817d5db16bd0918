// The equations of the contacts at a state, as numbers: accelerations and impulses, gaps and slip velocities.
#pragma once
#include "contact/law/mode_equations.h"
#include "modelfile/contacts.h"
#include "setup/scenario.h"

namespace anholon {

// The state in which a mode begins.
struct ContactState {
  Rational t;
  std::vector<double> q, qd, states;
  // The side of each border of surfaces, 1 or -1, then how near to each is at it (contact/surface/borders.h).
  std::vector<double> borders = {};
};

// Some values for what a state knows of the borders of these contacts.
std::vector<double> sides(const std::vector<Contact>& contacts);
// The parameters of a model, and after them what a state knows of borders.
std::vector<long double> with_sides(std::vector<long double> parameters, const std::vector<double>& borders);
// Evaluates a tape at the time, coordinates, velocities and states of a state; higher derivatives are 0.
void evaluate_at(const ContactState& at, const Graph& graph, Machine<long double>& machine);

class ContactDynamics {
 public:
  // `s`: the model with all contacts open. Constraints of order above 1, and those kept by inputs, are refused (Failure).
  ContactDynamics(Workspace& s, const std::vector<Contact>& contacts);

  struct Place {
    long double gap = 0, gap_rate = 0;
    std::array<long double, 2> slip{};
    long double slip_scale = 0;  // the size of the terms of the slip velocity at the states up to now
    long double slip_reach = 0;  // of those of the velocities that the coordinates might have
    long double restitution = 0;
  };
  // Evaluates all formulas at a state.
  void go(const ContactState& at);
  // Notes the mean velocities of a segment between two states: a motion from rest to rest is fast between them.
  void pass(const ContactState& from, const ContactState& to);
  // Notes for each coordinate the velocity of a fall without contacts through its own size, as one that it might have: what is
  // round-off of it is no velocity. Returns whether that is new.
  bool note_fall(const ContactState& at);
  const Place& place(std::size_t contact) const { return places_[contact]; }
  long double speed() const { return speed_; }                                  // the largest velocity of a coordinate
  long double most(std::size_t coordinate) const { return most_[coordinate]; }  // its largest velocity up to now
  // The accelerations; `moves` and `direction` of the contacts are those of their slip velocities.
  const ContactProblem& accelerations() const { return problem_; }
  // The size of the rate of a slip velocity with these accelerations.
  long double slip_acceleration(std::size_t contact, const std::vector<long double>& accelerations) const;
  // Whether the accelerations are undetermined if this contact alone sticks, though there are degrees of freedom for its
  // gap and its slip: the coordinates are singular.
  bool loses_rank(std::size_t contact) const;
  // Whether masses, forces and constraints have values at the state, as log(x) has none at x = 0.
  bool has_values() const;
  // Whether the gap of the contact has derivatives at the state, as that of a disc that lies flat has none, and whether its slip
  // velocities have values and derivatives.
  bool has_derivatives(std::size_t contact) const;
  bool has_slip(std::size_t contact) const;
  // The jumps of the velocities at an impact by Newton's law in Moreau's form, with the restitutions of the contacts or
  // with this one.
  ContactProblem impact(const std::vector<bool>& touches, std::optional<long double> restitution = std::nullopt) const;
  // The jump of least change that stops what touches or sticks, without friction. The constraints hold after it: round-off
  // of the velocities before may be larger than the velocities that are left.
  ContactProblem stop() const;
  // The velocities nearest to `qd` in the mass norm with which the constraints hold at the state; those of the state are where
  // constraints that are not linear in them are looked at. Returns nullopt if the constraints depend on each other.
  std::optional<std::vector<double>> nearest(const std::vector<double>& qd, const ContactState& at) const;

 private:
  std::size_t n_;
  std::vector<std::size_t> independent_;
  std::vector<Contact> contacts_;
  Graph& graph_;
  Tape tape_;
  std::vector<long double> parameters_;
  std::vector<double> borders_;  // those for which the machine has its parameters
  Machine<long double> machine_;
  ContactProblem problem_;
  std::vector<long double> constraint_rates_;
  std::vector<Place> places_;
  long double speed_ = 0;
  std::vector<long double> most_, met_;  // up to now: with the means of segments, and at states alone
};

}  // namespace anholon
