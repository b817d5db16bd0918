// The outcome of a numerical task. It is returned, never thrown: partial results are kept and sweeps continue. Its text
// contains the remedy.
#pragma once
#include <cstdint>
#include <optional>
#include <string>

#include "base/diagnostic.h"

namespace anholon {

enum class OutcomeKind : std::uint8_t {
  finished,
  singular,        // the system Jacobian lost rank: a singular configuration
  step_collapse,   // the step size fell below the resolution of the time
  blow_up,         // a state grew without bound
  negative_mass,   // a given mass fell below zero
  not_a_number,    // a formula left its domain (root or logarithm of a negative number, 0/0)
  no_convergence,  // Newton's iteration for the leading derivatives failed
  inconsistent,    // no initial data satisfy the constraints with the values given
  interrupted,     // Ctrl-C, or the step limit of the caller
  too_large,       // the work or the memory needed is out of proportion
};

struct Outcome {
  OutcomeKind kind = OutcomeKind::finished;
  std::string message;           // what happened, where
  std::string hint;              // what to do
  Span place = {};               // the element of the model that caused the outcome; line 0 if there is none
  std::optional<double> t = {};  // the time that the message tells
  bool ok() const { return kind == OutcomeKind::finished; }
};

const char* name(OutcomeKind kind);

}  // namespace anholon
