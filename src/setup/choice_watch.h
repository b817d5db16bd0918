// What tells that the choices on which the equations of a leg stand go bad: the pivots by which its elimination divides,
// and how independent the constraints are that take part where others are left out.
#pragma once
#include "setup/output_tape.h"

namespace anholon {

template <Number W>
class ChoiceWatch {
 public:
  // `rows`: the constraints that take part, where they are a choice; empty where all do.
  ChoiceWatch(Workspace& in, const Elimination& elimination, const std::vector<std::size_t>& rows,
              const std::vector<W>& parameters);

  std::size_t count() const { return of_elimination_ + (rows_.empty() ? 0 : 1); }
  // Their sizes at a point: of each that the elimination divides by, then the least sine of the angle between a row and the
  // span of those chosen before it.
  std::vector<double> at(const Expansion<W>& point);

 private:
  std::size_t of_elimination_;
  std::vector<std::size_t> rows_;
  std::vector<int> orders_;  // of the constraints of the rows
  OutputTape<W> outputs_;    // the pivots, then the rows of Phi
};

extern template class ChoiceWatch<long double>;
extern template class ChoiceWatch<Quad>;
extern template class ChoiceWatch<Multi>;

}  // namespace anholon
