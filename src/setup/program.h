// Writes the motion of a prepared system as a program in C or Python, with its consistent initial state, inputs,
// outputs and events.
#pragma once
#include "setup/scenario.h"

namespace anholon {

struct RateFormulas;

enum class ProgramLanguage : std::uint8_t { c, python };

struct ProgramExtras {
  const RateFormulas* rates = nullptr;  // equations in independent velocities, for a function of their own in Python
  std::vector<std::size_t> switching = {};  // the parameters that decide which constraints hold
};

// Returns the text. `name`: the prefix of names in C; `made_by`: a line for the head of the text. Throws Failure if a
// part has no text: an unknown function of time, a number beyond double.
std::string program_text(const Scenario& scenario, const StateChoice& choice, ProgramLanguage language,
                         const std::string& name, const std::string& made_by, const ProgramExtras& extras = {});

}  // namespace anholon
