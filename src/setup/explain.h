// What is to be known of a system before it is computed: what its constraints do, what they leave free, and what the
// structure asks for.
#pragma once
#include "mechanics/integrability.h"
#include "setup/scenario.h"
#include "structure/blocks.h"

namespace anholon {

// What is supposed of the reactions of a constraint (theory: routh).
enum class Hypothesis : std::uint8_t {
  dalembert,  // order 0, or linear in the velocities: d'Alembert's and Lagrange's principle
  chetaev,    // nonlinear in the velocities: Chetaev's rule
  niu,        // order 2 and more: the same rule for q^(m), a postulate
};
const char* name(Hypothesis h);

struct ConstraintFacts {
  Hypothesis hypothesis = Hypothesis::dalembert;
  Expr power_factor;                      // of lambda, on the constraint; 0: does no work
  std::vector<std::size_t> follows_from;  // if redundant at the initial state: the constraints that it is made of
};

struct Explanation {
  std::vector<ConstraintFacts> constraints;
  Integrability integrability;
  // Of the positions that can be reached; nothing without a structure, or where constraints that are nonlinear in the
  // velocities or of order 2 and more may take some away.
  std::optional<int> accessible;
  std::vector<Block> blocks;  // both empty without a structure
  std::vector<HiddenConstraint> hidden;
};

// One entry for each constraint of the model, in its order; the expressions are those of the workspace.
std::vector<ConstraintFacts> constraint_facts(Workspace& scenario);

// Its expressions are those of the workspace.
Explanation explain(Workspace& scenario);

}  // namespace anholon
