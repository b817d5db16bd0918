// Cases of a sweep that stopped, by the way in which they ended.
#pragma once
#include <cstddef>
#include <map>
#include <string>

#include "base/outcome.h"

namespace anholon {

// Cases that ended in the same way; the first of them is told.
struct StoppedCases {
  std::size_t count = 0, first = 0;
  Outcome outcome;
};
using StoppedByKind = std::map<OutcomeKind, StoppedCases>;

// Counts a case that stopped; one that finished is left out.
void count_stopped(StoppedByKind& stopped, std::size_t number, const Outcome& outcome);

// Why cases stopped, in two sentences and a hint behind a line break.
std::string stopped_note(OutcomeKind kind, const StoppedCases& stopped);

// A list in JSON: outcome, cases, first, message, hint of each kind. A part keeps that of its cases as a note.
std::string stopped_json(const StoppedByKind& stopped);

}  // namespace anholon
