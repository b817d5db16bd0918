// Which form of the equations makes a motion with the fewest operations, and what each of them costs.
//
// Counted, not measured, at the order of tolerance 1e-12, so that the answer depends on the model and its initial state
// alone. Forms without multipliers eliminate anew where a pivot becomes small and recover lambda for every row: they
// are taken where they save enough to pay for that.
#pragma once
#include <memory>

#include "motion/representation.h"
#include "setup/scenario.h"

namespace anholon {

struct WritingCost {
  Writing writing;
  ExpansionWork work;
  std::optional<std::size_t> after;  // so many steps a motion takes it
  std::vector<std::string> velocities;
  bool clears_poles = false;  // such a writing is taken whatever it costs
};

struct FormCost {
  const Formulation* form = nullptr;
  std::vector<WritingCost> writings;  // empty: `why`
  double total = 0;                   // of a long motion
  std::string why;                    // no kernel computes its motion
};
FormCost cost_of(const Scenario& scenario, const StateChoice& choice,
                 WritingEffort most = WritingEffort::very_long_motion);

struct FormChoice {
  std::vector<FormCost> costs;  // Routh's first
  const Formulation* form = nullptr;
  std::string why;
};
// Counting takes longer than many a motion: it is left out where something else decides, unless it is to be shown.
enum class Costs : std::uint8_t { where_needed, all };
FormChoice choose_form(const std::shared_ptr<const Model>& model, const StateChoice& choice,
                       Costs costs = Costs::where_needed);

}  // namespace anholon
