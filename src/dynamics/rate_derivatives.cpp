#include "dynamics/rate_derivatives.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "expr/derivatives/point_gradient.h"
#include "numeric/linear.h"

namespace anholon {

// Values on both sides of a border between branches agree up to this if the branches agree there: it is the round-off
// of some thousand operations.
static constexpr double kSameSides = 4096 * std::numeric_limits<double>::epsilon();

RateDerivatives::RateDerivatives(const RateFormulas& f, const RateFormulas::Symbols& by)
    : formulas_(f), columns_(f.lead.symbols), rows_(f.rows_that_may_lack_values()) {
  columns_.insert(columns_.end(), by.symbols.begin(), by.symbols.end());
  Column rows = f.equations, partials;
  for (const Column* es : {&f.rates, &f.outputs}) rows.insert(rows.end(), es->begin(), es->end());
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const Column d = point_gradient(rows[i], columns_, AtKinks::no_value);
    for (std::size_t c = 0; c < d.size(); ++c)
      if (!is_zero(d[c])) partials.push_back(d[c]), partials_.push_back({i, c});
  }
  for (const std::size_t row : rows_) partials.push_back(rows[f.equations.size() + row]);
  values_ = {f, partials};
  sides_ = {rows, columns_, f.model->names.parameters.size()};
  if (sides_.branches().empty()) return;
  sources_[f.model->graph->time().id] = {From::time, 0};
  for (const auto& [list, from] : {std::pair{&f.x, From::state}, std::pair{&f.lead, From::lead}})
    for (std::size_t i = 0; i < list->size(); ++i) sources_[list->symbols[i].id] = {from, i};
}

double RateDerivatives::Source::at(const FormulaPoint& point) const {
  switch (from) {
  case From::time:
    return point.t;
  case From::state:
    return point.x[index];
  case From::lead:
    return point.lead.empty() ? 0 : point.lead[index];
  }
  return 0;
}

// The result is d rates / dx  =  partial  -  d rates / d lead . (d equations / d lead)^-1 . d equations / dx.
std::vector<RateDerivatives::Of> RateDerivatives::at(std::span<const FormulaPoint> points) const {
  const std::vector<double> partials = values_.values(points);
  std::vector<Of> all;
  for (std::size_t k = 0; k < points.size(); ++k) {
    const std::span<const double> of_point = std::span(partials).subspan(k * values_.size(), values_.size());
    all.push_back(assembled(partials_, of_point.first(partials_.size())));
    leave_out_rows(of_point.last(rows_.size()), all.back());
    if (!sides_.branches().empty()) leave_out_kinks(points[k], all.back());
  }
  return all;
}

void RateDerivatives::leave_out_rows(std::span<const double> values, Of& d) const {
  for (std::size_t i = 0; i < rows_.size(); ++i)
    if (std::isnan(values[i]))
      std::fill_n(d.values.begin() + static_cast<std::ptrdiff_t>(rows_[i] * d.columns), d.columns,
                  std::numeric_limits<double>::quiet_NaN());
}

// The rows of the sides are equations, rates, outputs. If a value jumps with a condition, it has no derivative with
// respect to the variables in the condition; the unknowns of the equations depend on everything.
void RateDerivatives::leave_out_kinks(const FormulaPoint& at, Of& d) const {
  constexpr double nan = std::numeric_limits<double>::quiet_NaN();
  const std::size_t n = formulas_.lead.size(), rows = n + d.rows;
  const auto differ = [](double a, double b) {
    return !(std::abs(a - b) <= kSameSides * (1 + std::abs(a) + std::abs(b))) && (std::isfinite(a) || std::isfinite(b));
  };
  const auto set = [&](Machine<double>& m) {
    bind(m, *formulas_.model->graph, [&](const Node&, NodeId symbol) { return sources_.at(symbol).at(at); });
  };
  for (const auto& side : sides_.sides<double>({at.parameters.begin(), at.parameters.end()}, 0, set)) {
    const std::span<const double> below(side.below), above(side.above);
    const Of a = assembled(sides_.partials(), below.subspan(rows)),
             b = assembled(sides_.partials(), above.subspan(rows));
    for (std::size_t i = 0; i < d.values.size(); ++i)
      if (differ(a.values[i], b.values[i])) d.values[i] = nan;
    const std::vector<NodeId> held = symbols({&sides_.branches()[side.branch].condition, 1});
    const auto holds = [&](Expr e) { return std::find(held.begin(), held.end(), e.id) != held.end(); };
    const bool through_lead = std::any_of(formulas_.lead.symbols.begin(), formulas_.lead.symbols.end(), holds);
    for (std::size_t r = 0; r < rows; ++r) {
      if (!differ(below[r], above[r])) continue;
      for (std::size_t c = 0; c < d.columns; ++c)
        if (through_lead || holds(columns_[n + c]))
          for (std::size_t k = r < n ? 0 : r - n; k < (r < n ? d.rows : r - n + 1); ++k)
            d.values[k * d.columns + c] = nan;
    }
  }
}

RateDerivatives::Of RateDerivatives::assembled(const std::vector<Partial>& places,
                                               std::span<const double> partials) const {
  const RateFormulas& f = formulas_;
  const std::size_t n = f.lead.size(), columns = columns_.size() - n;
  Of out{f.rates.size() + f.outputs.size(), columns, {}};
  Matrix<double> of_lead(n, n), others(n, columns), through(out.rows, n);
  out.values.assign(out.rows * columns, 0);
  for (std::size_t k = 0; k < places.size(); ++k) {
    const auto [row, column] = places[k];
    if (row < n)
      (column < n ? of_lead(row, column) : others(row, column - n)) = partials[k];
    else if (column < n)
      through(row - n, column) = partials[k];
    else
      out.values[(row - n) * columns + column - n] = partials[k];
  }
  if (n == 0) return out;
  Lu<double> lu;
  if (!lu.factor(of_lead)) {
    out.values.assign(out.values.size(), std::numeric_limits<double>::quiet_NaN());
    return out;
  }
  std::vector<double> b(n), change;
  for (std::size_t c = 0; c < columns; ++c) {
    for (std::size_t i = 0; i < n; ++i) b[i] = others(i, c);
    lu.solve(b, change);
    for (std::size_t r = 0; r < out.rows; ++r)
      for (std::size_t j = 0; j < n; ++j)
        if (through(r, j) != 0) out.values[r * columns + c] -= through(r, j) * change[j];
  }
  return out;
}

}  // namespace anholon
