// Facts about a system before it is computed: the effects of its constraints, the freedom that they leave, and the
// requirements of the structure.
#pragma once
#include "mechanics/integrability.h"
#include "setup/scenario.h"
#include "structure/blocks.h"

namespace anholon {

// The hypothesis on the reactions of a constraint (theory: routh).
enum class Hypothesis : std::uint8_t {
  dalembert,  // order 0, or linear in the velocities: d'Alembert's and Lagrange's principle
  chetaev,    // nonlinear in the velocities: Chetaev's rule
  niu,        // order 2 and more: the same rule for q^(m), a postulate
};
const char* name(Hypothesis h);

struct ConstraintFacts {
  Hypothesis hypothesis = Hypothesis::dalembert;
  // The factor of lambda in the power, on the constraint; 0: the constraint does no work.
  Expr power_factor;
  // If redundant at the initial state: the constraints of which it is a combination.
  std::vector<std::size_t> follows_from;
};

struct Explanation {
  std::vector<ConstraintFacts> constraints;
  Integrability integrability;
  // The dimension of the set of positions that can be reached; nullopt without a structure, or if constraints that are
  // nonlinear in the velocities or of order 2 and more may reduce it.
  std::optional<int> accessible;
  std::vector<Block> blocks;  // both empty without a structure
  std::vector<HiddenConstraint> hidden;
};

// Returns one entry for each constraint of the model, in its order; the expressions are in the graph of the workspace.
std::vector<ConstraintFacts> constraint_facts(Workspace& scenario);

// Returns the explanation, whose expressions are in the graph of the workspace.
Explanation explain(Workspace& scenario);

}  // namespace anholon
