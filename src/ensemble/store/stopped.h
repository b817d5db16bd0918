// The cases of a sweep that stopped, by the kind of their outcome.
#pragma once
#include <cstddef>
#include <map>
#include <string>

#include "base/outcome.h"

namespace anholon {

// Cases that ended in the same way, with the first of them.
struct StoppedCases {
  std::size_t count = 0, first = 0;
  Outcome outcome;
};
using StoppedByKind = std::map<OutcomeKind, StoppedCases>;

// Counts a case that stopped; a finished one is not counted.
void count_stopped(StoppedByKind& stopped, std::size_t number, const Outcome& outcome);

// Returns the reason why cases stopped, in two sentences and a hint behind a line break.
std::string stopped_note(OutcomeKind kind, const StoppedCases& stopped);

// Returns a JSON list: outcome, cases, first, message, hint of each kind. A part contains that of its cases as a note.
std::string stopped_json(const StoppedByKind& stopped);

}  // namespace anholon
