// One stage of consistent initial data: equations in some entries of the state, and their solution by least change.
#pragma once
#include <memory>
#include <optional>

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
  bool condition = false;  // a condition of the file's initial data, not a law of the system
};

// Rows of a constraint Jacobian count as dependent below this fraction of their size.
inline constexpr double kDependent = 1e-9;
// Given values may miss a constraint by this fraction of its scale: they are taken for rounded numbers.
inline constexpr double kRounded = 1e-8;

// Equations in chosen unknowns with their partial derivatives, compiled; the users of a plan build no expressions.
struct StagePlan {
  // `mass`: the mass matrix, if the caller has it already.
  StagePlan(const Mechanics& m, std::vector<StageEquation> equations, Column unknowns, unsigned metric,
            const std::vector<Column>* mass = nullptr);

  std::vector<StageEquation> equations;
  Column unknowns;
  unsigned metric;
  bool linear = false;  // every equation is linear in the unknowns
  Tape tape;
  // The slots that depend on the unknowns; `mass_moves` tells whether the mass matrix is among them.
  std::vector<std::uint32_t> moving;
  bool mass_moves = false;
  std::vector<bool> is_unknown;            // true for those of the tape's inputs that are unknowns
  std::vector<std::vector<bool>> holds;    // true if equation i contains unknown j
  std::vector<std::vector<NodeId>> known;  // for each equation: the other entries of a state in it
};

// The handles of a plan (expr/handles.h).
void for_each_expression(StagePlan& p, const ExprVisitor& f);

// The equations of a plan with their numbers. The metric of least change is the mass matrix at each order of the
// coordinates in `metric` (bit k: order k); the metric does not measure changes of the other unknowns.
template <Number N>
class Stage {
 public:
  Stage(const Mechanics& m, std::shared_ptr<const StagePlan> plan, const std::vector<N>& parameters);
  Stage(const Mechanics& m, std::vector<StageEquation> equations, Column unknowns, unsigned measured,
        const std::vector<N>& parameters, const std::vector<Column>* mass = nullptr)
      : Stage(m, std::make_shared<const StagePlan>(m, std::move(equations), std::move(unknowns), measured, mass),
              parameters) {}

  std::size_t size() const { return plan_->equations.size(); }
  const StagePlan& plan() const { return *plan_; }
  std::size_t unknowns() const { return plan_->unknowns.size(); }
  const StageEquation& equation(std::size_t i) const { return plan_->equations[i]; }
  const Node& unknown(std::size_t j) const { return m_.graph().node(plan_->unknowns[j].id); }
  N& x(InitialState<N>& s, std::size_t j) const { return *s.value(unknown(j)); }
  const N& x_of(const InitialState<N>& s, std::size_t j) const { return *s.value(unknown(j)); }
  bool linear() const { return plan_->linear; }
  // True if the formula of equation i contains unknown j, also where its partial derivative vanishes. False for
  // equations that a restriction leaves out.
  bool holds(std::size_t i, std::size_t j) const { return plan_->holds[i][j] && (kept_.empty() || kept_[i]); }

  // Restricts the stage to these equations; keep_all() removes the restriction.
  void keep(std::vector<bool> rows) { kept_ = std::move(rows), known_ = false; }
  void keep_all() {
    if (!kept_.empty()) known_ = false;
    kept_.clear();
  }

  // Computes values, scales and partial derivatives at a state. Returns false if a formula has no value there
  // (`undefined` is its row, or the number of equations for an entry of the mass matrix). In hardware numbers, results
  // that depend only on inputs with the same bits as at the last evaluation are not computed again.
  bool evaluate(const InitialState<N>& s);
  // The independent rows of the Jacobian in these unknowns, and the least changes that satisfy them; kept as long as
  // Jacobian and metric do not change.
  struct Elimination {
    std::vector<std::size_t> free;
    Matrix<N> a;  // the Jacobian in the free unknowns
    RowChoice<N> rows;
    LeastChange<N> change;
    bool possible = false;  // true if there are such changes
  };
  Elimination& elimination(const std::vector<std::size_t>& free);
  // Tells for each of these unknowns whether the equations determine it; the result is kept as long as the Jacobian
  // does not change.
  const std::vector<bool>& determined(const std::vector<std::size_t>& free);
  // True if the equations depend on unknown j.
  bool moves(std::size_t j) const {
    for (std::size_t i = 0; i < size(); ++i)
      if (abs(jacobian(i, j)) > N(0)) return true;
    return false;
  }
  // True if rounding of the unknowns' values explains the residual of equation i.
  bool is_rounded(std::size_t i) const;
  // True if rounding explains the residuals of all equations.
  bool is_rounded() const;
  // True if an equation does not depend on any of these unknowns, and its residual is larger than rounding explains.
  bool contradicts(const std::vector<std::size_t>& free) const;
  // Returns the largest residual relative to its scale, and its index. Residuals below the round-off of the unknowns
  // count as zero.
  N worst(std::size_t* which = nullptr) const { return worst(scale, which); }
  // Returns the largest residual relative to the scales of another point.
  N worst(const std::vector<N>& scale, std::size_t* which = nullptr) const;

  std::vector<N> residual, scale;
  Matrix<N> jacobian, metric;
  std::size_t undefined = 0;

 private:
  // The inputs that differ from those of the last evaluation.
  enum class Change : std::uint8_t { none, unknowns, all };
  Change bind_inputs(const InitialState<N>& s);
  bool read_equations(const InitialState<N>& s, bool jacobian_stays);
  bool read_metric();
  // Sets partial derivatives to zero that are not larger than the round-off of the known inputs and of the parameters.
  void drop_round_off();

  std::vector<N> floor_, at_;  // the values of the unknowns
  std::vector<bool> kept_;     // the equations of the restriction; empty: all
  bool known_ = false;         // true if the numbers belong to the present inputs
  bool lacks_slopes_ = false;  // true if a derivative by a value that is given is 0 in place of no number
  std::optional<Elimination> elimination_;
  struct Determined {
    std::vector<std::size_t> free;
    std::vector<bool> is;
  };
  std::optional<Determined> determined_;

  const Mechanics& m_;
  std::shared_ptr<const StagePlan> plan_;
  std::vector<N> parameters_;
  Machine<N> machine_;
};

// Residuals below this fraction of their scale are round-off.
template <Number N>
N stage_rounding() {
  return unit_roundoff<N>() * N(200);
}

// Minimizes |x - x0| over the free unknowns that an equation contains, subject to the equations; the other unknowns
// stay. x0 are the values in the state. The method is Newton's with a line search. If it does not converge by full
// steps, solutions are also searched from x0 and from points around it, and the nearest solution is taken. If none is
// found, the state ends at the least residual reached, which the caller examines. Returns false if the equations have
// no value there. `near`: the start of the first search, if not x0. `by_flow`: searches first along Newton's flow from
// x0, d/ds F(x(s)) = -F(x(s)), which leads to the solution that belongs to x0 among several.
template <Number N>
bool find_by_least_change(Stage<N>& stage, InitialState<N>& state, const std::vector<std::size_t>& free,
                          const InitialState<double>* near = nullptr, bool by_flow = false);
}  // namespace anholon
