// Proof that a square system f(x) = 0 has exactly one root in a box: the interval Newton operator of Krawczyk,
//
//     K(X) = m − Y f(m) + (I − Y f'(X)) (X − m),      m the center of X, Y near f'(m)^-1.
//
// K(X) contains every root in X, and if K(X) is in the interior of X there is exactly one root. A double root is never
// proved.
#pragma once
#include <cstddef>
#include <functional>
#include <optional>
#include <vector>

#include "numeric/ball.h"
#include "numeric/linear.h"
#include "numeric/number.h"

namespace anholon {

using Box = std::vector<Ball>;

struct SquareSystem {
  std::size_t size = 0;
  std::function<std::vector<Ball>(const Box&)> value;     // `size` values
  std::function<std::vector<Ball>(const Box&)> jacobian;  // row-major, encloses all derivatives on the box
};

// Returns K(X); nullopt if the derivatives are not defined on all of X, or if no approximate inverse is found.
std::optional<Box> krawczyk(const SquareSystem& f, const Box& box);

// Returns a box around the root, as small as the precision allows, if the box is proved to contain exactly one root;
// else nullopt.
std::optional<Box> prove_root(const SquareSystem& f, const Box& box);

// Returns a box that is proved to contain exactly one root, near an approximate root; else nullopt.
std::optional<Box> enclose_root(const SquareSystem& f, const std::vector<Multi>& approximate);
std::optional<Box> enclose_root(const SquareSystem& f, const std::vector<long double>& approximate);

}  // namespace anholon
