// Tests whether an expression is identically zero, in a finite field: the nodes are evaluated modulo a prime at random
// points, where a nonzero polynomial of degree d vanishes with probability d/p at most.
//
// The primes are p = 2r + 1 with r prime, near 2^61, and all primes up to 47 are squares modulo p:
//   - half the field are squares, −1 is none, and every square has one root that is itself a square.
//     Taken as the square root, it is multiplicative, as the positive root is: √a √b = √(ab), √36 = 6.
//     Odd roots are unique.
//   - points (cos, sin) of the circle group stand for angles. Angles are flattened into Σ c·atom; each
//     atom gets a random point for atom/q, q the common denominator, and the rest are powers and
//     products, which is the addition theorem. Multiples of π/12 are exact. exp goes the same way,
//     with a random square that is not 0 for each atom.
//   - of log, asin, atan, … only this is used: equal arguments have equal values, the value of −u is
//     that of an odd function, acos u = π/2 − asin u. sign and abs follow whether u is a square.
// Every rule is true of the real functions, so an expression that is identically zero by the rules is zero, and one
// that is not zero is detected with probability 1 − d/p, except for branches: √(x²) is x at half of the points, as for
// real x. For roots that may hide squares (the radicand was a square at all points seen), and for sign and abs, the
// number of points is large enough for each choice of signs to occur.
//
// An expression that is zero by another rule (log(ab) = log a + log b) is called nonzero here; the caller checks such a
// result with real numbers.
#pragma once
#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "base/hash.h"
#include "proof/checker/certificate.h"
#include "proof/checker/work.h"

namespace anholon::verification {

inline constexpr std::array<std::uint64_t, 16> kPrimes = {
    2305843009213057079, 2305843009178326439, 2305843009101690119, 2305843009045133879,
    2305843009005485759, 2305843008934483079, 2305843008908132399, 2305843008817757639,
    2305843008811413959, 2305843008787237079, 2305843008727893599, 2305843008716181359,
    2305843008639951959, 2305843008563423159, 2305843008485267039, 2305843008405113999};

struct ModularFinding {
  enum class Is : std::uint8_t { zero, nonzero, unknown } is = Is::unknown;
  double log2_chance = 0;  // zero: log2 of a bound on the probability that it is not zero
  std::string detail;      // unknown: the reason
};

// Returns a finding for each claim of zero; `unknown` for the other claims.
std::vector<ModularFinding> test_zero(const Certificate& c, const HashKey& key, int points, Work& work);

}  // namespace anholon::verification
