// Names the formula of a tape that has no value, or no derivatives, in words of the model.
#pragma once
#include <functional>

#include "base/outcome.h"
#include "model/model.h"
#include "tape/tape.h"

namespace anholon {

// `not_a_number`, with the formula of the slot, the element of the model that alone holds it, and the value of its
// argument: "sqrt(x - 1) in the force 'spring' has no value, where x - 1 = -0.25". `value`: that of a slot at order 0; where it is finite, the formula has no derivatives.
Outcome without_value(const Tape& tape, const Model& model, std::uint32_t slot,
                      const std::function<double(std::uint32_t)>& value);

}  // namespace anholon
