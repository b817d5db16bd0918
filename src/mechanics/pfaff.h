// Differential forms and vector fields on the space of (q, t), with formulas as components (theory: integrability).
//
//   df = sum_a df/dz_a dz_a,   X f = sum_a X_a df/dz_a,   [X, Y]_a = X(Y_a) - Y(X_a),   dw_ab = dw_b/dz_a - dw_a/dz_b
//
// where z = (q, t) or q. Functions of time without a formula are differentiated by t: given functions, inputs, and states
// of the model, whose derivatives are their rates.
#pragma once
#include <memory>

#include "mechanics/expression_matrix.h"
#include "mechanics/mechanics.h"
#include "numeric/linear.h"
#include "tape/point.h"

namespace anholon {

struct FormSpace {
  Column z;  // q_1..q_n and, with time, t
  bool time = false;
  const Model* model = nullptr;  // its states are functions of time
  // Returns df as a form.
  Column differential(Expr f) const;
};

// True for symbols that are functions of time without a formula.
bool is_function_of_time(const Node& n);

// Returns the first state in these formulas that is no function of time, because its rate depends on the motion;
// nullptr if there is none.
const StateVariable* state_moved_by_motion(const Model& model, const Column& es);

// Returns w(X), which is X f if w = df.
Expr applied(const Column& w, const Column& X);

// Returns e, or its normal form if that is shorter and found with little work.
Expr simplified(Expr e);

// A vector field with the differentials of its components.
struct VectorField {
  Column X;
  Rows differentials;
  VectorField(const FormSpace& space, Column components);
};
Column bracket(const VectorField& X, const VectorField& Y);

// Ranks are decided with numbers of kFormDigits digits: round-off is far below the threshold for zero, and the
// threshold is far below any true value.
inline constexpr int kFormDigits = 60;
inline constexpr double kFormZero = 1e-35, kIndependent = 1e-25;

struct NoValue {};  // a formula has no value at the point

// A random point near a state. Its positions satisfy the holonomic constraints if Newton's method finds such positions,
// because constraints may depend on one another there alone. REQUIRES: a PrecisionScope of kFormDigits.
class FormPoint {
 public:
  // The seed determines the point; with `other_parameters` the parameters have random values as well, instead of their
  // own.
  FormPoint(const Mechanics& m, PointValues& near, std::uint64_t seed, bool other_parameters);
  Multi operator()(Expr e) { return (*values_)(e); }
  // Returns the point in double, for the choice of pivots.
  PointValues rough() const;

 private:
  bool satisfy(const Column& q, const Column& phi);

  bool satisfy(const Mechanics& m);

  std::function<Multi(const Node&)> symbol_;
  std::unique_ptr<ValuesAt<Multi>> values_;
};

// Returns the values of the rows; entries that are round-off are set to zero. Throws NoValue.
Matrix<Multi> values_at(const Rows& rows, FormPoint& at);
std::size_t rank(const Matrix<Multi>& a);

// A space spanned by vectors that are added one after the other.
class Echelon {
 public:
  // Adds v if it is independent of the vectors before; returns whether it is.
  bool add(std::vector<Multi> v);
  std::size_t dimension() const { return rows_.size(); }

 private:
  std::vector<std::vector<Multi>> rows_;  // 1 at their pivots
  std::vector<std::size_t> pivots_;
};

// Returns e with the values of the parameters substituted.
Expr parameters_put(const Model& model, Expr e);

}  // namespace anholon
