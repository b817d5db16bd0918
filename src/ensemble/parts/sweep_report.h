// The report of a sweep that a file contains beside the cases.
#pragma once
#include <string>

#include "ensemble/case.h"
#include "ensemble/store/stopped.h"

namespace anholon {

// The report of cases from a folder, whose judgement is a text.
struct CollectedReport {
  StoppedByKind stopped;
  std::string judgement;  // empty if there is none
  std::size_t cases = 0, finished = 0;
  std::map<std::string, std::size_t> events;  // finished cases by the event that ended them
};
std::string sweep_report_json(const CollectedReport& report);

// Returns a JSON object: stopped, error_estimate, residuals, cases, finished, events, outcome (doc/json.md).
std::string sweep_report_json(const StoppedByKind& stopped, const EnsembleReport& report);

}  // namespace anholon
