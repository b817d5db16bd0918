// Describes in words of the model a formula of a tape that has no value or no derivatives.
#pragma once
#include <functional>

#include "base/outcome.h"
#include "model/model.h"
#include "tape/tape.h"

namespace anholon {

// Returns the outcome `not_a_number`, whose text has the formula of the slot, the only element of the model that holds
// the formula, and the value of its argument: "sqrt(x - 1) in the force 'spring' has no value, where x - 1 = -0.25".
// `value` returns the value of a slot at order 0; if the value of this slot is finite, the formula has no derivatives.
Outcome without_value(const Tape& tape, const Model& model, std::uint32_t slot,
                      const std::function<double(std::uint32_t)>& value);

// Returns the message alone, without the element: for a formula of its own, such as that of an output.
std::string message_without_value(const Tape& tape, const Model& model, std::uint32_t slot,
                                  const std::function<double(std::uint32_t)>& value);

}  // namespace anholon
