// Chooses the form of the equations with which a motion takes the fewest operations, and counts the operations of each
// form.
//
// Operations are counted, not measured, at the order of tolerance 1e-12, so that the result depends on the model and
// its initial state alone. Forms without multipliers eliminate anew where a pivot becomes small and recover lambda for
// every row: they are chosen if they save enough to pay for that.
#pragma once
#include <memory>

#include "motion/representation.h"
#include "setup/scenario.h"

namespace anholon {

struct WritingCost {
  Writing writing;
  ExpansionWork work;
  std::optional<std::size_t> after;  // the number of steps after which a motion takes this writing
  std::vector<std::string> velocities;
  bool clears_poles = false;  // such a writing is taken at any cost
};

struct FormCost {
  const Formulation* form = nullptr;
  std::vector<WritingCost> writings;  // empty if no kernel computes the motion
  double total = 0;                   // the cost of a long motion
  std::string why;                    // the reason why no kernel computes the motion
};
FormCost cost_of(const Scenario& scenario, const StateChoice& choice,
                 WritingEffort most = WritingEffort::very_long_motion);

struct FormChoice {
  std::vector<FormCost> costs;  // Routh's first
  const Formulation* form = nullptr;
  std::string why;
};
// Counting may take longer than the motion: with where_needed it is left out if something else decides.
enum class Costs : std::uint8_t { where_needed, all };
FormChoice choose_form(const std::shared_ptr<const Model>& model, const StateChoice& choice,
                       Costs costs = Costs::where_needed);

}  // namespace anholon
