// Exact derivatives of the formulas of rates and outputs.
#pragma once
#include <unordered_map>

#include "dynamics/compiled_formulas.h"
#include "tape/one_sided.h"

namespace anholon {

// By some of x, u and p. May be used by many threads.
class RateDerivatives {
 public:
  // Writes expressions into the graph of the formulas, which have to live longer.
  RateDerivatives(const RateFormulas& formulas, const RateFormulas::Symbols& by);

  // Of rates, then outputs: row by row. NaN where the equations have no solution, and where a formula has no derivative:
  // at a kink or a jump of abs, min, max, sign, piecewise or a table.
  struct Of {
    std::size_t rows = 0, columns = 0;
    std::vector<double> values;
  };
  // Point by point.
  std::vector<Of> at(std::span<const FormulaPoint> points) const;

 private:
  using Partial = OneSided::Partial;
  // The derivatives by these partial ones, of which there are as many numbers.
  Of assembled(const std::vector<Partial>& places, std::span<const double> partials) const;
  // Puts NaN in the places of derivatives that differ on both sides of a border between branches.
  void leave_out_kinks(const FormulaPoint& at, Of& d) const;

  const RateFormulas& formulas_;
  std::vector<Partial> partials_;  // rows: equations, rates, outputs; columns: what is solved for, then what it is by
  Column columns_;
  CompiledFormulas values_;  // of the partial derivatives
  OneSided sides_;           // of the same rows and columns
  // Where the value of a symbol is in a point.
  enum class From : std::uint8_t { time, state, lead };
  struct Source {
    From from;
    std::size_t index;
    double at(const FormulaPoint& point) const;
  };
  std::unordered_map<NodeId, Source> sources_;
};

}  // namespace anholon
