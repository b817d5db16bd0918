// A case as a single motion: its options, and its scenario, the model with the numbers of the case.
#pragma once
#include "ensemble/case.h"

namespace anholon {

// The parameters that are varied, by their index.
std::vector<std::size_t> varied_parameters(const EnsembleOptions& options);
// The initial values that are given or varied; without `numbers`, the varied ones are zero.
std::vector<StateOverride> overrides_of(const EnsembleOptions& options, const EnsembleCase* numbers);
// The options with which `simulate` computes a case, as far as they are common to all ways of computing it.
SimulationOptions options_of_case(const EnsembleOptions& options, const EnsembleCase& numbers);
// Returns formulas of reductions in the graph of a workspace. Multipliers of constraints that parameters switch become
// those of the workspace, or zeros. Exponents are replaced as those of the model are, unless they depend on one of the
// parameters `open`.
Column formulas_in(Workspace& own, const Column& formulas, const EnsembleOptions& options,
                   const std::vector<std::size_t>& open);
// Makes the scenario of a case, derived anew with its numbers in the form of the scenario of all cases. Exponents that
// are whole numbers become constants.
Outcome scenario_of_case(const Scenario& of_all, const EnsembleOptions& options, const EnsembleCase& numbers,
                         Scenario& scenario);
// For a model whose own numbers, those of `scenario`, have no consistent start: replaces `scenario` by that of the
// first case that has one. If none of the first cases has one as long as exponents may vary, every case is made anew;
// so it has an outcome of its own.
void scenario_of_cases(EnsembleOptions& options, Scenario& scenario);

}  // namespace anholon
