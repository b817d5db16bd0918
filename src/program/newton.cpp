// The part of an expansion that solves for the leading derivatives.
#include "numeric/more_digits.h"
#include "numeric/relative.h"
#include "program/expansion.h"
#include "program/fault.h"

namespace anholon {

namespace {
constexpr int kMostNewton = 30;
}  // namespace

template <Number N>
Outcome Expansion<N>::solve() {
  return newton([this](const std::vector<N>& r, std::vector<N>& y) { jacobian_.solve(r, y); }, true);
}

template <Number N>
Outcome Expansion<N>::solve(const Solver& solver) {
  return newton(solver, false);
}

// True if no residual of the equations exceeds the rounding error of its evaluation. Terms that vanish together count
// with the size at which they were computed: a small factor may precede a difference of large accelerations, and
// products of velocities that are no terms of the equation may cancel within one of them.
template <Number N>
bool Expansion<N>::left_is_roundoff() const {
  const Program& p = *program_;
  const Tape& tape = p.tape;
  std::vector<N> size(tape.main_end, N(0));
  for (const ProgramInput& in : p.inputs)
    if (in.leading) size[in.slot] = abs(machine_.series(in.slot)[tape.code[in.slot].lead]);
  for (const TaintedSlot& t : p.tainted) {
    const Instruction& in = tape.code[t.slot];
    const std::size_t order = in.lead;
    N& s = size[t.slot];
    s = abs(machine_.series(t.slot)[order]);
    N sum(0);
    if (in.op == Op::linear) {
      for (std::uint32_t i = in.first; i < in.first + in.count; ++i) {
        const LinearTerm& term = tape.linear_terms[i];
        if (p.tangent_row[term.slot] != Program::kUntainted && tape.code[term.slot].lead == in.lead)
          addmul(sum, N(abs(machine_.rational(term.coefficient))), size[term.slot]);
      }
    } else {
      const typename Machine<N>::Partials d = machine_.partials(t.slot);
      N factor(1);
      if (in.op == Op::rate)
        for (std::size_t k = 1; k <= in.index; ++k) factor = factor * N(static_cast<int>(order + k));
      if (t.a && d.a != N(0)) addmul(sum, N(abs(d.a) * factor), size[in.a]);
      if (t.b && d.b != N(0)) addmul(sum, N(abs(d.b)), size[in.b]);
    }
    if (sum > s) s = sum;
  }
  std::vector<N> made;
  machine_.made_of(made);
  for (std::size_t i = 0; i < p.unknowns(); ++i) {
    const N value = abs(machine_.series(p.tape.roots[i])[p.c[i]]);
    N most = size[tape.roots[i]];
    if (p.c[i] == 0 && made[tape.roots[i]] > most) most = made[tape.roots[i]];
    for (const N& v : {terms_of(i, 0), N(size_of_level(0, i) / x_.factorial(p.c[i]))})
      if (v > most) most = v;
    if (!(value <= unit_roundoff<N>() * N(kRoundoffsOfSum) * most)) return false;
  }
  return true;
}

// If all residuals are round-off of their terms, the next step is J^-1 times round-off, however large. It leads to a
// solution as good as any other, and further steps do not improve it. The sizes of steps are not tested: if J is nearly
// singular, or masses are very different, they do not shrink.
template <Number N>
Outcome Expansion<N>::newton(const Solver& solver, bool own) {
  const Program& p = *program_;
  const N eps = unit_roundoff<N>();
  N last(-1), left(-1);
  for (int k = 0; k < kMostNewton; ++k) {
    N worst(0);
    residual(0, r_, worst);
    if (!is_finite(worst)) return fault_outcome(*program_, machine_, 0);
    equation_residual_ = worst;
    const bool holds = !(worst > eps * N(kQuietRoundoffs));
    // The residual shrinks no further, and is round-off.
    const bool stalls = !holds && left >= N(0) && !(worst < left * N(0.5)) && left_is_roundoff();
    left = worst;
    solver(r_, y_);
    N step(0), size(0);
    for (std::size_t j = 0; j < p.unknowns(); ++j) {
      N& x = x_(j, p.d[j]);
      const N change = y_[j] / x_.factorial(p.d[j]);
      if (!is_finite(change)) return unsolved();
      x += change;
      if (abs(y_[j]) > step) step = abs(y_[j]);
      if (N v = abs(x) * x_.factorial(p.d[j]); v > size) size = v;
    }
    // The residual is below the range of the numbers: the only force is a function that almost vanishes.
    if (!(step > N(0))) return {};
    sweep(0);
    // The terms of a guess may be larger than those of the solution.
    if (stalls || (holds && (k > 0 || !(step > eps * N(kQuietRoundoffs) * size)))) return {};
    if (own && k >= 2 && last >= N(0) && step > last * N(0.1)) {
      // Convergence is slow: the Jacobian has changed with the leading derivatives.
      jacobian_.compute(machine_);
      if (!jacobian_.factor()) return unsolved();
    }
    last = step;
  }
  return unsolved();
}

template <Number N>
Outcome Expansion<N>::unsolved() const {
  if (program_->several_solutions)
    return {OutcomeKind::no_convergence, "Newton's iteration for the leading derivatives did not converge",
            "the equations may have no real solution here (a branch ends), or another branch is near: give a guess"};
  return {OutcomeKind::no_convergence,
          "the equations are so nearly singular that round-off hides their solution for the leading derivatives",
          "ask for more digits (--digits " + std::to_string(more_digits<N>()) +
              "), or write coordinates and constraints so that they are regular here"};
}

#define INSTANTIATE(N)                                                                                                 \
  template Outcome Expansion<N>::solve();                                                                              \
  template Outcome Expansion<N>::solve(const Solver&);                                                                 \
  template Outcome Expansion<N>::newton(const Solver&, bool);                                                          \
  template bool Expansion<N>::left_is_roundoff() const;                                                                \
  template Outcome Expansion<N>::unsolved() const;
INSTANTIATE(double)
INSTANTIATE(long double)
INSTANTIATE(Quad)
INSTANTIATE(Multi)
#undef INSTANTIATE

}  // namespace anholon
