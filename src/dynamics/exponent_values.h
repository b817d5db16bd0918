// Exponents that are formulas of parameters, for the parameters of a call.
//
// A power with such an exponent has a value for every base if the exponent is a whole number, and for positive ones
// otherwise (model/exponents.h). A function of states has one system for each set of whole exponents, and one for all
// other values.
#pragma once
#include <map>

#include "model/model.h"
#include "tape/tape.h"

namespace anholon {

class ExponentValues {
 public:
  using Values = std::map<std::size_t, double>;  // of parameters, by their indices

  ExponentValues() = default;  // of a model without such exponents
  explicit ExponentValues(const Model& model);

  bool any() const { return !follows_from_.empty(); }
  // Returns the values of the parameters from which the whole exponents follow. `parameters`: all of the model.
  Values whole(const std::vector<double>& parameters) const;
  // Returns the parameters from which exponents follow, without those that have values.
  std::vector<std::size_t> others(const Values& values) const;

 private:
  Tape tape_;                                           // the exponents
  std::vector<std::vector<std::size_t>> follows_from_;  // by exponent: parameters that follow from no others
};

// Returns a copy of the model in which parameters have these values.
std::shared_ptr<const Model> with_values(const Model& model, const ExponentValues::Values& values);

}  // namespace anholon
