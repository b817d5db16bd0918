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

// A list in JSON: outcome, cases, first, message, hint of each kind. A part keeps that of its cases as a note.
std::string stopped_json(const StoppedByKind& stopped);
// Adds the cases of such a list. Throws Failure without a place if the text is none.
void add_stopped(StoppedByKind& all, const std::string& json);

// The report of cases that are collected from a folder, whose judgement is a text.
struct CollectedReport {
  StoppedByKind stopped;
  std::string judgement;  // empty if there is none
  std::size_t cases = 0, finished = 0;
};
std::string sweep_report_json(const CollectedReport& report);

// A JSON object: stopped, error_estimate, residuals, cases, finished, outcome. (doc/json.md)
std::string sweep_report_json(const StoppedByKind& stopped, const EnsembleReport& report);

}  // namespace anholon
