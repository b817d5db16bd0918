// Linear models at one value of the parameters or over a range of one of them, and the values of the range at which an
// eigenvalue crosses the imaginary axis.
//
// Between neighbouring values p_k, p_(k+1) at which the number u of eigenvalues with a positive real part differs, the
// m-th largest real part changes its sign for each m between the two u. As ordered real parts are continuous in p, its
// zero is bracketed. If the crossings that are found there do not add up to the change of u, the interval is halved.
// Two opposite crossings between neighbours are not detected: the values must be close enough together.
//
// If the motion itself jumps, the real parts jump with it, and no crossing is reported.
#pragma once
#include <functional>

#include "linear/linear_model.h"
#include "modelfile/names/declared_unit.h"

namespace anholon {

struct ParameterRange {
  std::size_t parameter = 0;
  std::vector<Rational> values;  // in this unit, as are all values of the parameter in the results
  DeclaredUnit unit = {};
};

struct LinearResult {
  std::string value;  // value of the parameter, as exact text; empty without a range
  Outcome outcome;
  LinearModel model;  // if the outcome is ok
};

struct Crossing {
  Multi value{0};             // value of the parameter
  Multi frequency{0};         // frequency of the eigenvalue there; 0: the eigenvalue is real
  int eigenvalues = 1;        // number that crosses: 2 for a pair
  bool destabilizes = false;  // true if the eigenvalue moves to the right for growing values of the parameter
  int unstable_above = 0;     // eigenvalues with a positive real part at a slightly larger value
  // False if the eigenvalues belong to states that are not steady, and do not decide stability.
  bool steady = true;
};
// Returns "stable above", or another meaning of the crossing for larger values of the parameter.
std::string meaning(const Crossing& crossing);

struct Linearization {
  std::vector<LinearResult> results;
  std::vector<Crossing> crossings;
  // The intervals between neighbouring values, and those of them in which crossings were searched for: a linear model is
  // known at both ends.
  std::size_t intervals = 0, searched = 0;
  std::vector<std::string> notes;  // about crossings that were not found, and jumps
};

// Makes the scenario of a value of the parameter, in the unit of the range.
using ScenarioAt = std::function<Outcome(const Rational& value, Scenario& scenario)>;

// Linearizes in the working precision that the caller has set (PrecisionScope). The signals are expressions of the
// model of the scenarios.
Linearization linearize(const Scenario& scenario, const StateChoice& choice, const Signals& signals = {});
// Linearizes over a range. Each value has a scenario of its own, because a mass that is 0 there changes the order of
// the equations. `each_anew`: each value has equations of its own, too, because the parameter occurs in exponents, where
// whole numbers may be substituted, or because initial values of states differ.
Linearization linearize(const ScenarioAt& scenario_at, const StateChoice& choice, const ParameterRange& range,
                        bool each_anew, const Signals& signals = {});
// Linearizes over a range; the scenarios are made of the model of `scenario`.
Linearization linearize(const Scenario& scenario, const StateChoice& choice, const ParameterRange& range,
                        const Signals& signals = {});

}  // namespace anholon
