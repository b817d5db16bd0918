// The report of a run as JSON, and back. `simulate --json` prints it with the rows (result/json_run.h), and result files
// hold it.  (doc/json.md)
//
// Numbers have all their digits: a report that is written and read is the same report.
#pragma once
#include <optional>

#include "base/json.h"
#include "observe/report.h"

namespace anholon {

// The report as one object.
std::string report_json(const SimulationReport& report);
// Returns nullopt if the text is no report of a run that has ended. A number that is not there is NaN.
std::optional<SimulationReport> read_report(const std::string& json);

// Writes the keys of an error estimate into an open object.
void write_error(JsonWriter& j, const ErrorReport& error);

}  // namespace anholon
