// The formulas of a function of rates (emit/rate_formulas.h), and their values and derivatives in doubles.
#pragma once
#include "dynamics/dynamics.h"
#include "emit/rate_formulas.h"
#include "tape/one_sided.h"

namespace anholon {

// `scenario` is that of which `dynamics` was made; `input_formulas`: expressions of its model, one for each input;
// `open`: the same, with the parameters that are other inputs. Throws Failure for functions without a formula.
RateFormulas rate_formulas_of(Workspace& scenario, const Dynamics& dynamics, std::span<const NodeId> input_formulas,
                              std::span<const NodeId> open);

// The rates in independent velocities, with inputs by their formulas. Returns nullopt if the equations have none.
std::optional<RateFormulas> independent_rates(const Scenario& scenario, const StateChoice& choice);

// A point: all parameters of the model, inputs among them, and what the equations were solved for (empty where rates are
// explicit).
struct FormulaPoint {
  double t;
  std::span<const double> x, parameters, lead;
};

// A list of expressions as a tape, with what its inputs are.
class CompiledFormulas {
 public:
  CompiledFormulas() = default;
  CompiledFormulas(const RateFormulas& formulas, const Column& es);

  // A machine of the tape, which one caller after the other may use.
  struct Work {
    std::optional<Machine<double>> machine;
    std::vector<double> parameters;
  };
  std::vector<double> values(const FormulaPoint& at, Work& work) const;

  // Where the value of a symbol is in a point.
  enum class From : std::uint8_t { time, state, lead };
  struct Source {
    From from;
    std::size_t index;
    double at(const FormulaPoint& point) const;
  };
  static std::unordered_map<NodeId, Source> sources(const RateFormulas& formulas);

 private:
  Tape tape_;
  std::vector<Source> inputs_;
};

// The formulas as tapes. May be called by many threads.
class FormulaValues {
 public:
  explicit FormulaValues(RateFormulas formulas);
  const RateFormulas& formulas() const { return formulas_; }

  using Point = FormulaPoint;
  // Belongs to one thread, and makes the points after the first one cheaper.
  struct Work {
    CompiledFormulas::Work inputs, open_inputs, outputs, equations, derivatives;
  };
  std::vector<double> inputs(const Point& at, Work& work) const;
  // The given inputs, and the others by their formulas, in which the given ones act.
  std::vector<double> inputs(const Point& at, std::span<const std::optional<double>> given, Work& work) const;
  std::vector<double> outputs(const Point& at, Work& work) const;
  // matrix lead = right: the matrix row by row. REQUIRES: rates are not explicit, and the equations are linear.
  struct Equations {
    std::vector<double> matrix, right;
  };
  Equations equations(const Point& at, Work& work) const;
  // Exact derivatives of rates, then outputs, by x, u and p: row by row. NaN where the equations have no solution, and
  // where a formula has no derivative: at a kink or a jump of abs, min, max, sign, piecewise or a table.
  struct Derivatives {
    std::size_t rows = 0, columns = 0;
    std::vector<double> values;
  };
  Derivatives derivatives(const Point& at, Work& work) const;

 private:
  using Partial = OneSided::Partial;
  // The derivatives by these partial ones, of which there are as many numbers.
  Derivatives assembled(const std::vector<Partial>& places, std::span<const double> partials) const;
  // Puts NaN in the places of derivatives that differ on both sides of a border between branches.
  void leave_out_kinks(const Point& at, Derivatives& d) const;
  RateFormulas formulas_;
  CompiledFormulas inputs_, open_inputs_, outputs_, equations_, derivatives_;
  std::vector<Partial> partials_;  // of the derivatives: rows of equations, rates, outputs; columns of lead, x, u, p
  Column columns_;
  OneSided sides_;  // of the same rows and columns
  std::unordered_map<NodeId, CompiledFormulas::Source> sources_;
};

}  // namespace anholon
