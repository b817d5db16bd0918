// The quantities from which a form's equations are built, each with its name: the lines that `derive --steps` prints
// before the equations.
//
// A form lists the quantities that its own equation names, in the order of a computation by hand. The quantities common
// to all forms are listed elsewhere: the generalized forces, the constraints, and the substitutions of the elimination.
#pragma once
#include <initializer_list>

#include "formulation/label.h"

namespace anholon {

struct Quantity {
  Label name;
  Expr value;
};
using Quantities = std::vector<Quantity>;

// Joins the lists in order. Their elements are created in this order as well.
Quantities listed(std::initializer_list<Quantities> lists);

Quantities named(const Label& name, Expr value);
// Names all entries, including zeros.
Quantities named(const Labels& names, const Column& values);
// Names d of/d by, without zeros.
Quantities partials(const Labels& of, const Labels& by, const Rows& values);
// Names d/dt d of/d by, without zeros.
Quantities rates_of_partials(const Labels& of, const Labels& by, const Rows& values);

// Names D/Dt of each quantity, with these values.
Quantities frozen_rates(const Quantities& of, const Column& values);

// These name F with its derivatives by q^(k), and the derivatives alone.
Quantities with_partials(const Mechanics& M, const Label& name, Expr F, unsigned k);
Quantities partials_of(const Mechanics& M, const Label& name, Expr F, unsigned k);

// The operators of operators.h: T, the frozen momenta dT/dq' and their rates D/Dt, dT/dq  [L 2.7]
Quantities of_lagrange(const Mechanics& M);
// T^(m-1), its derivatives by q^(m) with their rates, and by q^(m-1)  [L 3.10]
Quantities of_nielsen(const Mechanics& M, unsigned m);
// T^(m) and T^(m-1) with their derivatives by q^(m) and q^(m-1), dT/dq  [N 3.1]
Quantities of_micevic_rusov(const Mechanics& M, unsigned m);
// T^(m) with its derivatives by q^(m), dT/dq  [N 5.1]
Quantities of_mangeron_deleanu(const Mechanics& M, unsigned m);
// S with its derivatives by q''
Quantities of_appell(const Mechanics& M);

// Quantities that the forms without multipliers share.
//
// Names F with the dependent derivatives substituted: T~, S~, T*, S*.
Quantities reduced(const Elimination& E, const Label& name, Expr F);
// dF/dq_b^(k) of the dependent coordinates, F not reduced.
Quantities dependent_partials(const Mechanics& M, const Elimination& E, const Label& name, Expr F, unsigned k);
// df_b/dq_nu^(m-1), d/dt df_b/dq_nu^(m) and df'_b/dq_nu^(m), where q_b^(m) = f and q_b^(m+1) = f'.
Quantities f_by_lower(const Mechanics& M, const Elimination& E);
Quantities rates_of_f_by_u(const Mechanics& M, const Elimination& E);
Quantities f_rate_by_u(const Mechanics& M, const Elimination& E);
// Returns labels of the velocities (or the quantity `of`) of all weighted points, component by component: v.NAME.x; for
// the axes of a body v.NAME.1.x.
Labels point_labels(const Mechanics& M, const Label& of);
// sum_s G_s B_sa, the forces along the constraints: G.x, G.u1
Quantities forces_along(const Mechanics& M, const Elimination& E);
// Names the same contraction of any column of forces.
Quantities along(const Mechanics& M, const Elimination& E, const Label& of, const Column& X);

}  // namespace anholon
