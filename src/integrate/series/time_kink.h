// Kinks that the time alone decides, such as that of piecewise(t < 1, 0, 5): their times are known without any series.
#pragma once
#include "program/program.h"

namespace anholon {

// A function a + b t + c t^2 of the time.
template <Number N>
struct TimePolynomial {
  N a{0}, b{0}, c{0};
  int degree() const { return c != N(0) ? 2 : b != N(0) ? 1 : 0; }
  bool constant() const { return degree() == 0; }
};

// The time at which a slot passes a value, if the slot is a + b t with constants a and b != 0; nullopt otherwise.
template <Number N>
std::optional<N> passes_at(const Program& program, const std::vector<N>& parameters, std::uint32_t slot,
                           const N& value);

// Returns the slots that are such polynomials; nullopt for other slots. `of_time`: tells for each slot whether it is a
// formula of the time and constants alone.
template <Number N>
std::vector<std::optional<TimePolynomial<N>>> time_polynomials(const Program& program, const std::vector<N>& parameters,
                                                               const std::vector<bool>& of_time);

// True if the sign of the difference between such a slot and its value is exact in any number type: the slot is the
// time, or the time and one constant.
bool has_exact_sign(const Program& program, std::uint32_t slot);

}  // namespace anholon
