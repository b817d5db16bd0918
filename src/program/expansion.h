// The Taylor expansion of the motion at one point, in any number type.
//
// State: x_j^(k), k < d_j, of every unknown j, one after the other. Usage:
//   load(t, state, guess) -> prepare() [values, J, LU] -> project() -> solve() -> extend().
// A wider expansion can project and solve with the LU of a narrower one (mixed-precision iterative
// refinement): load -> evaluate() -> adopt_jacobian() -> project(solver) -> solve(solver).
#pragma once
#include <functional>
#include <optional>

#include "base/outcome.h"
#include "program/program.h"
#include "program/system_jacobian.h"
#include "program/unknown_coefficients.h"

namespace anholon {

// An equation holds while its residual is below this many round-offs of its terms.
inline constexpr int kQuietRoundoffs = 6;

// The residuals of the hidden constraints E_i^(k), k < c_i, relative to their terms.
template <Number N>
class HiddenResiduals {
 public:
  explicit HiddenResiduals(const std::vector<int>& c) {
    for (int k : c) {
      offset_.push_back(values_.size());
      values_.resize(values_.size() + static_cast<std::size_t>(k), N(0));
    }
  }
  N& operator()(std::size_t i, int k) { return values_[offset_[i] + static_cast<std::size_t>(k)]; }
  const N& operator()(std::size_t i, int k) const { return values_[offset_[i] + static_cast<std::size_t>(k)]; }

 private:
  std::vector<std::size_t> offset_;
  std::vector<N> values_;
};

template <Number N>
class Expansion {
 public:
  // stages: the number of orders beyond the leading derivatives that are computed.
  Expansion(const Program& program, const std::vector<N>& parameters, int stages);

  void set_parameters(const std::vector<N>& parameters) {
    parameters_ = parameters;
    machine_.set_parameters(parameters);
  }

  std::size_t state_size() const { return x_.state_size(); }
  std::size_t offset(std::size_t variable) const { return x_.offset(variable); }
  int stages() const { return stages_; }
  const Program& program() const { return *program_; }

  // Sets the point; `leading`: a first guess of x_j^(d_j) (zero if empty).
  void load(const N& t, const std::vector<N>& state, const std::vector<N>& leading);
  // Values at the point and J with its LU.
  Outcome prepare();
  // Values at the point only.
  void evaluate() { sweep_known(0); }
  // Computes what evaluate() and evaluate_quadratures() do, for these slots alone (tape/tape.h: precedents).
  void evaluate(const std::vector<std::uint32_t>& slots);
  // Solves J y = r; by default with the LU of prepare().
  using Solver = std::function<void(const std::vector<N>& r, std::vector<N>& y)>;
  // Corrects the state by least change so that all hidden constraints hold to round-off.
  Outcome project();
  Outcome project(const Solver& solver);
  // Measures the residuals of the hidden constraints, after prepare(), without a projection.
  void measure();
  // Solves for the leading derivatives by Newton's method.
  Outcome solve();
  Outcome solve(const Solver& solver);
  template <Number M>
  void adopt_jacobian(const SystemJacobian<M>& j) {
    jacobian_.adopt(j);
  }
  // Copies the point from a wider expansion, every value correctly rounded: the coefficients of higher order then start
  // from values without round-off of their own (an angle of many turns has lost digits in N that its sine still needs).
  template <Number M>
  void adopt_values(const Expansion<M>& wide) {
    t_ = convert<N>(wide.time());
    for (std::size_t j = 0; j < program_->unknowns(); ++j)
      for (int k = 0; k <= program_->d[j]; ++k) x_(j, k) = convert<N>(wide.coefficient(j, k));
    for (std::uint32_t s = 0; s < program_->tape.main_end; ++s) {
      const Instruction& in = program_->tape.code[s];
      if (in.constant) continue;
      for (int p = 0; p <= in.lead; ++p) machine_.series(s)[p] = convert<N>(wide.machine().series(s)[p]);
    }
  }
  // Stores a coefficient that was computed elsewhere, for readers of slots.
  void adopt_coefficient(std::uint32_t slot, int order, const N& value) { machine_.series(slot)[order] = value; }
  const std::vector<N>& parameters() const { return parameters_; }
  const Machine<N>& machine() const { return machine_; }
  const SystemJacobian<N>& system_jacobian() const { return jacobian_; }
  // Coefficients of all stages 1..stages().
  Outcome extend();
  // Replaces extend() if formulas have no derivatives: the polynomials end with these leading derivatives, and all
  // other series with the coefficients of stage 0.
  void cut_to(const std::vector<N>& leading);

