// The parameters of the cases of an ensemble, and whether bodies and equations of the model are possible with them.
#pragma once
#include "ensemble/case.h"

namespace anholon {

// Builds no expressions after its construction, so many threads may read it.
class CaseParameters {
 public:
  CaseParameters(Workspace& scenario, const std::vector<Varied>& varied);

  // Whether a parameter is varied; else all cases have the same values.
  bool varies() const { return any_; }
  // The values of all parameters, those that follow from others included, for these values of the varied numbers.
  template <Number N>
  std::vector<N> values(const std::vector<Rational>& varied) const;
  // Returns an outcome that is not ok if no body has such a mass or inertia: a negative mass, a principal moment of
  // inertia greater than the sum of the two others. (The reader refuses such numbers in a file.)
  Outcome possible(const std::vector<double>& parameters) const;
  // Whether the equations hold no derivative beyond those that are solved for (sigma_ij <= d_j - c_i). They may hold
  // one if a mass or a coefficient is zero in the file and not in the case. If a parameter vanishes, whether they still
  // determine each unknown. No exponent that varies is a whole number, which is put in.
  bool same_structure(const std::vector<double>& parameters) const;

 private:
  const Scenario& s_;
  const std::vector<Varied>& varied_;
  bool any_ = false;  // whether a parameter is varied
  Tape tape_;
  std::optional<Tape> bodies_;
  std::optional<Tape> exponents_;    // that vary
  std::optional<Tape> equations_;    // of whose structure the parameters decide
  std::vector<double> of_scenario_;  // parameters
  bool goes_beyond_ = false;         // whether some parameters may give them derivatives beyond
  struct Check {                     // one condition on the roots of `bodies_`
    std::string what;
    std::size_t root = 0;
    std::vector<Column> axes;  // of an inertia: the body's axes, whose weights are the roots; empty for a single number
  };
  std::vector<Check> checks_;
  System whole_;  // the equations with the derivatives that vanish for the numbers of the file
};

}  // namespace anholon
