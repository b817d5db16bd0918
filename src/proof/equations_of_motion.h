// The motion as equations: the constraints with their derivatives, Routh's equations [L 2.7], and points at which all
// of them hold. Rates replace the derivatives of states.
//
// At order k = 0, 1, 2, …, h the constraints' derivatives of order k are solved for some of the q^(k); from k = 2 on
// together with Routh's equations, differentiated k - 2 times, for q^(k) and lambda^(k-2).
#pragma once
#include <optional>
#include <unordered_map>

#include "mechanics/mechanics.h"
#include "proof/solved_equations.h"
#include "tape/point.h"

namespace anholon {

// A derived equation, left side - right side, with masses substituted.
struct DerivedEquation {
  bool constraint = false;
  std::size_t index = 0;  // index of a coordinate or constraint
  unsigned times = 0;     // number of differentiations
  Expr residual;
};

// Substitutes rates, with their masses and inputs, for the derivatives of states.
Expr put_rates(const Model& model, Expr e);

// Returns values of all symbols, none of them near 0; each attempt gives another point.
PointValues generic_values(int attempt);

class EquationsOfMotion {
 public:
  // `preferred`: coordinates for which constraints are solved if possible. `near`: values at the start of the model's
  // motion.
  EquationsOfMotion(const Mechanics& M, unsigned highest, const std::vector<std::size_t>& preferred,
                    PointValues* near = nullptr);

  unsigned highest = 2;
  std::vector<DerivedEquation> lower;  // constraints and their derivatives of orders 0 and 1
  std::vector<DerivedEquation> rows;   // rows of orders 2 and more: independent equations
  Column top;                          // q'', …, q^(h), lambda, …: the rows are affine in these, if the constraints are
  // The equations of all orders, and as many unknowns.
  Column equations, unknowns;
  bool regular = false;  // the equations determine their unknowns, and the omitted equations follow from them

  // Points in double: on the motion; with only the constraints of orders 0 and 1 satisfied; arbitrary. There are
  // equally many of each, unless none was found. Constraints are solved for as many symbols, whose other symbols have
  // generic values; if this fails at all of these, generic points, then points near the start, are projected on the
  // manifold of the constraints.
  std::vector<PointValues>& on_motion() { return on_motion_; }
  std::vector<PointValues>& on_constraints() { return on_constraints_; }
  std::vector<PointValues>& anywhere() { return anywhere_; }

  // Returns further points on the motion, whose coordinates have either sign and may be three times as large. The list
  // may be empty.
  std::vector<PointValues>& elsewhere();

  // Return the points if they are projected, else nullptr: with generic values of free symbols there are none.
  std::vector<PointValues>* projected() { return projected_ ? &on_motion_ : nullptr; }
  std::vector<PointValues>* projected_elsewhere() { return projected_ ? &elsewhere() : nullptr; }

  // Returns e with the constraints of orders 0 and 1 solved, on each branch of those that are quadratic; empty if they
  // cannot be solved.
  Column reduced(Expr e);
  // Returns e with the equations of all orders solved, on each branch; empty if they cannot be solved by short formulas.
  Column on_solutions(Expr e);

 private:
  struct Stage {
    std::vector<DerivedEquation> rows;
    Column symbols;  // the symbols for which they might be solved
    std::vector<std::vector<Expr>> jacobian;
    std::vector<std::size_t> chosen_rows, chosen_symbols, dropped_rows;
  };
  using Symbols = std::unordered_map<std::uint64_t, double>;

  bool choose(Stage& stage, const std::vector<std::size_t>& preferred, PointValues& at) const;
  bool find_point(int attempt, Symbols& values, Symbols* lower_values);
  void find_projected_points(const std::vector<std::size_t>& preferred, PointValues* near);
  Symbols starting_values(int attempt, PointValues* near) const;
  bool project_point(int attempt, Symbols& values, Symbols* lower_values) const;
  bool project(const Stage& stage, int attempt, Symbols& values) const;
  SolvedEquations solutions(std::size_t orders, std::size_t most_nodes) const;

  std::vector<Stage> stages_;
  std::vector<PointValues> on_motion_, on_constraints_, anywhere_;
  std::optional<std::vector<PointValues>> elsewhere_;
  bool projected_ = false;
  std::optional<SolvedEquations> lower_solved_, solved_;
};

}  // namespace anholon
