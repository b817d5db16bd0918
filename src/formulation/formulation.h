// A formulation: one classical form of the equations of motion, as one file in forms/.
//
// A form maps Mechanics (and, where it has eliminated the multipliers, an Elimination) to its equations, left side =
// right side, with masses frozen. Adding a file forms/NAME.cpp adds the form; no other file is touched.
#pragma once
#include <string>
#include <vector>

#include "formulation/quantities.h"

namespace anholon {

struct Equations {
  Column left, right;
};

// What a form's equations stand in, and how many there are.
enum class Unknowns : std::uint8_t {
  multipliers,       // n equations in q and lambda
  coordinates,       // n - s equations, dependent coordinates eliminated; or n without lambda
  quasi_velocities,  // n - s equations in quasi-velocities
  variational,       // n equations in q and multipliers of another mechanics
};

// No order m of a form is higher: equations of order m hold T^(m), which grows with every derivative.
inline constexpr unsigned kHighestM = 12;

struct Formulation {
  const char* name;  // as --form accepts it
  const char* title;
  const char* equation;  // number in its source; empty for the classics
  const char* source;
  Unknowns unknowns;
  // Empty if the form applies to the model, else the reason why it does not.
  std::string (*obstacle)(const Mechanics&);
  Equations (*equations)(const Mechanics&, const Elimination&);
  // What they are made of, for who reads the way to them; none: nothing is listed.
  Quantities (*quantities)(const Mechanics&, const Elimination&) = nullptr;
  // The highest order m in which the equations can be asked for; 0: they do not depend on an order.
  unsigned highest_m = 0;

  bool eliminates() const { return unknowns == Unknowns::coordinates || unknowns == Unknowns::quasi_velocities; }
};

// Names of the seed papers, as every form gives its source.
inline constexpr const char* kLuoZhao =
    "Luo & Zhao, Routh's Equations for General Nonholonomic Mechanical Systems of Variable Mass";
inline constexpr const char* kQiu = "Qiu, Extended Mac-Millan's Equation";
inline constexpr const char* kMicevicRusov =
    "a paper on equations of Mićević–Rusov type for nonholonomic systems of higher order";

// What the forms have in common.
//
// The given and the inertial forces and the reactions sum lambda dphi/dq^(m)  [L 2.7], right side
Column right_side(const Mechanics& M);
// The highest order of the constraints, at least 1. A constraint of lower order may be lifted to it without a change of
// N.
unsigned highest_order(const Mechanics& M);
// The m of the forms of order m with multipliers: the one asked for, else the highest order of the constraints.
unsigned order_of(const Mechanics& M, const Elimination& E);
// T^(k) = D^k T/Dt^k
Expr T(const Mechanics& M, unsigned k);
// D/Dt dT/dq' - dT/dq, of Lagrange
Column lagrange_operator(const Mechanics& M);
// m D/Dt dT^(m-1)/dq^(m) - dT^(m-1)/dq^(m-1), of Nielsen  [L 3.10]
Column nielsen_operator(const Mechanics& M, unsigned m);
// dT^(m)/dq^(m) - dT^(m-1)/dq^(m-1) - dT/dq, of Micevic and Rusov  [N 3.1]
Column micevic_rusov_operator(const Mechanics& M, unsigned m);
// 1/m [dT^(m)/dq^(m) - (m+1) dT/dq]  [N 5.1], left side
Column mangeron_deleanu_operator(const Mechanics& M, unsigned m);

// Obstacles that several forms share.
std::string no_obstacle(const Mechanics&);
// For the forms of first order: holonomic constraints are lifted to it, higher ones cannot be.
std::string first_order_only(const Mechanics& M);

// Why a form does not apply to a model: its own reason, or that a constraint is kept by an input, which no elimination
// of ideal reactions knows. Empty if it applies.
std::string obstacle(const Formulation& form, const Mechanics& M);

// Why a form that applies does not do so with this order m. Empty if it does. Constraints and quasi-velocities of lower
// order are lifted to m; the equations of forms with multipliers hold for every m, those of the others from the highest
// order on.
std::string order_obstacle(const Formulation& form, const Mechanics& M, unsigned m);

// All forms, sorted by name; made by the build from the files in forms/.
const std::vector<const Formulation*>& formulations();
const Formulation* find_formulation(const std::string& name);
// "(2.7) of Luo & Zhao, …"
std::string citation(const Formulation& form);

}  // namespace anholon
