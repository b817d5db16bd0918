// A formulation: one classical form of the equations of motion, as one file in forms/, in the room of its unknowns.
//
// A form maps Mechanics (and, if it eliminates the multipliers, an Elimination) to its equations, left side = right
// side, with masses frozen. Adding a file forms/UNKNOWNS/NAME.cpp adds the form; no other file is touched.
#pragma once
#include <string>
#include <vector>

#include "formulation/operators.h"
#include "formulation/quantities.h"

namespace anholon {

struct Equations {
  Column left, right;
};

// The unknowns of a form's equations; they decide how many equations there are.
enum class Unknowns : std::uint8_t {
  multipliers,       // n equations in q and lambda
  coordinates,       // n - s equations, dependent coordinates eliminated; or n without lambda
  quasi_velocities,  // n - s equations in quasi-velocities
  variational,       // n equations in q and multipliers of another mechanics
};

// The limit of the order m of a form: equations of order m contain T^(m), which grows with every derivative.
inline constexpr unsigned kHighestM = 12;

struct Formulation {
  const char* name;  // the name that --form accepts
  const char* title;
  const char* equation;  // number in its source; empty for the classics
  const char* source;
  Unknowns unknowns;
  // Returns an empty string if the form applies to the model, else the reason why it does not.
  std::string (*obstacle)(const Mechanics&);
  Equations (*equations)(const Mechanics&, const Elimination&);
  // Returns the quantities from which the equations are built, for `derive --steps`; null if nothing is listed.
  Quantities (*quantities)(const Mechanics&, const Elimination&) = nullptr;
  // The highest order m that can be requested; 0: the equations do not depend on an order.
  unsigned highest_m = 0;

  bool eliminates() const { return unknowns == Unknowns::coordinates || unknowns == Unknowns::quasi_velocities; }
};

// Names of the two papers on which the forms are based, cited as their source.
inline constexpr const char* kLuoZhao =
    "Luo & Zhao, Routh's Equations for General Nonholonomic Mechanical Systems of Variable Mass";
inline constexpr const char* kQiu = "Qiu, Extended Mac-Millan's Equation";
inline constexpr const char* kMicevicRusov =
    "a paper on equations of Mićević–Rusov type for nonholonomic systems of higher order";

// Obstacles that several forms share.
std::string no_obstacle(const Mechanics&);
// The obstacle of the forms of first order: a constraint of order 2 or more. Holonomic constraints are lifted to order
// 1.
std::string first_order_only(const Mechanics& M);

// Returns the reason why a form does not apply to a model: its own obstacle, or a constraint that is maintained by an
// input and so has no ideal reaction to eliminate. Empty if the form applies.
std::string obstacle(const Formulation& form, const Mechanics& M);

// Returns the reason why an applicable form is not available with this order m; empty if it is. Constraints and
// quasi-velocities of lower order are lifted to m. The equations of forms with multipliers hold for every m, those of
// the other forms from the highest order of the constraints on.
std::string order_obstacle(const Formulation& form, const Mechanics& M, unsigned m);

// Returns all forms, sorted by name; the build generates the list from the files in forms/.
const std::vector<const Formulation*>& formulations();
const Formulation* find_formulation(const std::string& name);
// Returns "(2.7) of Luo & Zhao, …".
std::string citation(const Formulation& form);

}  // namespace anholon
