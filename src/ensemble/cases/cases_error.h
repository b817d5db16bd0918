// Estimates the error and the residuals of an ensemble by further runs of some of its cases (theory: integrals,
// certificate).
#pragma once
#include "ensemble/case.h"

namespace anholon {

// The numbers of the cases that are compared: so few that they cost little beside many cases.
std::vector<std::size_t> cases_to_compare(std::size_t cases);

// Fills the error and the residuals of the report from the `results` of cases_to_compare(): each case is derived anew,
// compared with a sharper run, and computed by `simulate`, which checks its residuals along the whole motion. `each`
// calls a function with all numbers below a count, in parallel if it can. Cases that have not finished are left out,
// and long ones too if the estimate is for short runs.
using Each = std::function<void(std::size_t count, const std::function<void(std::size_t)>&)>;
void judge_cases(const Scenario& scenario, const EnsembleOptions& options, std::span<const CaseResult> results,
                 const Each& each, EnsembleReport& report);

}  // namespace anholon
