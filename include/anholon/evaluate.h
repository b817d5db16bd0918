// Everything about one state: forces, accelerations, multipliers, reactions, energies, residuals.
#pragma once
#include "anholon/system.h"

namespace anholon::v1 {

// A number under its name, SI, with all its digits.
struct NamedText {
  std::string name, text;
};

struct StateReport {
  std::string form;
  std::string t;
  std::vector<NamedText> q, qdot;  // by the names of coordinates
  struct Force {
    std::string name;                 // "Q", "QR", … (NOTATION.md)
    std::vector<std::string> values;  // by coordinate
  };
  std::vector<Force> forces;                          // generalized
  std::vector<NamedText> derivatives;                 // "x''", and higher ones that the equations determine
  std::vector<NamedText> multipliers;                 // "lambda.NAME"
  std::vector<NamedText> numbers;                     // energies and terms of the power identity: "T_r", "S_r", …
  std::vector<std::vector<std::string>> mass_matrix;  // d^2 T / dq' dq'
  struct Reaction {
    std::string body;
    std::vector<std::string> force, torque;  // torque about the mass centre; along the observer's axes
  };
  std::vector<Reaction> reactions;
  std::vector<NamedText> residuals;  // relative, three digits
};

// digits: of the numbers; up to 16 they are computed in long double, beyond in multiple precision.
// Errors: a singular configuration, a formula without a value (an outcome).
ANHOLON_API Result<StateReport> evaluate(const System& system, int digits = 16);

}  // namespace anholon::v1
