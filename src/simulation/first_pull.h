// When a support begins to pull, located on the Taylor polynomials.
#pragma once
#include <functional>
#include <optional>

#include "observe/options.h"
#include "observe/report.h"
#include "observe/supports.h"
#include "result/rows.h"
#include "setup/scenario.h"

namespace anholon {

// By a motion of its own with an event where the force of the support passes zero downwards, up to the time `until`;
// the motion that is reported stays as it is. nullopt if that motion has no such event. `simulate` follows a motion.
using Follow = std::function<SimulationReport(const Scenario&, const SimulationOptions&, RowSink&)>;
std::optional<double> first_pull(const Scenario& s, const SimulationOptions& o, const Support& support, double until,
                                 const Follow& simulate);

}  // namespace anholon
