// Random expressions that are defined and smooth for all real values of their symbols and stay of moderate size.
#pragma once
#include <random>

#include "expr/expr.h"

namespace anholon::test {

class RandomExpr {
 public:
  RandomExpr(Graph& graph, std::uint32_t seed, std::vector<Expr> atoms)
      : g_(graph), random_(seed), atoms_(std::move(atoms)) {}

  int below(int n) { return static_cast<int>(random_() % static_cast<std::uint32_t>(n)); }
  Rational coefficient() {
    const Rational r(below(9) - 4, 1 + below(4));
    return r == 0 ? Rational(1, 3) : r;
  }
  Expr atom() { return atoms_[static_cast<std::size_t>(below(static_cast<int>(atoms_.size())))]; }

  Expr make(int depth) {
    if (depth <= 0) return atom();
    switch (below(8)) {
    case 0:
    case 1:
    case 2: {
      std::vector<std::pair<Rational, Expr>> terms;
      for (int k = 2 + below(3); k > 0; --k) terms.push_back({coefficient(), make(depth - 1)});
      if (below(2)) terms.push_back({coefficient(), g_.one()});
      return g_.sum(terms);
    }
    case 3:
    case 4:
      return make(depth - 1) * make(depth - 1);
    case 5: {
      const Expr u = make(depth - 1), positive = 1 + u * u;
      switch (below(4)) {
      case 0:
        return sqrt(positive);
      case 1:
        return pow(positive, {-1 - 2 * below(2), 2});
      case 2:
        return pow(sin(u), 2 + below(2));
      default:
        return make(depth - 1) / positive;
      }
    }
    case 6:
      return function(below(static_cast<int>(kFunctions)), make(depth - 1));
    default: {
      const Expr v = make(depth - 1);
      return atan2(make(depth - 1), 2 + v * v);
    }
    }
  }

  // The elementary function number k, of an argument that stays in its domain; the arguments of abs and sign stay away
  // from the corner.
  Expr function(int k, Expr u) {
    const Function f = static_cast<Function>(k);
    switch (f) {
    case Function::sin:
    case Function::cos:
    case Function::atan:
    case Function::tanh:
    case Function::asinh:
      return g_.apply(f, u);
    case Function::sinh:
    case Function::cosh:
    case Function::exp:
    case Function::tan:
      return g_.apply(f, sin(u));
    case Function::asin:
    case Function::acos:
    case Function::atanh:
      return g_.apply(f, u / (1 + u * u));
    case Function::acosh:
    case Function::abs:
    case Function::sign:
      return g_.apply(f, 2 + sin(u));
    case Function::log:
      return g_.apply(f, 1 + u * u);
    }
    return u;
  }

  static constexpr std::size_t kFunctions = 0
#define ROW(name, ...) +1
#include "expr/elementary.def"
#undef ROW
      ;

 private:
  Graph& g_;
  std::mt19937 random_;
  std::vector<Expr> atoms_;
};

}  // namespace anholon::test
