// Pieces of text that generated programs in C and Python share.
#pragma once
#include <string>
#include <vector>

#include "emit/motion.h"

namespace anholon::emit {

// Returns a rational number as a number of both languages: 2.5, 2.0/3.0, 1e-9.
std::string number(const Rational& r);

// Returns the value of a step function at x as an expression of C.
std::string c_lookup(const StepFunction& f, const std::string& x);

// Returns the same as an expression of Python.
std::string python_lookup(const StepFunction& f, const std::string& x);

// Values and the places to which they are assigned.
struct Assignments {
  Column values;
  std::vector<std::string> targets;  // p[0], p[1], …
};

// The given parameters, and those that follow from them.
struct ParameterAssignments {
  Assignments free, derived;
};
ParameterAssignments parameter_assignments(const Motion& motion);

// Returns the Jacobian row by row.
Column entries(const std::vector<Column>& jacobian);

// Returns the time derivative of entry i of the state: lead[j] or state[k].
std::string rate_of_state(const Structure& structure, const Motion& motion, std::size_t i);

// Returns the functions $_factor and $_solve of linear equations in C, of $_UNKNOWNS; `$` marks the prefix of names.
const char* c_solver();

// Returns the text with all of `from` replaced.
std::string replaced(std::string text, const std::string& from, const std::string& to);

// Returns the text with its first `mark` replaced.
std::string put(std::string text, const std::string& mark, const std::string& by);

// Returns the lines of a comment that describe the arrays.
std::vector<std::string> head(const System& system, const Structure& structure, const Motion& motion,
                              const EmitOptions& options);

std::string lines(const std::vector<std::string>& list, const std::string& indent);

}  // namespace anholon::emit
