// The Taylor coefficients of the unknowns at one point.
#pragma once
#include <concepts>
#include <vector>

#include "numeric/number.h"

namespace anholon {

// The coefficients x_(j, 0), x_(j, 1), … of unknown j; the state holds x_j^(k), k < d_j, one unknown after the other.
template <Number N>
class UnknownCoefficients {
 public:
  UnknownCoefficients(const std::vector<int>& d, std::size_t length) : length_(length), x_(d.size() * length, N(0)) {
    offset_.push_back(0);
    for (int k : d) offset_.push_back(offset_.back() + static_cast<std::size_t>(k));
    factorial_.push_back(N(1));
    for (std::size_t k = 1; k < length_ + 2; ++k) factorial_.push_back(factorial_.back() * N(static_cast<int>(k)));
  }

  std::size_t length() const { return length_; }  // length of each series
  std::size_t state_size() const { return offset_.back(); }
  // Returns the place of x_j in the state.
  std::size_t offset(std::size_t j) const { return offset_[j]; }

  N& operator()(std::size_t j, std::integral auto k) { return x_[j * length_ + static_cast<std::size_t>(k)]; }
  const N& operator()(std::size_t j, std::integral auto k) const {
    return x_[j * length_ + static_cast<std::size_t>(k)];
  }
  N* series(std::size_t j) { return &x_[j * length_]; }
  const N& factorial(std::integral auto k) const { return factorial_[static_cast<std::size_t>(k)]; }
  N derivative(std::size_t j, std::integral auto k) const { return (*this)(j, k) * factorial(k); }

 private:
  std::size_t length_;
  std::vector<std::size_t> offset_;
  std::vector<N> x_, factorial_;
};

}  // namespace anholon
