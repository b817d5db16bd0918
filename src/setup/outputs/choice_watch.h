// Watches whether the choices in the equations of a leg become bad: the pivots by which its elimination divides, and
// the independence of the constraints that take part if others are left out.
#pragma once
#include "setup/outputs/output_tape.h"

namespace anholon {

template <Number W>
class ChoiceWatch {
 public:
  // `rows`: the constraints that take part, if they are a choice; empty if all take part.
  ChoiceWatch(Workspace& in, const Elimination& elimination, const std::vector<std::size_t>& rows,
              const std::vector<W>& parameters);

  std::size_t count() const { return of_elimination_ + (rows_.empty() ? 0 : 1); }
  // Returns sizes at a point: the size of each pivot, then the least sine of the angle between a row and the span of
  // the rows chosen before it.
  std::vector<double> at(const Expansion<W>& point);

 private:
  std::size_t of_elimination_;
  std::vector<std::size_t> rows_;
  std::vector<int> orders_;  // orders of the constraints of the rows
  OutputTape<W> outputs_;    // the pivots, then the rows of Phi
};

extern template class ChoiceWatch<long double>;
extern template class ChoiceWatch<Quad>;
extern template class ChoiceWatch<Multi>;

}  // namespace anholon
