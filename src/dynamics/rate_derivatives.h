// Exact derivatives of the formulas of rates and outputs.
#pragma once
#include <unordered_map>

#include "dynamics/compiled_formulas.h"
#include "tape/one_sided.h"

namespace anholon {

// The derivatives with respect to some of x, u and p. Many threads may use it.
class RateDerivatives {
 public:
  // Writes expressions into the graph of the formulas, which have to outlive this object.
  RateDerivatives(const RateFormulas& formulas, const RateFormulas::Symbols& by);

  // The derivatives of rates, then of outputs, row by row. NaN if the equations have no solution, in the row of a
  // formula without a value, and if a formula has no derivative: at a kink or a jump of abs, min, max, sign, piecewise
  // or a table.
  struct Of {
    std::size_t rows = 0, columns = 0;
    std::vector<double> values;
  };
  // Returns the derivatives point by point.
  std::vector<Of> at(std::span<const FormulaPoint> points) const;

 private:
  using Partial = OneSided::Partial;
  // Returns the derivatives made from these partial ones, of which there are as many numbers.
  Of assembled(const std::vector<Partial>& places, std::span<const double> partials) const;
  // Puts NaN in the places of derivatives that differ on both sides of a border between branches.
  void leave_out_kinks(const FormulaPoint& at, Of& d) const;

  const RateFormulas& formulas_;
  // Puts NaN into the rows of formulas without a value. `values`: those of rows_.
  void leave_out_rows(std::span<const double> values, Of& d) const;

  // Rows: equations, rates, outputs; columns: unknowns of the equations, then the variables.
  std::vector<Partial> partials_;
  Column columns_;
  std::vector<std::size_t> rows_;  // the rows of rates and outputs whose formulas may have no value
  CompiledFormulas values_;        // of the partial derivatives, then of these rows
  OneSided sides_;                 // of the same rows and columns
  // The place of the value of a symbol in a point.
  enum class From : std::uint8_t { time, state, lead };
  struct Source {
    From from;
    std::size_t index;
    double at(const FormulaPoint& point) const;
  };
  std::unordered_map<NodeId, Source> sources_;
};

}  // namespace anholon
