// Linear models at one value of the parameters or over a range of one of them, and the values of the range at which an
// eigenvalue crosses the imaginary axis.
//
// Between neighbouring values p_k, p_(k+1) at which the number u of eigenvalues with a positive real part differs, the
// m-th largest real part changes its sign for each m between the two u. As ordered real parts are continuous in p, its
// zero is bracketed. Two opposite crossings between neighbours are not detected: the values must be close enough
// together.
#pragma once
#include "linear/linear_model.h"

namespace anholon {

struct ParameterRange {
  std::size_t parameter = 0;
  std::vector<Rational> values;
};

struct LinearResult {
  std::string value;  // of the parameter, as exact text; empty without a range
  Outcome outcome;
  LinearModel model;  // if the outcome is ok
};

struct Crossing {
  Multi value{0};             // of the parameter
  Multi frequency{0};         // of the eigenvalue there; 0: the eigenvalue is real
  int eigenvalues = 1;        // number that crosses: 2 for a pair
  bool destabilizes = false;  // for growing values of the parameter the eigenvalue moves to the right
};

struct Linearization {
  std::vector<LinearResult> results;
  std::vector<Crossing> crossings;
  std::vector<std::string> notes;  // crossings that were not found
};

// In a working precision that the caller has set (PrecisionScope). The signals are expressions of the model that the
// scenario was made of, or of the scenario.
Linearization linearize(const Scenario& scenario, const StateChoice& choice, const std::optional<ParameterRange>& range,
                        const Signals& signals = {});

}  // namespace anholon
