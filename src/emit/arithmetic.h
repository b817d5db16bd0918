// Expressions with numbers for their parameters, as few operations on many numbers: constant factors are folded into the
// coefficients of sums, common factors stand in front of sums, and products share their common pairs.
#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "emit/rate_formulas.h"

namespace anholon::emit {

struct Arithmetic {
  enum class Kind : std::uint8_t { input, number, product, reciprocal, sum, power, function, arctan2, select, lookup };
  struct Term {
    Rational coefficient;
    std::uint32_t node;
  };
  struct Node {
    Kind kind;
    std::string text = {};               // of an input
    Rational number = {};                // the value; the constant of a sum; the exponent of a power
    std::vector<Term> terms = {};        // of a sum
    std::vector<std::uint32_t> of = {};  // factors, with repetitions; arguments; select: of[0] >= 0 ? of[1] : of[2]
    std::uint32_t index = 0;             // of the function, of the step function
  };
  static constexpr std::uint32_t kNone = ~std::uint32_t{0};
  // coefficient times node, or the coefficient alone.
  struct Value {
    Rational coefficient;
    std::uint32_t node = kNone;
  };

  std::vector<Node> nodes;  // operands need not come before their users
  std::vector<Value> roots;
  std::vector<StepFunction> step_functions;

  std::vector<std::uint32_t> operands(std::uint32_t node) const;
  // How often other nodes and roots use each node that is needed; 0 for the others.
  std::vector<std::size_t> uses() const;
  // Reciprocals whose only user is a product, which divides instead.
  std::vector<bool> divisors() const;
  // The needed nodes, operands first.
  std::vector<std::uint32_t> order() const;
};

// `es` in the time "t" and the states "x0", "x1", … of the formulas. REQUIRES: explicit rates; es hold no inputs.
Arithmetic arithmetic(const RateFormulas& formulas, const Column& es);

}  // namespace anholon::emit
