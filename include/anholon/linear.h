// Linear models of a motion, z' = A z + B u, y = C z + D u, and its stability over a range of a parameter.
// (theory: linear-models)
#pragma once
#include <array>
#include <complex>

#include "anholon/system.h"

namespace anholon::v1 {

// Row after row.
struct Matrix {
  std::size_t rows = 0, columns = 0;
  std::vector<double> values;
  std::vector<std::string> texts;  // with more than 16 digits: the same numbers with all of them; else empty
  double operator()(std::size_t row, std::size_t column) const { return values[row * columns + column]; }
};

enum class Steadiness : std::uint8_t {
  equilibrium,
  steady,     // coordinates and states of [state] without influence move, everything else rests
  unsteady,   // A holds for an instant, and its eigenvalues say nothing of stability
  unchecked,  // perhaps steady: the check found no other point of the motion
};

struct LinearModel {
  Steadiness motion = Steadiness::unchecked;
  std::string why;  // unsteady, unchecked: what tells so, and coordinates without which the motion is steady
  double t = 0;
  std::vector<std::string> states;     // independent coordinates and velocities z
  std::vector<std::string> dependent;  // coordinates and velocities that follow from z
  std::vector<std::string> cyclic;     // of z: those that influence nothing
  std::vector<std::string> core;       // the others
  std::vector<std::string> inputs, outputs;
  std::vector<double> values;            // of z at the point
  std::vector<std::string> value_texts;  // with more than 16 digits: the same
  std::vector<std::string> notes;        // inputs and outputs that do not occur in the model
  // z' = A z + B u, y = C z + D u, in SI units; an output that has a unit in the file is in that unit, as in a run.
  Matrix A, B, C, D;
  // Of A over the core. A k-fold eigenvalue stands k times, each time with its multiplicity.
  std::vector<std::complex<double>> eigenvalues;
  std::vector<std::array<std::string, 2>> eigenvalue_texts;  // with more than 16 digits: real and imaginary parts
  std::vector<int> multiplicities;
  // modes[i]: the eigenvector of eigenvalue i over the core, whose largest entry is 1.
  std::vector<std::vector<std::complex<double>>> modes;
};

struct LinearOptions {
  std::string form = "routh";
  std::map<std::string, Number> initial = {};  // the state; of an equilibrium: positions where the search begins
  std::vector<std::string> eliminate = {};
  bool equilibrium = false;  // about the state of rest near the initial positions
  int digits = 16;
};

// Errors: a singular configuration, no equilibrium, eigenvalues that could not be enclosed (an outcome).
ANHOLON_API Result<LinearModel> linearize(const Model& model, const LinearOptions& options = {});
// About the initial state of the system.
ANHOLON_API Result<LinearModel> linearize(const System& system);

// A value of the parameter at which an eigenvalue crosses the imaginary axis.
struct Crossing {
  double value = 0;                        // of the parameter, in the unit of Stability::values
  double frequency = 0;                    // of the eigenvalue there, rad/s; 0: it is real
  int eigenvalues = 1;                     // how many cross: 2 for a pair
  bool destabilizes = false;               // for growing values the eigenvalue moves to the right
  std::string value_text, frequency_text;  // with as many digits as asked for
  // For larger values of the parameter: "stable above", "unstable above"; "to the left above" or "to the right above" of
  // eigenvalues that do not decide, as other ones are unstable, or the states are not steady.
  std::string meaning;
};

struct Stability {
  std::string parameter;
  // Of the parameter, in the unit that the model declares for it, else in SI units.
  std::vector<double> values;
  std::vector<LinearModel> models;  // by value; empty where `outcomes` tells why there is none
  std::vector<Outcome> outcomes;
  // curves[i][k] is the eigenvalue at the value k that continues the curve i; NaN where there is none.
  std::vector<std::vector<std::complex<double>>> curves;
  std::vector<Crossing> crossings;  // between neighbouring values, located to round-off
  std::vector<std::string> notes;   // crossings that were not found, and jumps from one motion to another
};

// The linear models over values of a parameter, for each of which the initial data are solved anew. A bare number is in
// the unit that the model declares for the parameter, else in SI units. Two opposite crossings between neighbouring
// values are not detected. A value at which there is no motion has an outcome of its own.
// Errors: an unknown parameter (a diagnostic).
ANHOLON_API Result<Stability> stability(const Model& model, const std::string& parameter,
                                        const std::vector<Number>& values, const LinearOptions& options = {});

}  // namespace anholon::v1
