// One stage of consistent initial data: equations in some entries of the state, and how these are found by least
// change.
#pragma once
#include <memory>

#include "base/diagnostic.h"
#include "expr/handles.h"
#include "mechanics/mechanics.h"
#include "structure/state.h"
#include "tape/tape.h"

namespace anholon {

struct StageEquation {
  Expr residual;
  std::string what;  // "constraint 'blade'"
  Span span;
  bool condition = false;  // of the file's initial data, not a law of the system
};

// Rows of a constraint Jacobian count as dependent below this fraction of their size.
inline constexpr double kDependent = 1e-9;

// Equations in chosen unknowns with their partial derivatives, compiled: whoever has one needs to build no expressions.
struct StagePlan {
  // `mass`: the mass matrix, where the caller has it already.
  StagePlan(const Mechanics& m, std::vector<StageEquation> equations, Column unknowns, unsigned metric,
            const std::vector<Column>* mass = nullptr);

  std::vector<StageEquation> equations;
  Column unknowns;
  unsigned metric;
  bool linear = false;  // every equation is, in the unknowns
  Tape tape;
};

// The handles of a plan (expr/handles.h).
void for_each_expression(StagePlan& p, const ExprVisitor& f);

// Such equations with their numbers. The metric of least change is the mass matrix at each order of the coordinates in
// `metric` (bit k: order k); the other unknowns are found, not measured.
template <Number N>
class Stage {
 public:
  Stage(const Mechanics& m, std::shared_ptr<const StagePlan> plan, const std::vector<N>& parameters);
  Stage(const Mechanics& m, std::vector<StageEquation> equations, Column unknowns, unsigned measured,
        const std::vector<N>& parameters, const std::vector<Column>* mass = nullptr)
      : Stage(m, std::make_shared<const StagePlan>(m, std::move(equations), std::move(unknowns), measured, mass),
              parameters) {}

  std::size_t size() const { return plan_->equations.size(); }
  std::size_t unknowns() const { return plan_->unknowns.size(); }
  const StageEquation& equation(std::size_t i) const { return plan_->equations[i]; }
  const Node& unknown(std::size_t j) const { return m_.graph().node(plan_->unknowns[j].id); }
  N& x(InitialState<N>& s, std::size_t j) const { return *s.value(unknown(j)); }
  const N& x_of(const InitialState<N>& s, std::size_t j) const { return *s.value(unknown(j)); }
  bool linear() const { return plan_->linear; }
  const Mechanics& mechanics() const { return m_; }

  // From now on only these equations ask for anything; then all again.
  void keep(std::vector<bool> rows) { kept_ = std::move(rows); }
  void keep_all() { kept_.clear(); }

  // Values, scales and partial derivatives at a state; false if a formula has no value there (`undefined` is its row,
  // or the number of equations where it is an entry of the mass matrix).
  bool evaluate(const InitialState<N>& s);
  // True if the equations say anything about unknown j.
  bool moves(std::size_t j) const {
    for (std::size_t i = 0; i < size(); ++i)
      if (abs(jacobian(i, j)) > N(0)) return true;
    return false;
  }
  // The largest residual in relation to its scale, and where it is. Residuals below the round-off of the unknowns are
  // none.
  N worst(std::size_t* which = nullptr) const { return worst(scale, which); }
  // … in relation to the scales of another point.
  N worst(const std::vector<N>& scale, std::size_t* which = nullptr) const;

  std::vector<N> residual, scale;
  Matrix<N> jacobian, metric;
  std::size_t undefined = 0;

 private:
  std::vector<N> floor_;
  std::vector<bool> kept_;  // empty: all

  const Mechanics& m_;
  std::shared_ptr<const StagePlan> plan_;
  Machine<N> machine_;
};

// Residuals below this part of their scale are round-off.
template <Number N>
N stage_rounding() {
  return unit_roundoff<N>() * N(200);
}

// min |x - x0| over the free unknowns subject to the equations, x0 being the values that the state has, by Newton's
// method with a line search. Where that does not arrive, a solution is looked for from x0 and from points around it,
// and the nearest is taken; where there is none, it ends at the least miss reachable, and the caller looks at what is
// left. False: no value there. `near`: where the first search begins, if not at x0.
template <Number N>
bool find_by_least_change(Stage<N>& stage, InitialState<N>& state, const std::vector<std::size_t>& free,
                          const InitialState<double>* near = nullptr);

}  // namespace anholon