  // Returns the worst hidden-constraint residual |E_i^(k)| (k < c_i) relative to its terms (numeric/relative.h), at the
  // state as last measured or projected.
  const N& constraint_residual() const { return constraint_residual_; }
  // Returns the distance of the state from the hidden constraints found by project(), relative to the size of the
  // state, and the equation with this distance.
  const N& drift() const { return drift_; }
  std::size_t most_missed() const { return most_missed_; }
  // Returns the residual of derivative k < c_i of equation i.
  const N& hidden_residual(std::size_t i, int k) const { return hidden_(i, k); }
  // Returns the residual of the equations at the computed leading derivatives, relative to their terms.
  const N& equation_residual() const { return equation_residual_; }
  // Returns the largest of all terms at derivative order c_i - level, in the units of equation i, after prepare(). The
  // residual may be of the size of the round-off of this term, even if all terms of equation i vanish: the error comes
  // from the other numbers of the same solution.
  N size_of_level(int level, std::size_t i) const;
  // Returns how large the leading derivative of unknown j can be by the terms of all equations.
  N size_of_leading(std::size_t j) const;
  N smallest_singular_value() { return jacobian_.smallest_singular_value(direction_); }
  // Returns the change of the unknowns to which J is least sensitive; the next call continues its iteration.
  const std::vector<N>& weakest_direction() const { return direction_; }
  void set_weakest_direction(const std::vector<N>& direction) { direction_ = direction; }

  const N& time() const { return t_; }
  // These return x_j^(k) at the point (k <= d_j), and the Taylor coefficient of order k.
  N derivative(std::size_t j, int k) const { return x_.derivative(j, k); }
  const N& coefficient(std::size_t j, int k) const { return x_(j, k); }
  void state(std::vector<N>& out) const;
  void leading(std::vector<N>& out) const;
  // Computes E_i^(c_i) at the loaded leading derivatives, after evaluate(): the residual that solve() makes zero.
  void equations(std::vector<N>& out) const;
  // Computes the quadratures at the point itself, order 0; extend() computes all orders.
  void evaluate_quadratures() { sweep_quadratures(0); }
  // Returns the Taylor series (ascending) of quadrature i, orders 0..stages().
  const N* quadrature(std::size_t i) const { return machine_.series(program_->tape.roots[program_->unknowns() + i]); }

  // Returns the magnitude of the terms of the quadrature's value.
  N quadrature_terms(std::size_t i) const { return machine_.magnitude(program_->tape.roots[program_->unknowns() + i]); }

 private:
  void set_inputs(int stage, std::size_t from, std::size_t to);
  void sweep(int stage);
  void sweep_known(int last_stage);
  void sweep_quadratures(int last_stage);
  Outcome newton(const Solver& solver, bool own);
  Outcome singular() const;
  Outcome unsolved() const;
  bool residual(int level, std::vector<N>& r, N& worst);
  N terms_of(std::size_t i, int level) const;
  N moved_by_unknowns(std::size_t i, int level) const;
  const N& balanced_size(int level) const;
  bool left_is_roundoff() const;
  N displacement(int level, const std::vector<N>& r, std::size_t& equation) const;
  void add_leading(int stage);

  const Program* program_;
  std::vector<N> parameters_;
  int stages_;
  Machine<N> machine_;
  N t_{0};
  UnknownCoefficients<N> x_;
  SystemJacobian<N> jacobian_;
  std::vector<N> delta_x_, r_, y_, direction_;
  N constraint_residual_{0}, drift_{0}, equation_residual_{0};
  std::size_t most_missed_ = 0;  // the equation of drift_
  HiddenResiduals<N> hidden_;
  mutable std::vector<std::optional<N>> size_;  // size of each level, balanced, at the current point
  mutable std::vector<std::vector<N>> moved_;   // for each level, by a sparse J: moved_by_unknowns for all equations
};

extern template class Expansion<double>;
extern template class Expansion<long double>;
extern template class Expansion<Quad>;
extern template class Expansion<Multi>;

}  // namespace anholon
