#include "program/sensitivity.h"

#include <algorithm>

namespace anholon {

template <Number N>
Sensitivity<N>::Sensitivity(const Program& program)
    : program_(&program), tangent_(program.tangent_rows, program.unknowns()), partials_(program.tainted.size()),
      delta_(program.tape.main_end, N(0)) {}

template <Number N>
void Sensitivity<N>::jacobian(const Machine<N>& machine, Matrix<N>& all) {
  const Program& p = *program_;
  const Tape& tape = p.tape;
  const std::size_t n = p.unknowns();
  std::fill(tangent_.data.begin(), tangent_.data.end(), N(0));
  for (const ProgramInput& in : p.inputs)
    if (in.leading) tangent_(p.tangent_row[in.slot], in.variable) = N(1);
  for (std::size_t k = 0; k < p.tainted.size(); ++k) {
    const TaintedSlot& t = p.tainted[k];
    const Instruction& in = tape.code[t.slot];
    N* row = &tangent_(t.row, 0);
    const auto add = [&](std::uint32_t slot, const N& factor) {
      const N* from = &tangent_(p.tangent_row[slot], 0);
      for (std::size_t j = 0; j < n; ++j) addmul(row[j], factor, from[j]);
    };
    if (in.op == Op::linear) {
      for (std::uint32_t i = in.first; i < in.first + in.count; ++i) {
        const LinearTerm& term = tape.linear_terms[i];
        if (p.tangent_row[term.slot] != Program::kUntainted && tape.code[term.slot].lead == in.lead)
          add(term.slot, machine.rational(term.coefficient));
      }
      continue;
    }
    partials_[k] = machine.partials(t.slot);
    if (in.op == Op::select) {
      // The other branch is not evaluated; it may have no value.
      if (const bool first = partials_[k].a > N(0); first ? t.a : t.b) add(first ? in.a : in.b, N(1));
      continue;
    }
    if (t.a) add(in.a, partials_[k].a);
    if (t.b) add(in.b, partials_[k].b);
  }
  for (std::size_t i = 0; i < n; ++i) {
    const std::uint32_t row = p.tangent_row[tape.roots[i]];
    for (std::size_t j = 0; j < n; ++j) all(i, j) = row == Program::kUntainted ? N(0) : tangent_(row, j);
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
