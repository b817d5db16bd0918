// When a floor begins to pull or rolling to need much friction, located on the Taylor polynomials.
#pragma once
#include <functional>
#include <optional>

#include "observe/floors/supports.h"
#include "observe/options.h"
#include "observe/report.h"
#include "result/rows.h"
#include "setup/scenario.h"

namespace anholon {

// By a motion of its own with an event where the force of the support passes zero downwards, up to the time `until`;
// the motion that is reported stays as it is. No time if that motion has no such event, nullopt if it stops before. `simulate`
// follows a motion.
using Follow = std::function<SimulationReport(const Scenario&, const SimulationOptions&, RowSink&)>;
std::optional<SupportWatch::Begin> first_pull(const Scenario& s, const SimulationOptions& o, const Support& support,
                                              double until, const Follow& simulate);

// The same for a formula of the model that passes zero in this direction. It has passed zero at `until`: the start of the motion if it does
// not do so on the way.
using FormulaOf = std::function<Expr(const Model&)>;
std::optional<double> first_passing(const Scenario& s, const SimulationOptions& o, const FormulaOf& formula,
                                    int direction, double until, const Follow& simulate);

}  // namespace anholon
