// Locates, on the Taylor polynomials, when a floor begins to pull or rolling to need much friction.
#pragma once
#include <functional>
#include <optional>

#include "observe/floors/supports.h"
#include "observe/options.h"
#include "observe/report.h"
#include "result/rows.h"
#include "setup/scenario.h"

namespace anholon {

// Computes another motion up to the time `until`, with an event where the force of the support passes zero downwards;
// the reported motion is not changed. The result has no time if that motion has no such event; it is nullopt if the
// motion stops before. `simulate` computes a motion.
using Follow = std::function<SimulationReport(const Scenario&, const SimulationOptions&, RowSink&)>;
std::optional<SupportWatch::Begin> first_pull(const Scenario& s, const SimulationOptions& o, const Support& support,
                                              double until, const Follow& simulate);

// Returns the time at which a formula of the model passes zero in this direction, in a motion up to `until`, by which
// it has passed. Returns the start of the motion if the formula does not pass zero on the way, nullopt if the motion
// stops before.
using FormulaOf = std::function<Expr(const Model&)>;
std::optional<double> first_passing(const Scenario& s, const SimulationOptions& o, const FormulaOf& formula,
                                    int direction, double until, const Follow& simulate);

}  // namespace anholon
