// Integrals of the motion that follow from the form of the model, each with its proof (theory: integrals).
//
// Energy: h + U is constant if every force is one of
//   a potential free of t, uniform or homogeneous gravity, a constant or homogeneous force, a force without power,
//   V^O' and V^omega of an observer with constant a0 and omega, a reaction without power (theory: certificate),
// masses are constant and T is free of t. By the power identity d(h + U)/dt = 0.
//
// Momenta: for a field xi_a(q) the quantity p = sum xi_a dT/dq_a' has
//   dp/dt = sum xi_a (dT/dq_a + G_a + sum mdot dp_a/dm) + sum xi_a' p_a + sum_r lambda_r sum_a Phi_ra xi_a,
// (if the observer rotates, with dT/dq' + sum m (omega x rho).drho/dq for dT/dq' and its rate added), so p is constant
// if the first two sums cancel and xi is admissible, Phi xi = 0, for every constraint. The search covers fields affine
// in q, which include cyclic coordinates, translations and rotations of the whole or of parts. Candidates are found by
// linear algebra at random points; each result is proved by the exact zero test.
//
// The proofs hold where all formulas have derivatives. A continuous integral stays constant at kinks; one that may
// jump, such as an energy whose potential has a sign(x), is marked.
#pragma once
#include "mechanics/mechanics.h"

namespace anholon {

struct Conserved {
  std::string name;     // "energy", "Jacobi integral", "momentum of phi", "momentum along -y*d/dx + x*d/dy + d/dpsi"
  std::string because;  // in words
  Expr value;           // masses substituted
  Column terms;         // the terms of the sum
  bool jumps = false;   // the value may change where a formula in it jumps, and is constant between the jumps
  // For a momentum: the coordinates that determine its unit, J*s*[by]/[along]; nullopt if no component determines it.
  std::optional<std::size_t> along, by;
};

std::vector<Conserved> conserved(const Mechanics& m);

// Returns the unit of the integral if the units of the coordinates determine it; else empty. In a model without units
// the result is empty.
std::string unit_of(const Model& model, const Conserved& c);

// The handles of an integral (expr/handles.h).
void for_each_expression(Conserved& c, const ExprVisitor& f);

// For tests: dp/dt or d(h + U)/dt along motions by the right sides above, without multipliers; zero for the integrals
// that `conserved` returns.
Expr momentum_rate(const Mechanics& m, const Column& field);

}  // namespace anholon
