// The report of a run as JSON, and back: what `simulate --json` prints and what a result file keeps.  (doc/json.md)
//
// Numbers have all their digits: a report that is written and read is the same report.
#pragma once
#include <optional>

#include "base/json.h"
#include "observe/report.h"

namespace anholon {

// The report as one object.
std::string report_json(const SimulationReport& report);
// The report with the columns and rows of its run.
std::string run_json(const RunTable& rows, const SimulationReport& report);
// Returns nullopt if the text is no report of a run that has ended. A number that is not there is NaN.
std::optional<SimulationReport> read_report(const std::string& json);

// The keys of an error estimate, into an open object.
void write_error(JsonWriter& j, const ErrorReport& error);

}  // namespace anholon
