// Generations of cases at the borders between outcomes (doc/sweeps.md).
//
// The first generation of a sweep is its grid. When all cases of a folder are there, the next generation halves the
// cells of the grid at whose edges two neighbours ended in different ways. Its points depend on the earlier cases
// alone, so any process plans the same generation.
#pragma once
#include <string>

#include "ensemble/store/sweep_store.h"
#include "ensemble/variation.h"

namespace anholon {

// There is a border where outcomes differ, or the events that ended the motions, or the numbers of a column by more
// than a bound, if there is a column.
struct RefineRule {
  std::string column;
  double bound = 0;
  std::string text() const;  // COLUMN:BOUND, empty without a column
};

// Reads COLUMN:BOUND. Throws MistakeInWord.
RefineRule refine_rule(const std::string& word);

// Throws Failure without a place if the variation is no grid of ascending or descending values, or if the columns do
// not define a border.
void must_be_refinable(const Variation& variation, const std::vector<std::string>& columns, const RefineRule& rule);

// Throws Failure without a place if a generation of the folder was planned by another rule.
void must_go_on(const SweepStore& store, const RefineRule& rule);

// Plans the next generation in a folder in which no part is missing. Returns the number of its cases, 0 if there is no
// border. Throws Failure without a place if an earlier generation followed another rule or was changed, a part is
// damaged, or the plan cannot be written.
std::size_t add_generation(SweepStore& store, const Variation& variation, const RefineRule& rule);

// The numbers of all cases of a folder. The variation has to outlive the function.
std::function<EnsembleCase(std::size_t)> numbers_of(const SweepStore& store, const Variation& variation);

}  // namespace anholon
