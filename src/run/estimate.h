// The global error of a run, by a second and sharper one: in wider numbers where there are any, at a tolerance 100 times smaller
// and two orders higher. The two are compared at times all along the run, in every position and velocity, relative to 1 + |x|.
// A motion that forgets its start (a double pendulum after long) shows as digits lost.
#pragma once
#include "run/motion.h"
#include "run/simulate.h"

namespace anholon {

// A state of the run at a time.
template <Number W>
struct Sample {
  W t{0};
  std::vector<W> values;  // q, q', … of all coordinates, below those solved for
};
template <Number W>
std::vector<W> sampled(const Scenario& s, const Program& program, const Expansion<W>& point);

// N: the numbers of the run. Fills `error`, or `no_error`.
template <Number N>
void estimate_error(const Scenario& scenario, const SimulationOptions& options, const std::vector<Sample<Wider<N>>>& samples,
                    SimulationReport& report);

}  // namespace anholon
