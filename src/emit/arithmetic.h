// Expressions with numbers for their parameters, in few operations for many states: constant factors are folded into
// the coefficients of sums, common factors are taken out of sums, and products share their common pairs.
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
    std::string text = {};               // text of an input
    Rational number = {};                // the value; the constant of a sum; the exponent of a power
    std::vector<Term> terms = {};        // terms of a sum
    std::vector<std::uint32_t> of = {};  // factors, with repetitions; arguments; select: of[0] >= 0 ? of[1] : of[2]
    std::uint32_t index = 0;             // index of the function or of the step function
  };
  static constexpr std::uint32_t kNone = ~std::uint32_t{0};
  // The value coefficient times node, or the coefficient alone.
  struct Value {
    Rational coefficient;
    std::uint32_t node = kNone;
  };

  std::vector<Node> nodes;  // operands may come after their users
  std::vector<Value> roots;
  std::vector<StepFunction> step_functions;

  std::vector<std::uint32_t> operands(std::uint32_t node) const;
  // Returns how often other nodes and roots use each node that is needed; 0 for the others.
  std::vector<std::size_t> uses() const;
  // Marks reciprocals whose only user is a product, which divides instead.
  std::vector<bool> divisors() const;
  // Returns the needed nodes, operands first.
  std::vector<std::uint32_t> order() const;
};

// Makes the arithmetic of `es`, in the time "t" and the states "x0", "x1", … of the formulas. REQUIRES: the rates are
// explicit, and es contain no inputs.
Arithmetic arithmetic(const RateFormulas& formulas, const Column& es);

}  // namespace anholon::emit
