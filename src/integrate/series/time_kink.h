// Kinks that the time alone decides, such as that of piecewise(t < 1, 0, 5): where they are is known without any series.
#pragma once
#include "program/program.h"

namespace anholon {

// When a slot passes a value that is a + b t with constants a and b != 0; nullopt if it is something else.
template <Number N>
std::optional<N> passes_at(const Program& program, const std::vector<N>& parameters, std::uint32_t slot,
                           const N& value);

// Whether the sign of the distance of such a slot from its value is right in any number type: the slot is the time, or
// the time and one constant.
bool has_exact_sign(const Program& program, std::uint32_t slot);

}  // namespace anholon
