// The motion of a prepared system as a program in C or Python, with its consistent initial state, inputs, outputs and events.
#pragma once
#include "setup/scenario.h"

namespace anholon {

enum class ProgramLanguage : std::uint8_t { c, python };

// `name`: the prefix of names in C; `made_by`: a line for the head of the text. Throws Failure for what has no text: an
// unknown function of time, a number beyond double.
std::string program_text(const Scenario& scenario, const StateChoice& choice, ProgramLanguage language,
                         const std::string& name, const std::string& made_by);

}  // namespace anholon
