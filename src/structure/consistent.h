// Consistent initial data in stages: positions first, then velocities.
//
// What the user gave holds as given; what is missing is found from the constraints and the conditions
// by least change from the guess (0 where there is none) in the mass norm. Where the given values
// miss a constraint by no more than 1e-8 of its scale they are taken as rounded numbers and
// corrected by least change; by more, it is an error that names the constraint.
#pragma once
#include <memory>

#include "base/outcome.h"
#include "mechanics/mechanics.h"
#include "tape/tape.h"

namespace anholon {

// Where a value of the state came from.
enum class Origin : std::uint8_t { given, derived, chosen, guessed, corrected };
const char* name(Origin origin);

template <Number N>
struct InitialState {
  N t{0};
  std::vector<N> q, qd;
  std::vector<Origin> q_origin, qd_origin;
  N largest_correction{0};  // of values that were given
};

// Values that override those of the model: (order 0 or 1, coordinate) -> exact value.
struct StateOverride {
  unsigned order;
  std::size_t coordinate;
  Rational value;
};

template <Number N>
struct InitialProblem {
  const Mechanics* mechanics;
  std::vector<N> parameters;
  std::vector<StateOverride> overrides;
  std::optional<Rational> t;
};

template <Number N>
Outcome consistent_state(const InitialProblem<N>& problem, InitialState<N>& state);

// The constraints that are independent at the state, and those that follow from them there.
template <Number N>
RowChoice<N> independent_constraints(const Mechanics& m, const std::vector<N>& parameters,
                                     const InitialState<N>& state);

}  // namespace anholon
