// The parameters of the cases of an ensemble, and whether the model goes on to be what it was with them.
#pragma once
#include "ensemble/case.h"

namespace anholon {

// Read by many threads: it builds no expressions.
class CaseParameters {
 public:
  CaseParameters(Workspace& scenario, const std::vector<Varied>& varied);

  // Of all parameters, those that are derived from others too.
  template <Number N>
  std::vector<N> values(const std::vector<Rational>& varied) const;
  // Not ok if no such body can be: a negative mass, a moment of inertia greater than the two others. (The reader asks
  // the same of the file's numbers.)
  Outcome possible(const std::vector<double>& parameters) const;
  // No derivative occurs in the equations beyond those that are solved for (sigma_ij <= d_j - c_i): where a mass or a
  // coefficient of the file is zero, others may.
  bool same_structure(const std::vector<double>& parameters) const;

 private:
  const Scenario& s_;
  const std::vector<Varied>& varied_;
  bool any_ = false;  // parameter is varied
  Tape tape_;
  std::optional<Tape> bodies_, equations_;
  struct Check {  // of roots of `bodies_`
    std::string what;
    std::size_t root = 0;
    std::vector<Column> axes;  // of an inertia: along the body's axes, their weights are the roots
  };
  std::vector<Check> checks_;
  System whole_;  // before what does not occur was dropped
};

}  // namespace anholon
