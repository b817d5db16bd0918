// The values of formulas at many points, by a kernel with machine code.
#pragma once
#include <memory>

#include "emit/rate_formulas.h"

namespace anholon {

// A point: all parameters of the model, inputs among them, and what the equations were solved for (empty where rates are
// explicit).
struct FormulaPoint {
  double t;
  std::span<const double> x, parameters, lead;
};

// Expressions in t, x, the parameters and what is solved for. A point's values have the same bits alone and beside
// others, with and without machine code.
class CompiledFormulas {
 public:
  CompiledFormulas();
  CompiledFormulas(const RateFormulas& formulas, const Column& es);
  CompiledFormulas(CompiledFormulas&&) noexcept;
  CompiledFormulas& operator=(CompiledFormulas&&) noexcept;
  ~CompiledFormulas();

  std::size_t size() const;
  // The values of all expressions at the first point, then at the second one, and so on. May be called by many threads.
  std::vector<double> values(std::span<const FormulaPoint> points) const;

 private:
  class Evaluator;
  std::unique_ptr<const Evaluator> evaluator_;  // null where there is no expression
};

}  // namespace anholon
