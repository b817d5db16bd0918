// Multipliers where constraints are redundant: the least ones with the same forces (theory: dae-view).
#pragma once
#include "setup/scenario.h"

namespace anholon {

template <Number N>
class LeastMultipliers {
 public:
  LeastMultipliers(Workspace& s, const std::vector<N>& parameters);
  // Of all constraints of the model at a point.
  std::vector<N> at(const Expansion<N>& point);
  void set_parameters(const std::vector<N>& parameters) { phi_.set_parameters(parameters); }

 private:
  std::size_t coordinates_, constraints_;
  OutputTape<N> phi_;  // the rows of all constraints
};

extern template class LeastMultipliers<double>;
extern template class LeastMultipliers<long double>;
extern template class LeastMultipliers<Quad>;
extern template class LeastMultipliers<Multi>;

}  // namespace anholon
