// The motion by Taylor steps: order from the tolerance, step size after Jorba & Zou, projection on
// all hidden constraints at every step, compensated update of the state, dense output.
#pragma once
#include <functional>

#include "program/expansion.h"

namespace anholon {

struct StepSettings {
  double tolerance = 1e-12;
  int order = 0;                     // of the Taylor polynomials; 0: from the tolerance
  std::size_t most_steps = 50'000'000;
  std::function<bool()> cancelled;   // asked between steps
};

// ceil(-ln(tolerance)/2 + 1): the order that makes the least work for the tolerance.
int taylor_order(double tolerance);

template <Number N>
class Stepper {
 public:
  Stepper(const Program& program, const std::vector<N>& parameters, const StepSettings& settings);

  // Starts at a consistent state; `leading` is a first guess and names the branch.
  Outcome start(const N& t, const std::vector<N>& state, const std::vector<N>& leading = {});
  // One step towards `end`, at most up to it. After it, `polynomial` covers [before, time()].
  Outcome step(const N& end);

  const N& time() const { return t_; }
  const N& before() const { return before_; }
  std::size_t steps() const { return steps_; }
  int order() const { return order_; }
  N last_step() const { return t_ - before_; }

  // The solution at the point reached last (before the step is taken) …
  const Expansion<N>& expansion() const { return expansion_; }
  // … and anywhere in the last step: projected and with its leading derivatives solved for, in an
  // expansion of its own.
  Outcome at(const N& t, Expansion<N>& point) const;

  const std::vector<N>& state() const { return state_; }
  // Integrals of the quadratures since the start.
  const std::vector<N>& integrals() const { return integrals_; }
  const N& worst_constraint() const { return worst_constraint_; }
  const N& worst_equation() const { return worst_equation_; }
  const N& smallest_sigma() const { return smallest_sigma_; }

 private:
  Outcome expand(const std::vector<N>& guess);
  N step_size() const;
  void polynomial(const N& h, std::vector<N>& state, std::vector<N>& leading) const;

  const Program* program_;
  StepSettings settings_;
  int order_;
  Expansion<N> expansion_;
  N t_{0}, before_{0}, horizon_{0};
  std::vector<N> state_, carry_, leading_, integrals_, integral_carry_;
  std::size_t steps_ = 0;
  N worst_constraint_{0}, worst_equation_{0}, smallest_sigma_{1};
};

extern template class Stepper<double>;
extern template class Stepper<long double>;
extern template class Stepper<Multi>;

}  // namespace anholon
