// Kinks that the time alone decides, such as that of piecewise(t < 1, 0, 5): their times are known without any series.
#pragma once
#include "program/program.h"

namespace anholon {

// The time at which a slot passes a value, if the slot is a + b t with constants a and b != 0; nullopt otherwise.
template <Number N>
std::optional<N> passes_at(const Program& program, const std::vector<N>& parameters, std::uint32_t slot,
                           const N& value);

// True if the sign of the difference between such a slot and its value is exact in any number type: the slot is the
// time, or the time and one constant.
bool has_exact_sign(const Program& program, std::uint32_t slot);

}  // namespace anholon
