// The report that a file of a sweep holds beside the cases.
#pragma once
#include <map>
#include <string>

#include "ensemble/case.h"

namespace anholon {

// Cases that ended in the same way; the first of them is told.
struct StoppedCases {
  std::size_t count = 0, first = 0;
  Outcome outcome;
};
using StoppedByKind = std::map<OutcomeKind, StoppedCases>;

// Counts a case that stopped; one that finished is left out.
void count_stopped(StoppedByKind& stopped, std::size_t number, const Outcome& outcome);

// A JSON object: stopped, error_estimate, residuals, cases, finished, outcome. (doc/json.md)
std::string sweep_report_json(const StoppedByKind& stopped, const EnsembleReport& report);

}  // namespace anholon
