// A difference that is claimed to be zero or not zero, the verdict on it, and the point that refutes it.
#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "expr/diff.h"

namespace anholon {

enum class Verdict : std::uint8_t {
  unknown,  // neither was found within the limits; the size of the difference at some points is known
  proved,   // it is zero in the exact algebra (expr/normal.h), for all values of all symbols
  refuted,  // at a point of the manifold, with rational free coordinates, a ball that holds it excludes zero
};
const char* name(Verdict v);

// A point of the manifold: rational values of the free symbols, and boxes proved to contain exactly one root of the
// equations.
struct WitnessPoint {
  std::vector<std::pair<Expr, Rational>> values;
  struct Enclosed {
    Expr symbol;
    Rational midpoint, radius;
  };
  std::vector<Enclosed> enclosed;
  Column equations;
};

// left - sum coefficient * term, which is claimed to be zero or not zero.
struct Difference {
  std::string component;
  Expr left;
  std::vector<std::pair<Expr, Expr>> right;
  Verdict verdict = Verdict::unknown;
  std::optional<WitnessPoint> witness;  // if refuted
  std::string detail;                   // the value at the witness, or the bound reached

  Expr expression() const;
};

}  // namespace anholon
