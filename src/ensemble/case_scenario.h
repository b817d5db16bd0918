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
// Makes the scenario of a case, derived anew with its numbers in the form of the scenario of all cases. Exponents that
// are whole numbers become constants.
Outcome scenario_of_case(const Scenario& of_all, const EnsembleOptions& options, const EnsembleCase& numbers,
                         Scenario& scenario);
// Returns formulas of the reductions in the graph of a workspace; their exponents are replaced as those of the model
// are, unless they depend on one of the parameters `open`.
Column formulas_in(Workspace& workspace, const Column& formulas, const std::vector<std::size_t>& open);
// For a model whose own numbers, those of `scenario`, have no consistent start: replaces `scenario` by that of the
// first case that has one. Fails if none of the first cases has one.
Outcome scenario_of_cases(const EnsembleOptions& options, Scenario& scenario);

}  // namespace anholon
