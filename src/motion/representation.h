// Writes one system of equations in the way that takes a kernel the fewest operations.
//
// Each writing has the same equations by an identity (normal.h, arrange.h, or none), for the same unknowns with the
// same offsets. Its cost is counted on the kernel's plan, not measured: the choice depends on the equations and the
// state alone, so a run has the same bits wherever it is made or resumed. Rewriting happens in a graph of its own; the
// graph of the model is not changed.
#pragma once
#include "kernel/kernel.h"

namespace anholon {

enum class Writing : std::uint8_t {
  derived,   // unchanged, as derived from the form
  paired,    // with products of common pairs (tape.h)
  rates,     // total derivatives left to the series (by_rates.h), paired
  quasi,     // in quasi-velocities (quasi_velocities.h), paired: the kernel has unknowns of its own
  expanded,  // as reduced sums of monomials, paired
  arranged,  // common factors in front, paired
};
const char* name(Writing writing);

struct Representation {
  Writing writing = Writing::derived;
  std::shared_ptr<const KernelPlan> plan;
  std::vector<std::string> velocities;  // for `quasi`: the quasi-velocities p, in words of the model
  bool clears_poles = false;            // constraints have poles, near which the other writings lose digits
};

// The equations as derived, and the point where their plan was made.
struct ToRepresent {
  std::shared_ptr<const KernelPlan> derived;
  const Structure& structure;
  std::span<const Expr> quadratures;
  std::vector<long double> parameters;
  double t;
  std::vector<double> state;
  const Mechanics* mechanics = nullptr;  // from which the equations were derived
};

// The effort that a motion puts into its writing grows with its length: the time saved has to pay for it.
enum class WritingEffort : std::uint8_t {
  at_once,  // paired, rates, quasi
  long_motion,
  very_long_motion,  // arranged
};
inline constexpr WritingEffort kWritingEfforts[] = {WritingEffort::at_once, WritingEffort::long_motion,
                                                    WritingEffort::very_long_motion};
// The number of steps after which a motion makes the effort: these steps took about as long as the effort does.
std::size_t steps_before(WritingEffort effort);
WritingEffort effort_after(std::size_t steps);
// The number of further steps after `steps` until the effort changes.
std::size_t steps_with_effort(std::size_t steps);

// Returns all writings that this effort finds, the derived one first. Other writings are left out if solutions have to
// be refined, because equations that are written out would lose the digits that refinement saves, and if a kernel has
// to know the slots of the derived tape.
std::vector<Representation> representations(const ToRepresent& equations, WritingEffort effort);
// Returns the writing in quasi-velocities, for code that evaluates rates and makes no steps: unlike in
// representations(), the kernel does not have to know the slots of the derived tape. Returns nullopt if the equations
// have none; `why` is then the reason, a clause in words of the model.
std::optional<Representation> in_independent_velocities(const ToRepresent& equations, std::string& why);
// Adds the writings that more effort finds to those that are found at once.
void add_representations(const ToRepresent& equations, WritingEffort effort, std::vector<Representation>& list);
// Returns the first of the cheapest writings: of those that clear poles, if any does; otherwise of all.
const Representation& cheapest(const std::vector<Representation>& list);
// Returns the first of the cheapest writings in the motion's own unknowns.
const Representation& cheapest_unmapped(const std::vector<Representation>& list);

// Operations of one expansion, by kind.
struct ExpansionWork {
  std::size_t products = 0, sums = 0, solve = 0;  // convolutions; terms of sums per order; operations on one right side
  double operations = 0;
  int waits = 0;     // operations of a stage that follow each other
  double total = 0;  // cost of a motion alone
};
ExpansionWork work_of(const KernelPlan& plan);

}  // namespace anholon
