// The system Jacobian J at one point, with its LU: stored in full or, for many unknowns, sparse (program/linearized.h).
#pragma once
#include <cmath>

#include "program/sparse_jacobian.h"
#include "program/system_lu.h"

namespace anholon {

template <Number N>
class SystemJacobian {
 public:
  explicit SystemJacobian(const Program& program) : program_(&program), sensitivity_(program), sparse_(program) {}

  // Computes J at the values of the machine; keeps the partial derivatives of the slots for sensitivity().
  void compute(const Machine<N>& machine);
  // Takes J, without its factors, from another number type.
  template <Number M>
  void adopt(const SystemJacobian<M>& other) {
    is_sparse_ = other.is_sparse();
    balance_.reset();
    if (is_sparse_) return sparse_.adopt(other.sparse());
    make_room();
    for (std::size_t k = 0; k < j_.data.size(); ++k) j_.data[k] = convert<N>(other.written().data[k]);
  }
  Sensitivity<N>& sensitivity() { return sensitivity_; }

  bool is_sparse() const { return is_sparse_; }
  const SparseJacobian<N>& sparse() const { return sparse_; }
  // REQUIRES: !is_sparse().
  const Matrix<N>& written() const { return j_; }
  // Returns J in full in any case.
  Matrix<N> matrix() const { return is_sparse_ ? sparse_.matrix() : j_; }

  bool finite() const;
  // Returns false if a pivot vanishes or is NaN; there are no factors then.
  bool factor();
  // True if the factors are those of J.
  bool factored() const { return is_sparse_ ? sparse_.factored() : lu_.factors(j_); }
  // Stores J in full and factors it again, for decisions that must not depend on sparse factors.
  bool factor_written();

  // These have the meaning that they have in SystemLu.
  void solve_once(const std::vector<N>& b, std::vector<N>& x) const {
    is_sparse_ ? sparse_.solve_once(b, x) : lu_.solve_once(b, x);
  }
  void solve(const std::vector<N>& b, std::vector<N>& x) const { is_sparse_ ? sparse_.solve(b, x) : lu_.solve(b, x); }
  int passes() const { return is_sparse_ ? 2 : lu_.passes(); }
  // Returns an estimate for J with rows divided by their largest entry. If inertia is far from 1, as with masses of
  // 1e-18, or the coefficients of a constraint or of a rate are very large, the estimate is for other units of mass,
  // multipliers and rates, and columns are divided by their largest entries as well.
  N smallest_singular_value(std::vector<N>& direction) const {
    const Scales<N> scales = scales_of_far_units();
    return is_sparse_ ? sparse_.smallest_singular_value(direction, scales)
                      : lu_.smallest_singular_value(direction, scales);
  }

  // Computes y := J x.
  void multiply(const std::vector<N>& x, std::vector<N>& y) const;
  // Returns the largest |J_ij| over the unknowns with d_j >= level.
  N largest(std::size_t i, int level = 0) const;
  const Balance& balance() const;

 private:
  // Returns scales; empty if no unit is far from 1, or J is sparse.
  Scales<N> scales_of_far_units() const;
  // Allocates J, which has no memory while it is not needed.
  void make_room() {
    if (j_.data.empty()) j_ = Matrix<N>(program_->unknowns(), program_->unknowns());
  }

  const Program* program_;
  Sensitivity<N> sensitivity_;
  bool is_sparse_ = false;
  SparseJacobian<N> sparse_;
  Matrix<N> j_;
  SystemLu<N> lu_;
  mutable std::optional<Balance> balance_;  // balance of the full J
};

extern template class SystemJacobian<double>;
extern template class SystemJacobian<long double>;
extern template class SystemJacobian<Quad>;
extern template class SystemJacobian<Multi>;

}  // namespace anholon
