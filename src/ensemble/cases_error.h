// The error of the results of an ensemble, by sharper runs of some of its cases.  (theory: integrals)
#pragma once
#include "ensemble/case.h"

namespace anholon {

// The numbers of the cases that are compared: a few, which cost little beside many cases.
std::vector<std::size_t> cases_to_compare(std::size_t cases);

// `results`: of cases_to_compare(); `each` calls a function with all numbers below a count, side by side if it can.
// Those that have not finished are left out, and so are long ones where short runs are asked for.
using Each = std::function<void(std::size_t count, const std::function<void(std::size_t)>&)>;
CasesError cases_error(const Scenario& scenario, const EnsembleOptions& options, std::span<const CaseResult> results,
                       const Each& each);

}  // namespace anholon
