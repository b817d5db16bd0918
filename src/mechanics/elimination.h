// The constraints solved for highest derivatives (theory: elimination).
//
// All constraints are lifted to one order m, the highest among them or a higher requested one (N does not change). On
// their manifold the highest derivatives are functions of the lower ones and of n - s free quantities u:
//
//   q^(m) = g(q, …, q^(m-1), u, t)
//
// where u are the highest derivatives of the independent coordinates, u = q_I^(m), so that g_b = f_b of [L 3.8] for the
// dependent ones, or quasi-velocities u = pi^(m) as in [N 4.2].
//
// Constraints are solved if they can be: then `on` substitutes g for q^(m) and the derivative of g for q^(m+1).
// Otherwise q^(m) denotes its own value on the manifold, `on` changes nothing, and derivatives along the manifold
// follow from the implicit function theorem, dg/dy = -W^-1 dw/dy with w = (u, phi) and W = dw/dq^(m). A formulation
// does not distinguish both cases: it differentiates along the manifold with the operators below.
#pragma once
#include <memory>
#include <optional>

#include "mechanics/expression_matrix.h"
#include "mechanics/mechanics.h"

namespace anholon {

// The place at which the rank of the constraints that take part is known to be their number.
enum class FullRank : std::uint8_t {
  here,    // at the state near which is eliminated, or at a generic point if constraints are identically dependent
  beside,  // the rank is lower at this state, a singular one
  assumed  // no point of the manifold is known at which the rank is full
};

// The choice of eliminated and of free quantities.
struct EliminationChoice {
  std::vector<std::size_t> constraints;  // the constraints that take part; they are independent
  std::vector<std::size_t> dependent;    // as many coordinates as constraints, dphi/dq_D^(m) regular
  bool by_quasi = false;                 // u are quasi-velocities, n - s of them; else u = q_I^(m)
  std::vector<QuasiVelocity> quasi;
  bool solve = true;  // solves the constraints, if they can be solved
  unsigned m = 0;     // the requested common order; 0: the highest order of the constraints and quasi-velocities
  std::vector<std::size_t> left_out = {};  // constraints that depend on those that take part, on the manifold only
  FullRank full_rank = FullRank::here;
};

// The free quantities u, n - s of them.
struct FreeQuantities {
  std::vector<std::string> names;  // coordinates or quasi-velocities
  std::vector<unsigned> orders;    // u_k is the derivative of order orders[k] of names[k]
  Column u, rate;                  // u': symbols; u: symbols if solved, else functions of q, …, q^(m)
  Column value, rate_value;        // u, u' in coordinates
  Column named;                    // for quasi-velocities: names[k] itself in coordinates
  // Returns the index of a name; nullopt if the name is not among the free quantities.
  std::optional<std::size_t> index_of(const std::string& name) const;
};

// All n quasi-velocities, of which the last s are the constraints, and dq/du of all of them [N 4.2].
struct QuasiBasis {
  Column w;
  Rows chi_by_u;  // n x n
};

// One derivative of all coordinates on the manifold.
struct OnManifold {
  Column symbols;  // q^(k)
  Column values;   // n entries; q^(m) itself if not solved
  Rows by_u;       // n x (n - s)
};

class Elimination {
 public:
  Elimination() = default;  // eliminates nothing
  // An elimination that eliminates nothing, for a form with multipliers of order `asked`.
  static Elimination of_order(unsigned asked);
  // `at`: values near the state, by which pivots are chosen.
  Elimination(const Mechanics& mechanics, const EliminationChoice& choice, std::shared_ptr<PointValues> at);

  unsigned m = 1;      // common order of the lifted constraints, at least 1
  unsigned asked = 0;  // m, if it was requested
  std::vector<std::size_t> constraints, dependent, independent;
  std::vector<std::size_t> left_out;  // as in the choice
  FullRank full_rank = FullRank::here;
  Column phi;           // lifted constraints, masses substituted
  Rows Phi_D_inverse;   // inverse of dphi/dq_D^(m), s x s
  bool solved = false;  // g is known as a formula
  FreeQuantities free;
  std::optional<QuasiBasis> quasi;  // if u are quasi-velocities

  // Returns X on the manifold.
  Expr on(Expr X) const;
  Column on(const Column& X) const;
  Rows on(const Rows& X) const;
  // Returns d/dt X along the manifold (frozen masses stay frozen).
  Column rate(const Column& X) const { return on(total_derivative(X)); }
  Rows rate(const Rows& X) const;
  // These return partial derivatives of X, on the manifold and with the other free quantities held, with respect to
  Column by_u(Expr X) const;            // u                    (n - s)
  Column by_u_rate(Expr X) const;       // u'                   (n - s)
  Column by(unsigned k, Expr X) const;  // q^(k), k < m         (n)
  // The same derivatives of g and g' = dg/dt: row s is the gradient of g_s.
  const Column& g() const { return top_.values; }
  const Rows& g_by_u() const { return top_.by_u; }  // B of [N 4.3], n x (n - s)
  const Rows& g_by(unsigned k) const;               // n x n
  const Rows& g_rate_by_u() const { return next_.by_u; }
  // These return f_b,nu and similar derivatives: the rows of the dependent coordinates, the columns of the independent
  // ones.
  Rows f_by_u() const;
  Rows f_by(unsigned k) const;
  Rows f_rate_by_u() const;

  // Returns C = -Phi_D^-1 Phi_I of [L 3.7], dependent by independent.
  Rows C() const;
  // Returns A^-1, computed with pivots that are not small near the state.
  Rows inverted(const Rows& A) const { return pivots_.inverse(A, Wanted::brief); }
  // The divisors; near a zero of one of them another elimination is better.
  const Column& pivots() const { return pivots_.divisors(); }
  // Returns the values near the state; nullptr if there are none.
  PointValues* point() const { return pivots_.point(); }
  // Returns sum_s X_s B_sa, which is X_nu + sum_b X_b f_b,nu.
  Column contract(const Column& X) const;
  // Return the entries of the independent and of the dependent coordinates.
  Column I(const Column& X) const { return pick(X, independent); }
  Column D(const Column& X) const { return pick(X, dependent); }

  // Expresses quasi-velocities and all their derivatives in coordinates again.
  Column in_coordinates(const Column& X) const;

  // Returns the same elimination for `copy`, a copy of the mechanics, with values of its own near the state. The
  // handles still refer to the old graph.
  Elimination of(const Mechanics& copy) const;
  // The handles of the elimination (expr/handles.h), without those of its mechanics.
  friend void for_each_expression(Elimination& e, const ExprVisitor& f);

 private:
  static Column pick(const Column& X, const std::vector<std::size_t>& which);
  void by_coordinates(const Rows& Phi_D, bool solve);
  void by_quasi_velocities(const std::vector<QuasiVelocity>& list, bool solve);
  void differentiate();
  void differentiate_implicitly();
  // Returns w = (u, phi) in coordinates, whose Jacobian is W.
  Column all_values() const;

  const Mechanics* mechanics_ = nullptr;
  OnManifold top_, next_;           // q^(m) = g, q^(m+1) = g'
  Rows W_inverse_;                  // if not solved, n x n
  mutable std::vector<Rows> g_by_;  // those computed so far
  mutable PivotChoice pivots_;
};

void for_each_expression(Elimination& e, const ExprVisitor& f);

}  // namespace anholon
