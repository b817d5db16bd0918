// A formulation: one classical form of the equations of motion, as one file in forms/.
//
// A form maps Mechanics to its equations, left side = right side, with masses frozen. Adding a file
// forms/NAME.cpp adds the form; no other file is touched.
#pragma once
#include <string>
#include <vector>

#include "mechanics/mechanics.h"

namespace anholon {

struct Equations {
  Column left, right;
};

struct Formulation {
  const char* name;      // as --form accepts it
  const char* title;
  const char* equation;  // number in its source
  const char* source;
  // Empty if the form applies to the model, else the reason why it does not.
  std::string (*obstacle)(const Mechanics&);
  Equations (*equations)(const Mechanics&);
};

// What the multiplier forms have in common.
//
// Q + QR + Qomega - d(V_O + V_omega)/dq + Gamma + sum lambda dphi/dq^(m)  [L 2.7], right side
Column right_side(const Mechanics& m);
// The highest order of the constraints, at least 1: the m of the forms of order m. A constraint of
// lower order may be lifted to it without a change of N.
unsigned highest_order(const Mechanics& m);
// 1/m [dT^(m)/dq^(m) - (m+1) dT/dq]  [N 5.1], left side
Column mangeron_deleanu_operator(const Mechanics& M, unsigned m);

// All forms, sorted by name; made by the build from the files in forms/.
const std::vector<const Formulation*>& formulations();
const Formulation* find_formulation(const std::string& name);

}  // namespace anholon
