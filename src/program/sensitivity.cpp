#include "program/sensitivity.h"

#include <algorithm>

namespace anholon {

namespace {
constexpr std::size_t kColumns = 16;  // columns that are computed at a time
}  // namespace

template <Number N>
Sensitivity<N>::Sensitivity(const Program& program)
    : program_(&program), partials_(program.tainted.size()), delta_(program.tape.main_end, N(0)) {}

template <Number N>
void Sensitivity<N>::take(const Machine<N>& machine) {
  const Program& p = *program_;
  for (std::size_t k = 0; k < p.tainted.size(); ++k)
    if (p.tape.code[p.tainted[k].slot].op != Op::linear) partials_[k] = machine.partials(p.tainted[k].slot);
}

template <Number N>
void Sensitivity<N>::jacobian(const Machine<N>& machine, Matrix<N>& all) {
  const Program& p = *program_;
  if (tangent_.data.empty()) {
    tangent_ = Matrix<N>(p.tangent_rows, std::min(kColumns, p.unknowns()));
    zero_.resize(p.tangent_rows);
  }
  for (std::size_t from = 0; from < p.unknowns(); from += kColumns)
    columns(machine, from, std::min(kColumns, p.unknowns() - from), all);
}

// Computes the derivatives with respect to the unknowns [first, first + count).
template <Number N>
void Sensitivity<N>::columns(const Machine<N>& machine, std::size_t first, std::size_t count, Matrix<N>& all) {
  const Program& p = *program_;
  const Tape& tape = p.tape;
  const N none(0);
  N sum(0);
  std::fill(zero_.begin(), zero_.end(), 1);
  for (const ProgramInput& in : p.inputs)
    if (in.leading && in.variable >= first && in.variable < first + count) {
      N* row = &tangent_(p.tangent_row[in.slot], 0);
      std::fill(row, row + count, N(0));
      row[in.variable - first] = N(1);
      zero_[p.tangent_row[in.slot]] = 0;
    }
  for (std::size_t k = 0; k < p.tainted.size(); ++k) {
    const TaintedSlot& t = p.tainted[k];
    const Instruction& in = tape.code[t.slot];
    operands_.clear();
    const auto add = [&](std::uint32_t slot, const N& factor) {
      const std::uint32_t other = p.tangent_row[slot];
      N* row = &tangent_(other, 0);
      if (zero_[other]) {
        if (is_finite(factor)) return;
        std::fill(row, row + count, N(0));
      }
      operands_.push_back({row, factor});
    };
    if (in.op == Op::linear) {
      for (std::uint32_t i = in.first; i < in.first + in.count; ++i) {
        const LinearTerm& term = tape.linear_terms[i];
        if (p.tangent_row[term.slot] != Program::kUntainted && tape.code[term.slot].lead == in.lead)
          add(term.slot, machine.rational(term.coefficient));
      }
    } else if (in.op == Op::select) {
      // The other branch is not evaluated; it may have no value.
      if (const bool first_branch = partials_[k].a > N(0); first_branch ? t.a : t.b)
        add(first_branch ? in.a : in.b, N(1));
    } else {
      if (t.a) add(in.a, partials_[k].a);
      if (t.b) add(in.b, partials_[k].b);
    }
    if (operands_.empty()) continue;
    zero_[t.row] = 0;
    N* row = &tangent_(t.row, 0);
    for (std::size_t j = 0; j < count; ++j) {
      sum = none;
      for (const Operand& o : operands_) addmul(sum, o.factor, o.row[j]);
      row[j] = sum;
    }
  }
  for (std::size_t i = 0; i < p.unknowns(); ++i) {
    const std::uint32_t row = p.tangent_row[tape.roots[i]];
    const bool zero = row == Program::kUntainted || zero_[row];
    for (std::size_t j = 0; j < count; ++j) all(i, first + j) = zero ? N(0) : tangent_(row, j);
  }
}

template <Number N>
void Sensitivity<N>::add_to_tainted(int stage, Machine<N>& machine) {
  const Program& p = *program_;
  const Tape& tape = p.tape;
  for (std::size_t k = 0; k < p.tainted.size(); ++k) {
    const TaintedSlot& t = p.tainted[k];
    const Instruction& in = tape.code[t.slot];
    N change(0);
    if (in.op == Op::linear) {
      for (std::uint32_t i = in.first; i < in.first + in.count; ++i) {
        const LinearTerm& term = tape.linear_terms[i];
        if (p.tangent_row[term.slot] != Program::kUntainted && tape.code[term.slot].lead == in.lead)
          addmul(change, machine.rational(term.coefficient), delta_[term.slot]);
      }
    } else if (in.op == Op::select) {
      if (const bool first = partials_[k].a > N(0); first ? t.a : t.b) change = delta_[first ? in.a : in.b];
    } else if (in.op == Op::rate) {
      const std::size_t order = static_cast<std::size_t>(stage + in.lead);
      change = delta_[in.a] * rising<N>(order, order + in.index);
    } else {
      if (t.a) addmul(change, partials_[k].a, delta_[in.a]);
      if (t.b) addmul(change, partials_[k].b, delta_[in.b]);
    }
    delta_[t.slot] = change;
    machine.series(t.slot)[stage + in.lead] += change;
  }
}

template class Sensitivity<double>;
template class Sensitivity<long double>;
template class Sensitivity<Quad>;
template class Sensitivity<Multi>;

}  // namespace anholon
