// Linear models of a model in one form of its equations: about a state or at rest, at one value of the parameters or over
// a range of one of them.
#pragma once
#include <complex>

#include "linear/linearize.h"

namespace anholon {

struct LinearRequest {
  const Formulation* form = nullptr;
  bool equilibrium = false;  // about the state of rest near the given positions
  StateChoice choice;
  std::optional<ParameterRange> range;
  int digits = 16;  // digits of the results
};

// Reads a range as users write it (setup/words/value_range.h): "v=0..10:1", "v=0:10:11", or values "v=0,1,2". Throws
// MistakeInWord.
ParameterRange read_range(const std::string& word, const Model& model);
// Returns the index of a parameter. Throws Failure without a place.
std::size_t parameter_of(const Model& model, const std::string& name);

class LinearStudy {
 public:
  // Throws Failure if the model lacks something for numbers. REQUIRES: the form applies.
  LinearStudy(std::shared_ptr<const Model> model, LinearRequest request);
  // Returns the outcome of the preparation of the initial state, with the values of the file. The outcomes for values
  // of a range may differ.
  const Outcome& start() const { return start_; }
  const Scenario& scenario() const { return scenario_; }
  int working_digits() const;
  // Returns one result without a range; its outcome tells why the start failed, if it did. REQUIRES: the caller has set
  // the working precision of working_digits().
  Linearization compute() const;

 private:
  Outcome make(const Model& model, Scenario& scenario) const;

  LinearRequest request_;
  std::shared_ptr<const Model> model_;  // with the signals; at rest if an equilibrium is requested
  Signals signals_;
  std::vector<std::string> states_;  // states of the model
  Scenario scenario_;
  Outcome start_;
};

// Returns the eigenvalues of a range as curves: curves[i][k] belongs to the value k, and continues the curve i of the
// values before. Among the ways to continue all curves the nearest pairs are taken first. An entry is NaN if a value
// has no linear model, or fewer eigenvalues than others.
std::vector<std::vector<std::complex<double>>> curves(const Linearization& linearization);

}  // namespace anholon
