// The formulas of a function of rates (emit/rate_formulas.h), and their values and derivatives in doubles.
#pragma once
#include <array>
#include <mutex>

#include "dynamics/compiled_formulas.h"
#include "dynamics/dynamics.h"
#include "dynamics/rate_derivatives.h"

namespace anholon {

// `scenario`: the one from which `dynamics` was made; `input_formulas`: expressions of its model, one for each input;
// `open`: the same, with the parameters that are other inputs. Throws Failure for functions without a formula.
RateFormulas rate_formulas_of(Workspace& scenario, const Dynamics& dynamics, std::span<const NodeId> input_formulas,
                              std::span<const NodeId> open);

// The rates in independent velocities, with inputs replaced by their formulas. Returns nullopt if the equations have no
// such velocities.
std::optional<RateFormulas> independent_rates(const Scenario& scenario, const StateChoice& choice,
                                              const std::vector<std::size_t>& fixed = {});

// The formulas as functions. Many threads may call them.
class FormulaValues {
 public:
  explicit FormulaValues(RateFormulas formulas);
  const RateFormulas& formulas() const { return formulas_; }

  using Point = FormulaPoint;
  // The values point by point, as in CompiledFormulas.
  std::vector<double> inputs(const Point& at) const { return inputs_.values({&at, 1}); }
  std::vector<double> outputs(std::span<const Point> points) const { return outputs_.values(points); }
  // Returns the given inputs, and the others by their formulas, which use the given ones.
  std::vector<double> inputs(const Point& at, std::span<const std::optional<double>> given) const;
  // The equations matrix lead = right: point by point the matrix row by row, then the right side. REQUIRES: rates are
  // not explicit, and the equations are linear.
  std::vector<double> equations(std::span<const Point> points) const { return equations_.values(points); }
  enum class By : std::uint8_t { state, input, parameter };
  std::vector<RateDerivatives::Of> derivatives(std::span<const Point> points, By by) const;
  // The formulas as source text (emit/rate_formulas.h).
  std::string python_source() const;
  std::string c_source(const std::string& name, const std::string& made_by) const;

 private:
  RateFormulas formulas_;
  CompiledFormulas inputs_, open_inputs_, outputs_, equations_;
  mutable std::mutex building_;  // protects the graph of the formulas, to which expressions are added
  mutable std::array<std::once_flag, 3> once_;
  mutable std::array<std::unique_ptr<const RateDerivatives>, 3> derivatives_;  // made when they are first needed
};

}  // namespace anholon
