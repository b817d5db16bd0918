// The equations of the contacts at a state, for accelerations or for impulses, and their solution in given modes
// (theory: contact).
//
//   A x + b = Phi^T lambda + sum (n N + t^T T),   Phi x + beta = 0,
//   open:   N = 0, T = 0, n x + n0 >= 0
//   sticks: n x + n0 = 0, t x + t0 = 0, N >= 0, |T| <= mu_s N
//   slips:  n x + n0 = 0, T = -mu N d, N >= 0, where d is the direction of the slip velocity, or at rest that of t x + t0
//
// Resistance to rolling or drilling is a further T of a contact, bounded by the same N. It has rows of its own, in
// which t is the angular velocity and mu a length. It is open if its contact is, unless a given force presses it.
//
// x are the accelerations, or the jumps of the velocities. law/consistent_modes.h finds the modes that are consistent.
#pragma once
#include <array>
#include <cstdint>
#include <optional>
#include <vector>

namespace anholon {

enum class Touch : std::uint8_t { open, slips, sticks };

// If the gaps or the slip velocities of contacts depend on each other, some are held by unknown forces, and the others
// share these forces (law/shared_forces.h). This is the force of one gap, or of one component of friction.
struct ForceShare {
  bool shared = false;    // its rate follows from those that are held
  long double given = 0;  // a known part of the force
  // If shared: the remaining force is this part of each unknown force of its kind; empty: zero.
  std::vector<long double> of;
};

struct ContactMode {
  Touch touch = Touch::open;
  std::array<long double, 2> direction{};  // of the slip, of length 1
  // If a slip velocity v with two components is larger than this, its direction is v/|v|.
  std::optional<long double> fast;
  ForceShare load;                     // N of a contact that touches
  std::array<ForceShare, 2> shares{};  // T of a contact that sticks
  bool held = false;                   // sticks, whatever friction this needs
  // Its slip begins in `direction`, which stays constant for a moment. If the contact is held meanwhile, rows show that
  // it slips.
  bool begins = false;
  bool at_bound = false;  // of a held contact: its friction has reached its bound, and rows show no more
  bool rests = false;     // slips, but is not pressed and does not move: rows show that it sticks
  long double rest = 0;   // a slip velocity with two components below this is zero
  long double slack = 0;  // forces below this are round-off
  long double depth = 0;  // a gap is negative below minus this depth
  bool closed = false;    // an open contact whose gap begins at zero; its value is the round-off of its terms
  bool still = false;     // an open contact whose gap the others keep closed, at rest: its gap is no event
};
using ContactModes = std::vector<ContactMode>;

struct ContactRows {
  std::vector<long double> normal;                   // n
  std::vector<std::vector<long double>> tangential;  // t
  long double normal_rate = 0;                       // n0
  std::array<long double, 2> tangential_rate{};      // t0
  long double friction = 0, static_friction = 0;
  std::optional<std::size_t> under;  // of a resistance: the contact whose N bounds it, which has a smaller index
  long double pressed = 0;           // a normal force that bounds friction in addition to N
  long double before = 0;  // if a contact is left: the earlier accelerations, of which the gap's may be round-off
  bool rough = false;
  bool may_open = true, may_touch = true, may_stick = true;
  bool moves = false;                      // it slips already, in `direction`
  std::array<long double, 2> direction{};  // if it does not move: a first guess
};

struct ContactProblem {
  std::vector<std::vector<long double>> A, Phi;
  std::vector<long double> b, beta;
  std::vector<ContactRows> contacts;
  // The sums of the absolute values of the terms of which b is made, whose round-off is an error of b; empty for impulses.
  std::vector<long double> terms_of_b = {};
};

struct ContactSolution {
  ContactModes modes;
  std::vector<long double> x;
  std::vector<long double> normal;                   // N; of a resistance the force that presses it
  std::vector<std::array<long double, 2>> friction;  // T of contacts that stick
  // If friction is shared: the largest part of their bounds that all contacts can be spared, by the best of all
  // distributions, or by one that suffices. It is negative if no distribution lies within the bounds.
  std::optional<long double> spare;
};

// The components that are held by forces of their own, in the order of ForceShare::of.
struct HeldComponent {
  std::size_t contact = 0, component = 0;
};
std::vector<HeldComponent> held_components(const ContactProblem& problem, const ContactModes& modes);
// The contacts whose gaps are held, in the same order.
std::vector<std::size_t> held_gaps(const ContactProblem& problem, const ContactModes& modes);
// The size of the forces, positive: of the given ones, or, if there are none, as in an impact, of the loads.
long double size_of_forces(const ContactProblem& problem, const ContactSolution& solution);
// True if a contact that sticks shares friction.
bool shares_friction(const ContactModes& modes);

// Returns the accelerations and forces of given modes, whether or not they are consistent; nullopt if the equations are
// singular.
std::optional<ContactSolution> of_modes(const ContactProblem& problem, const ContactModes& modes);

}  // namespace anholon
