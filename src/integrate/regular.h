// Whether the system Jacobian J stays regular between two points of a motion (theory: taylor).
//
// Where leading derivatives enter nonlinearly, solutions of the equations may meet where J is singular, and the Taylor
// polynomial would go straight on from one to another: `near` says that J is regular on all of the way. The polynomial
// may also carry a motion across a singular point of any system: a linkage that folds flat, a multiplier that makes the
// inertia vanish. The motion beyond is one of several: `crossed` says that there was such a point.
#pragma once
#include "program/expansion.h"

namespace anholon {

// With A = J0^-1 (J1 - J0) of spectral radius below 1 every J on the line from J0 to J1 is regular. True if the radius,
// estimated by the norm of the balanced A^8, is at most 1/2.
template <Number N>
bool near(const Expansion<N>& p0, const Expansion<N>& p1);

// The unit direction v that J shows least, J v, the reactions of the multipliers in v, and the smallest scaled singular
// value.
template <Number N>
struct Mode {
  std::vector<N> v, image, reaction;
  N sigma{0};
};
// REQUIRES: at.smallest_singular_value() has been asked for; it is `sigma`.
template <Number N>
Mode<N> weakest_mode(const Expansion<N>& at, const N& sigma);

// While v keeps its direction, J v or the reactions change theirs: a singular value, or a combination of the rows of
// Phi, has passed zero in between.
template <Number N>
bool crossed(const Mode<N>& a, const Mode<N>& b, std::size_t coordinates);

}  // namespace anholon
