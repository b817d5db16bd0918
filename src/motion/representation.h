// One system of equations, written in the way that takes a kernel the fewest operations.
//
// Each writing is the same equations by an identity (normal.h, arrange.h, or none at all), for the same unknowns with
// the same offsets. What it costs is counted on the kernel's plan, not measured: the choice depends on the equations
// and the state alone, so a run has the same bits wherever it is made or goes on. Rewriting happens in a graph of its
// own; the graph of the model stays as it is.
#pragma once
#include "kernel/kernel.h"

namespace anholon {

enum class Writing : std::uint8_t {
  derived,   // as the form gave them
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
  std::vector<std::string> velocities;  // of quasi: what p are, in words of the model
  bool clears_poles = false;            // constraints have poles, near which the other writings lose digits
};

// The equations as derived, and where their plan was made.
struct ToRepresent {
  std::shared_ptr<const KernelPlan> derived;
  const Structure& structure;
  std::span<const Expr> quadratures;
  std::vector<long double> parameters;
  double t;
  std::vector<double> state;
  const Mechanics* mechanics = nullptr;  // what the equations were derived from
};

// What a motion puts into its writing grows with its length: the steps saved have to pay for it.
enum class WritingEffort : std::uint8_t {
  at_once,  // paired, rates, quasi
  long_motion,
  very_long_motion,  // arranged
};
inline constexpr WritingEffort kWritingEfforts[] = {WritingEffort::at_once, WritingEffort::long_motion,
                                                    WritingEffort::very_long_motion};
// After how many steps a motion makes it: about as long as the steps took by then.
std::size_t steps_before(WritingEffort effort);
WritingEffort effort_after(std::size_t steps);
// How many steps more it lasts after so many.
std::size_t steps_with_effort(std::size_t steps);

// All that can be had with that effort, the derived one first. Where solutions have to be refined, equations that are
// written out would lose the digits that refinement saves: there, and where a kernel has to know the slots of the
// derived tape, others are left out.
std::vector<Representation> representations(const ToRepresent& equations, WritingEffort effort);
// The writing in quasi-velocities, for one who evaluates rates and makes no steps: unlike in the list, a kernel does not have
// to know the slots of the derived tape. Returns nullopt if the equations have none; `why` then says the reason, a clause in
// words of the model.
std::optional<Representation> in_independent_velocities(const ToRepresent& equations, std::string& why);
// Adds to those that can be had at once what more effort finds.
void add_representations(const ToRepresent& equations, WritingEffort effort, std::vector<Representation>& list);
// The first of the cheapest of those that clear poles, if any does; else of all.
const Representation& cheapest(const std::vector<Representation>& list);
// … of those in the motion's own unknowns.
const Representation& cheapest_unmapped(const std::vector<Representation>& list);

// Operations of one expansion, by kind.
struct ExpansionWork {
  std::size_t products = 0, sums = 0, solve = 0;  // convolutions; terms of sums per order; operations on one right side
  double operations = 0;
  int waits = 0;     // operations of a stage, one after the other
  double total = 0;  // cost of a motion alone
};
ExpansionWork work_of(const KernelPlan& plan);

}  // namespace anholon
