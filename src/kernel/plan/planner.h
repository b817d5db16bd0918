// Makes the plan of a program: slots.h analyses the tape, layout.h places its slots in the arena, steps.h makes the
// steps of an expansion, linearized_tape.h the linearized tape.
#pragma once
#include <string>

#include "kernel/plan/plan.h"

namespace anholon {

// Returns the reason why a program has no plan; otherwise an empty string.
std::string no_plan(const Program& program);
// REQUIRES: no_plan(program).empty()
// `judged`: the last quadrature is the plan's `determinant`, known at the point of expansion only.
Plan plan(const Program& program, int stages, bool judged = false);

}  // namespace anholon
