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
  // The side of each border of surfaces, 1 or -1; then, for each border, the distance within which the state is at it
  // (contact/surface/borders.h).
  std::vector<double> borders = {};
};

// Returns initial values of ContactState::borders for these contacts.
std::vector<double> sides(const std::vector<Contact>& contacts);
// Returns the parameters of a model, followed by the values of ContactState::borders.
std::vector<long double> with_sides(std::vector<long double> parameters, const std::vector<double>& borders);
// Evaluates a tape at the time, coordinates, velocities and states of a state; higher derivatives are 0.
void evaluate_at(const ContactState& at, const Graph& graph, Machine<long double>& machine);

class ContactDynamics {
 public:
  // `s`: the model with all contacts open. Throws Failure for constraints of order above 1, and for those kept by
  // inputs.
  ContactDynamics(Workspace& s, const std::vector<Contact>& contacts);

  struct Place {
    long double gap = 0, gap_rate = 0;
    std::array<long double, 2> slip{};
    long double slip_scale = 0;  // the size of the terms of the slip velocity at the states so far
    long double slip_reach = 0;  // the size of these terms with the velocities that the coordinates might have
    long double restitution = 0;
  };
  // Evaluates all formulas at a state.
  void go(const ContactState& at);
  // Notes the mean velocities of a segment between two states: a motion from rest to rest is fast between them.
  void pass(const ContactState& from, const ContactState& to);
  // Notes, for each coordinate, the velocity of a fall without contacts through the coordinate's own size as one that
  // it might have; the round-off of such a velocity counts as zero. Returns true if that is new.
  bool note_fall(const ContactState& at);
  const Place& place(std::size_t contact) const { return places_[contact]; }
  long double speed() const { return speed_; }                                  // the largest velocity of a coordinate
  long double most(std::size_t coordinate) const { return most_[coordinate]; }  // its largest velocity so far
  // The equations of the accelerations; `moves` and `direction` of the contacts come from their slip velocities.
  const ContactProblem& accelerations() const { return problem_; }
  // The size of the rate of a slip velocity with these accelerations.
  long double slip_acceleration(std::size_t contact, const std::vector<long double>& accelerations) const;
  // True if the accelerations are undetermined when this contact alone sticks, although there are degrees of freedom
  // for its gap and its slip: then the coordinates are singular.
  bool loses_rank(std::size_t contact) const;
  // The name of a constraint that is not linear in the velocities, so that no law tells its impulse; empty if there is none.
  const std::string& nonlinear_constraint() const { return nonlinear_; }
  // True if masses, forces and constraints have values at the state; log(x) has none at x = 0.
  bool has_values() const;
  // has_derivatives(): true if the gap of the contact has derivatives at the state; that of a disc that lies flat has
  // none. has_slip(): true if its slip velocities have values and derivatives.
  bool has_derivatives(std::size_t contact) const;
  bool has_slip(std::size_t contact) const;
  // The equations of the jumps of the velocities at an impact by Newton's law in Moreau's form, with the restitutions
  // of the contacts or with the given one.
  ContactProblem impact(const std::vector<bool>& touches, std::optional<long double> restitution = std::nullopt) const;
  // The equations of the jump of least change that stops what touches or sticks, without friction. The constraints hold
  // after it: the round-off of the earlier velocities may be larger than the remaining ones.
  ContactProblem stop() const;
  // True if the velocities satisfy the constraints up to the round-off of their terms with velocities.
  bool velocities_hold() const;
  // Returns the velocities nearest to `qd` in the mass norm with which the constraints hold at the state; constraints
  // that are not linear in the velocities are linearized at those of the state. Returns nullopt if the constraints
  // depend on each other.
  std::optional<std::vector<double>> nearest(const std::vector<double>& qd, const ContactState& at) const;

 private:
  std::size_t n_;
  std::vector<std::size_t> independent_;
  std::string nonlinear_;
  std::vector<Contact> contacts_;
  Graph& graph_;
  Tape tape_;
  std::vector<long double> parameters_;
  std::vector<double> borders_;  // the borders of the machine's parameters
  Machine<long double> machine_;
  ContactProblem problem_;
  std::vector<long double> constraint_rates_, velocities_;
  std::vector<Place> places_;
  long double speed_ = 0;
  std::vector<long double> most_, met_;  // largest velocities so far: with the means of segments, and at states alone
};

}  // namespace anholon
