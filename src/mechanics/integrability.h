// Finds the constraints on velocities that are equivalent to constraints on positions (theory: integrability).
//
// Constraints of order 1 that are linear in the velocities are Pfaffian forms on the space of (q, t),
//
//   w_r = sum_a A_ra dq_a + b_r dt        on the space of q alone, if b = 0 and nothing depends on t.
//
// Let I be their span, taken together with the differentials of the holonomic constraints. Its derived flag
//
//   I = I^(0) > I^(1) > …,   I^(k+1) = { w in I^(k) : dw = 0 mod I^(k) }
//
// ends at a stable dimension p: there are p independent functions with df in I, and no more (Frobenius). Then f(q, t) =
// const along every motion. A form may be integrable together with others, but not alone.
//
// The flag is found by its dual: I^(k) annihilates D^(k), D^(0) = ker I, D^(k+1) = D^(k) + [D^(k), D^(k)]. The
// independence of brackets is decided with numbers of 60 digits at a point; this decides which combinations are NOT
// integrable. Integrability is proved: X f = 0 as an identity for all X of a basis of ker I, or dw = 0 mod I^(p) if no
// elementary f is found.
//
// A state of the model whose rate depends on time and such states alone counts as a function of time. If a constraint
// holds a state with another rate, nothing is decided.
//
// HYPOTHESIS: ranks are generic, those of a random point near the state.
#pragma once
#include <optional>

#include "mechanics/mechanics.h"
#include "tape/point.h"

namespace anholon {

// A combination of constraints that is integrable.
struct IntegrableCombination {
  Column coefficients;           // for each constraint of the model; 0 for those that take no part
  std::optional<Expr> integral;  // f(q, t) = const; nullopt if no elementary f is found
};

struct Integrability {
  std::vector<std::size_t>
      constraints;        // the constraints examined; they are independent of each other and of the holonomic ones
  bool time = false;      // t counts as a coordinate
  std::vector<int> flag;  // dimensions of I^(0), I^(1), …, without holonomic constraints; the last one is p
  std::vector<IntegrableCombination> combinations;  // p of them
  bool proved = true;                               // the integrability is proved; else it is only numerical
  // the result holds for the given values of the parameters, not for all values
  bool these_values = false;
  std::string undecided;  // why it is only known that at most flag.back() are integrable; else empty

  int integrable() const { return flag.empty() ? 0 : flag.back(); }
};

// `linear`: the constraints of order 1 that are linear or affine in the velocities. `near`: values of q and t near
// which the constraints are defined.
Integrability integrability(const Mechanics& mechanics, const std::vector<std::size_t>& linear, PointValues& near);

}  // namespace anholon
