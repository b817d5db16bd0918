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

// All forms, sorted by name; made by the build from the files in forms/.
const std::vector<const Formulation*>& formulations();
const Formulation* find_formulation(const std::string& name);

}  // namespace anholon
