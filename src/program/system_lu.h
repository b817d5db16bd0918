// The LU of the system Jacobian.
//
// A large matrix in long double is factored in double, which takes a sixth of the time, if it is far from singular: each
// further pass over a residual in long double then gains at least as many digits as the first solution has.
#pragma once
#include <concepts>

#include "numeric/linear.h"

namespace anholon {

template <Number N>
class SystemLu {
 public:
  // Returns false if a pivot vanishes or is NaN; the factors are then unusable.
  bool factor(const Matrix<N>& a);
  // True if these are the factors of `a`.
  bool factors(const Matrix<N>& a) const { return in_double_ ? a.data == original_.data : lu_.factors(a); }

  // Computes x := A^-1 b to the digits of the factors.
  void solve_once(const std::vector<N>& b, std::vector<N>& x) const;
  // Computes x := A^-1 b to the digits of N.
  void solve(const std::vector<N>& b, std::vector<N>& x) const;
  // Returns the number of solutions by solve_once, each for the residual of those before, after which all digits of N
  // are reached and refined once.
  int passes() const { return in_double_ ? kPassesInDouble : 2; }
  // Returns an estimate like that of Lu.
  N smallest_singular_value(std::vector<N>& direction, const Scales<N>& scales = {}) const;

  bool in_double() const { return in_double_; }

 private:
  static constexpr int kPassesInDouble = 4;
  bool factor_in_double(const Matrix<N>& a);

  Lu<N> lu_;
  bool in_double_ = false;
  Matrix<N> original_;  // the matrix, kept with narrow_ instead of lu_ if in_double_
  Lu<double> narrow_;
  mutable std::vector<double> narrow_side_, narrow_solution_;
  mutable std::vector<N> residual_, correction_;
};

extern template class SystemLu<double>;
extern template class SystemLu<long double>;
extern template class SystemLu<Quad>;
extern template class SystemLu<Multi>;

}  // namespace anholon
