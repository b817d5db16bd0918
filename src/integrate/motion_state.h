// What a stepper carries from step to step: the motion's state, and a record of the steps so far.
#pragma once
#include <array>
#include <vector>

#include "kernel/pivots.h"
#include "numeric/number.h"

namespace anholon {

// The point where the scaled system Jacobian J was least regular so far.
template <Number N>
struct LeastRegular {
  N sigma{1};  // its smallest singular value
  Wider<N> t{0};
  std::size_t unknown = 0;  // the unknown that J determined least there

  // `direction`: the unit vector that J maps to the shortest image at time `at`.
  void see(const N& value, const Wider<N>& at, const std::vector<N>& direction) {
    if (!(value < sigma)) return;
    sigma = value;
    t = at;
    for (std::size_t j = unknown = 0; j < direction.size(); ++j)
      if (abs(direction[j]) > abs(direction[unknown])) unknown = j;
  }
};

// The record of the steps so far.
template <Number N>
struct StepRecord {
  using W = Wider<N>;
  W branch_step{0};  // length of the last step that stayed on the branch of the solution
  std::size_t steps = 0;
  W worst_constraint{0}, worst_equation{0};
  N first_sigma{0};  // the first smallest singular value of the scaled system Jacobian
  LeastRegular<N> least_regular;
  N sigma_before{0};     // sigma where the last step began
  W last_step{0};        // the length of the last step
  N least_health{1};     // the least health of a kernel's pivots
  bool careful = false;  // the step that follows is made without a kernel
};

// Returns the record for a stepper that continues the motion with other equations. It leaves out lengths of steps,
// pivots and values of sigma, which belong to the old equations.
template <Number N>
StepRecord<N> with_other_equations(const StepRecord<N>& record);

// The motion at one time. The next steps depend on nothing else.
template <Number N>
struct MotionState {
  using W = Wider<N>;
  W t{0};
  std::vector<W> state;             // x_j^(k), k < d_j
  std::vector<W> carry;             // the round-off of its sums; empty if there is none
  std::vector<W> leading;           // a first guess of x_j^(d_j)
  std::vector<W> own, own_leading;  // the same in the unknowns of a kernel that has its own; else empty
  std::vector<W> integrals;         // of the quadratures, since the start
  std::vector<W> integral_carry;    // the round-off of their sums
  StepRecord<N> record;
};

// Returns a motion at its start, with no round-off carried and an empty record.
template <Number N>
MotionState<N> motion_from(const Wider<N>& t, const std::vector<Wider<N>>& state, const std::vector<Wider<N>>& leading,
                           std::size_t quadratures);

// The motion at the point where an expansion was begun: from here the same steps follow, bit by bit.
template <Number N>
struct StepperState {
  MotionState<N> motion;
  std::vector<N> direction;  // of the iteration for sigma
  std::vector<int> sides;    // of the series watched for events
};

// The motion of a stepper.
template <Number N>
struct MotionTrack {
  struct Begun {
    StepperState<N> at;
    bool by_kernel = false;
  };
  MotionState<N> now;
  // The states where the present expansion and the one before were begun.
  Begun& begun() { return expansions[present]; }
  const Begun& begun() const { return expansions[present]; }
  Begun& previous() { return expansions[1 - present]; }
  void begin_next() { present = 1 - present; }

  std::array<Begun, 2> expansions;
  std::size_t present = 0;
};

// A step shorter than this many round-offs of the time is a collapse.
inline constexpr int kCollapsedRoundoffs = 16;
// An ordinary step is longer than this, relative to the time.
inline constexpr double kShortStep = 2 * kCollapsedRoundoffs * 0x1p-53;

// The data of ordinary steps in the lanes of a kernel (lanes/ordinary_steps.h) that the stepper of the motion takes
// over.
struct OrdinaryCourse {
  struct Step {
    double to = 0, length = 0;
    double drift = 0;  // the largest of all steps so far, relative distances from the hidden constraints
  };
  Step before, last;  // the last two steps; before the first one `last.to` is where the motion is
  Pivots pivots;      // of the last expansion that has served
  double least_health = 0;
  std::size_t steps = 0;  // made
  // The number of steps that may be made without asking for budget and pace, and the steps of the budget beyond them.
  std::size_t most = 0, most_ahead = 0;
  // The step after the made ones: it is aimed, and the kernel is at its end.
  bool aimed = false;
  double end = 0, horizon = 0, drift = 0;
};

// A motion whose state grows beyond this blows up.
inline constexpr double kBlowUp = 1e100;

// Adds x to s and keeps the round-off in `carry`.
template <Number N>
void add_compensated(N& s, N& carry, const N& x) {
  const N y = x + carry, sum = s + y;
  carry = abs(s) >= abs(y) ? N(N(s - sum) + y) : N(N(y - sum) + s);
  s = sum;
}

template <Number To, Number From>
void convert_all(const std::vector<From>& from, std::vector<To>& to) {
  to.resize(from.size(), To(0));
  for (std::size_t i = 0; i < from.size(); ++i) to[i] = convert<To>(from[i]);
}

}  // namespace anholon
