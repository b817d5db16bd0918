// The parameters of the cases of an ensemble, and checks whether bodies and equations of the model are possible with
// them.
#pragma once
#include "ensemble/case.h"

namespace anholon {

// Builds no expressions after its construction, so many threads may read it.
class CaseParameters {
 public:
  CaseParameters(Workspace& scenario, const EnsembleOptions& options);

  // True if a parameter is varied; otherwise all cases have the same values.
  bool varies() const { return any_; }
  // The values of all parameters, those included that follow from others, for these values of the varied numbers.
  template <Number N>
  std::vector<N> values(const std::vector<Rational>& varied) const;
  // Fails if a body cannot have such a mass or inertia: a negative mass, or a principal moment of inertia greater than
  // the sum of the two others. (The reader refuses such numbers in a file.)
  Outcome possible(const std::vector<double>& parameters) const;
  // True if `oriented` may fail for some parameters or states.
  bool may_be_no_rotation() const { return may_be_no_rotation_; }
  // Fails if an orientation is no rotation at the start of a case.
  template <Number N>
  Outcome oriented(const std::vector<double>& parameters, const InitialState<N>& start) const;
  // True if the equations contain no derivative beyond those that are solved for (sigma_ij <= d_j - c_i), which they
  // may if a mass or a coefficient is zero in the file and not in the case; if, when a parameter vanishes, they still
  // determine each unknown; if no exponent that varies is a whole number, which would become a constant; and if the same
  // constraints hold as in the scenario.
  bool same_structure(const std::vector<double>& parameters) const;

 private:
  std::vector<bool> that_hold(const std::vector<double>& parameters) const;

  const Scenario& s_;
  const std::vector<Varied>& varied_;
  const std::vector<Identity>& identities_;
  bool any_ = false;  // true if a parameter is varied
  bool may_be_no_rotation_ = false;
  Tape tape_;
  std::optional<Tape> bodies_;
  std::optional<Tape> exponents_;    // the exponents that vary
  std::optional<Tape> switches_;     // the formulas that switch constraints
  std::vector<bool> hold_;           // the constraints with these formulas hold in the scenario
  std::optional<Tape> equations_;    // the equations whose structure depends on the parameters
  std::vector<double> of_scenario_;  // the parameters of the scenario
  bool vanishes_ = false;            // a constraint vanishes identically with these
  bool goes_beyond_ = false;         // some parameters may give the equations derivatives beyond
  struct Check {                     // one condition on the roots of `bodies_`
    std::string what;
    std::size_t root = 0;
    std::vector<Column> axes;  // of an inertia: the body's axes, whose weights are the roots; empty for a single number
  };
  std::vector<Check> checks_;
  System whole_;  // the equations with the derivatives that vanish for the numbers of the file
};

}  // namespace anholon
