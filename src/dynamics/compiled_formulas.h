// Computes the values of formulas at many points, by a kernel with machine code.
#pragma once
#include <memory>

#include "emit/rate_formulas.h"

namespace anholon {

// A point: all parameters of the model, inputs included, and the solution of the equations (empty if the rates are
// explicit).
struct FormulaPoint {
  double t;
  std::span<const double> x, parameters, lead;
};

// Expressions in t, x, the parameters and the unknowns of the equations. The bits of a point's values do not depend on
// other points, nor on machine code.
class CompiledFormulas {
 public:
  CompiledFormulas();
  CompiledFormulas(const RateFormulas& formulas, const Column& es);
  CompiledFormulas(CompiledFormulas&&) noexcept;
  CompiledFormulas& operator=(CompiledFormulas&&) noexcept;
  ~CompiledFormulas();

  std::size_t size() const;
  // Returns the values of all expressions at the first point, then at the second one, and so on. Many threads may call
  // it.
  std::vector<double> values(std::span<const FormulaPoint> points) const;

 private:
  class Evaluator;
  std::unique_ptr<const Evaluator> evaluator_;  // nullptr without expressions
};

}  // namespace anholon
