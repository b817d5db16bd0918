// How the slots of a program depend on the leading derivatives: their derivatives at the point, and the effect of new
// coefficients of the unknowns on them.
#pragma once
#include <vector>

#include "program/program.h"

namespace anholon {

// Returns to! / from!. A quotient of factorials would be rounded in the same way at every step, and the errors of a
// motion would add up; this product is exact.
template <Number N>
N rising(std::size_t from, std::size_t to) {
  N product(1);
  for (std::size_t k = from + 1; k <= to; ++k) product *= N(static_cast<int>(k));
  return product;
}

template <Number N>
class Sensitivity {
 public:
  explicit Sensitivity(const Program& program);

  // Takes the partial derivatives of the slots at the values of the machine; `add` uses them.
  void take(const Machine<N>& machine);
  // Returns the partial derivatives of the slot `tainted[k]`.
  const typename Machine<N>::Partials& partials(std::size_t k) const { return partials_[k]; }
  // Computes the system Jacobian from the partial derivatives that were taken.
  void jacobian(const Machine<N>& machine, Matrix<N>& j);
  // Adds to all slots, at this stage, the effect of a change of the unknowns. The change and the new value of each input
  // are given by functions of the unknown and the order of its coefficient.
  template <class Change, class Value>
  void add(int stage, Machine<N>& machine, Change change, Value value) {
    for (const ProgramInput& in : program_->inputs) {
      if (!in.leading) continue;
      const std::size_t order = static_cast<std::size_t>(stage + program_->tape.code[in.slot].lead);
      const std::size_t k = order + static_cast<std::size_t>(in.order);
      const N ratio = rising<N>(order, k);
      machine.series(in.slot)[order] = value(in.variable, k) * ratio;
      delta_[in.slot] = change(in.variable) * ratio;
    }
    add_to_tainted(stage, machine);
  }

 private:
  void columns(const Machine<N>& machine, std::size_t from, std::size_t count, Matrix<N>& j);
  void add_to_tainted(int stage, Machine<N>& machine);

  const Program* program_;
  // A row for each slot that depends on leading derivatives: its derivatives with respect to a few unknowns at a time,
  // because all of them would take slots times unknowns of memory.
  Matrix<N> tangent_;
  std::vector<unsigned char> zero_;  // true for rows without an entry, whose content is unused
  struct Operand {
    const N* row;
    N factor;
  };
  std::vector<Operand> operands_;  // operands of the present slot
  std::vector<typename Machine<N>::Partials> partials_;
  std::vector<N> delta_;  // the change of each slot
};

extern template class Sensitivity<double>;
extern template class Sensitivity<long double>;
extern template class Sensitivity<Quad>;
extern template class Sensitivity<Multi>;

}  // namespace anholon
