// Writes the report of a run as JSON, and reads it. `simulate --json` prints it with the rows (result/json_run.h), and
// result files contain it (doc/json.md).
//
// Numbers have all their digits: writing a report and reading it gives the same report.
#pragma once
#include <optional>

#include "base/json.h"
#include "observe/report.h"

namespace anholon {

// Returns the report as one object.
std::string report_json(const SimulationReport& report);
// Returns nullopt if the text is not the report of a run that has ended. A missing number is NaN.
std::optional<SimulationReport> read_report(const std::string& json);

// Returns the events of a report as an array, and reads them.
std::string events_json(const std::vector<EventReport>& events);
std::vector<EventReport> read_events(const std::string& json);

// Writes the keys of an error estimate into an open object.
void write_error(JsonWriter& j, const ErrorReport& error);

}  // namespace anholon
