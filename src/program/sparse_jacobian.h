// The system Jacobian of many unknowns, which is never stored in full: products with it, and sparse factors.
#pragma once
#include <memory>
#include <optional>

#include "numeric/balance.h"
#include "program/linearized.h"
#include "program/sensitivity.h"

namespace anholon {

template <Number N>
class SparseJacobian {
 public:
  explicit SparseJacobian(const Program& program) : linearized_(program.linearized), d_(program.d) {}

  // Takes the partial derivatives of the machine's values. Returns false if J is to be stored in full instead: the
  // program has few unknowns, sparse factors would not save much or were inaccurate at these values, or a number is
  // beyond the range of double.
  bool take(const Machine<N>& machine, const Sensitivity<N>& sensitivity);
  // Takes the numbers of another type.
  template <Number M>
  void adopt(const SparseJacobian<M>& other) {
    partials_.clear();
    for (const M& p : other.partials()) partials_.push_back(convert<N>(p));
    largest_ = other.all_largest();
    forget();
  }
  const std::vector<N>& partials() const { return partials_; }
  const std::vector<std::vector<double>>& all_largest() const { return largest_; }

  // Factors J. Returns false if a pivot vanishes, or if the solution for one side has a larger residual than round-off
  // explains: take() then refuses these numbers.
  bool factor();
  bool factored() const { return factored_; }
  // Makes take() refuse the same numbers.
  void refuse() { refused_ = true, factored_ = false; }
  // Returns the number of entries of the factors.
  std::size_t entries() const { return lu_.entries(); }

  // Compute x := J^-1 b and J^-T b, to the digits of the factors.
  void solve_once(const std::vector<N>& b, std::vector<N>& x) const;
  void solve_transposed(const std::vector<N>& b, std::vector<N>& x) const;
  // Computes x := J^-1 b with one step of iterative refinement.
  void solve(const std::vector<N>& b, std::vector<N>& x) const;
  // Returns an estimate like that of Lu: the rows of J are divided by their largest entry.
  N smallest_singular_value(std::vector<N>& direction, const Scales<N>& scales = {}) const;

  // Computes y := J x.
  void multiply(const std::vector<N>& x, std::vector<N>& y) const { anholon::multiply(*linearized_, partials_, x, y); }
  // Computes the sizes of the terms that x causes in each equation.
  void multiply_sizes(const std::vector<N>& x, std::vector<N>& y) const {
    anholon::multiply_sizes(*linearized_, partials_, x, y);
  }
  // Returns the largest |J_ij| over the unknowns with d_j >= level.
  double largest(std::size_t i, int level) const {
    return static_cast<std::size_t>(level) < largest_.size() ? largest_[static_cast<std::size_t>(level)][i] : 0;
  }
  // Returns factors that bring the sum of the sizes in each row and column to about 1.
  const Balance& balance() const;
  // Returns J in full.
  Matrix<N> matrix() const;

 private:
  void forget() { factored_ = refused_ = false, balance_.reset(); }

  std::shared_ptr<const Linearized> linearized_;
  std::vector<int> d_;
  Partials<N> partials_, taken_;
  std::vector<std::vector<double>> largest_;
  std::vector<N> values_;  // values of the entries of the sparse matrix
  ThresholdLu<N> lu_;
  bool factored_ = false, refused_ = false;
  mutable std::optional<Balance> balance_;
  mutable std::vector<N> side_, residual_, correction_;
};

extern template class SparseJacobian<double>;
extern template class SparseJacobian<long double>;
extern template class SparseJacobian<Quad>;
extern template class SparseJacobian<Multi>;

}  // namespace anholon
