// Which constraints on velocities are constraints on positions in disguise (theory: integrability).
//
// Constraints of order 1 that are linear in the velocities are Pfaffian forms on the space of (q, t),
//
//   w_r = sum_a A_ra dq_a + b_r dt        on that of q alone, where b = 0 and nothing depends on t.
//
// Let I be their span, taken together with the differentials of the holonomic constraints. Its derived flag
//
//   I = I^(0) > I^(1) > …,   I^(k+1) = { w in I^(k) : dw = 0 mod I^(k) }
//
// ends at a stable dimension p: there are p independent functions with df in I, and no more (Frobenius). Then f(q, t) =
// const along every motion. A form may be integrable with the others and not alone.
//
// The flag is found by its dual: I^(k) annihilates D^(k), D^(0) = ker I, D^(k+1) = D^(k) + [D^(k), D^(k)]. That
// brackets are independent is seen by numbers of 60 digits at a point, which settles what is NOT integrable. What is
// called integrable is proved: X f = 0 as an identity for all X of a basis of ker I, or dw = 0 mod I^(p) where no
// elementary f was found.
//
// HYPOTHESIS: ranks are generic, those of a random point near the state.
#pragma once
#include <optional>

#include "mechanics/mechanics.h"
#include "tape/point.h"

namespace anholon {

// A combination of constraints that is integrable.
struct IntegrableCombination {
  Column coefficients;           // of each constraint of the model; 0 for those that take no part
  std::optional<Expr> integral;  // f(q, t) = const; nothing if no elementary one was found
};

struct Integrability {
  std::vector<std::size_t>
      constraints;        // that were looked at and are independent of each other and of the holonomic ones
  bool time = false;      // t counts as a coordinate
  std::vector<int> flag;  // dimensions of I^(0), I^(1), …, holonomic constraints not counted; the last one is p
  std::vector<IntegrableCombination> combinations;  // p of them
  bool proved = true;                               // what is called integrable is; else it only seems so by numbers
  bool these_values = false;                        // it holds for the values of the parameters and not for all
  std::string undecided;  // why nothing more is said than that no more than flag.back() are integrable; else empty

  int integrable() const { return flag.empty() ? 0 : flag.back(); }
};

// `linear`: the constraints of order 1 that are linear or affine in the velocities. `near`: values of q and t near
// which the constraints are defined.
Integrability integrability(const Mechanics& mechanics, const std::vector<std::size_t>& linear, PointValues& near);

}  // namespace anholon
