// Kinetic quantities and generalized forces of a model, by weighted points (theory: weighted-points, forces).
//
// All masses here are frozen symbols mu: a total derivative of T, S, V is the frozen derivative D/Dt of the papers.
// After the last differentiation put_masses substitutes m(t, q, q'). mdot inside QR is the full total derivative of the
// mass.
#pragma once
#include "model/loads.h"

namespace anholon {

// A particle, a mass centre, or an axis vector of a body (weight e_k, dimensionless).
struct WeightedPoint {
  Expr weight;         // frozen mass or axis weight
  Vector place;        // rho (or the axis vector u_k)
  bool uniform_field;  // true if a0 and gravity act on it: for mass points, not for axes
  std::size_t body;
  Expr speed2, acceleration2;  // |v|^2, |a|^2
};

struct Mechanics {
  const Model* model = nullptr;
  std::vector<WeightedPoint> points;
  Column q, qd, qdd;

  Expr T;        // T_r = sum 1/2 m |v|^2, relative velocities
  Expr S;        // S_r = sum 1/2 m |a|^2
  Expr V_O;      // M a0 . rho_c
  Expr V_omega;  // -1/2 sum m |omega x rho|^2

  Column Q;              // given forces, gravity, -dV/dq
  Column QR;             // mdot u
  Column QD;             // -dR/dq' of the dissipation functions R
  Column Qomega;         // -m (omega' x rho): the omega' term only
  Column minus_dVO;      // -dV_O/dq
  Column minus_dVomega;  // -dV_omega/dq
  Column Gamma;          // -2 m omega x v

  Column phi;               // constraints
  std::vector<int> order;   // m of each constraint
  std::vector<Column> Phi;  // dphi/dq^(m), one row per constraint
  Column lambda;            // multipliers
  Column N;                 // sum lambda Phi

  Graph& graph() const { return *model->graph; }
};

Mechanics mechanics(const Model& model);

// The handles of the mechanics (expr/handles.h), without those of its model.
void for_each_expression(Mechanics& m, const ExprVisitor& f);

// Returns Q + QR + QD + Qomega - d(V_O + V_omega)/dq + Gamma: the given and the inertial forces.
Column forces(const Mechanics& m);

// Returns the partial derivative by explicit time, with coordinates, velocities and masses held; unknown given
// functions f(t), states and inputs count as explicit time.
Expr by_time(Expr e);

// Energy and its rate, with masses substituted (theory: certificate).
struct Power {
  Expr h;           // q' dT/dq' - T
  Expr noncons;     // right side of the power identity without the constraints
  Expr constraint;  // P_c = sum lambda Phi q'
  Expr dh_dt;       // the total derivative of h, for comparison
};
Power power(const Mechanics& m);

// Returns d^2 T / dq' dq' row by row, masses substituted.
std::vector<Column> mass_matrix(const Mechanics& m);

// Returns Newton's left side sum m a . drho/dq, computed from the points themselves, independently of T and S. Second
// derivatives of the model's states are those of their rates.
Column newton_left_side(const Mechanics& m);

}  // namespace anholon
