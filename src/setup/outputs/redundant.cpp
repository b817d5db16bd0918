#include "setup/outputs/redundant.h"

#include <algorithm>

#include "numeric/told_time.h"

namespace anholon {

// A constraint whose residual exceeds this part of the size of the state no longer follows from the others.
static constexpr double kMiss = 1e-7;

template <Number W>
Redundant<W>::Redundant(Workspace& s, const std::vector<W>& parameters) : s_(s) {
  if (s.redundant.empty()) return;
  outputs_.emplace(s, put_masses(*s.model, s.mechanics->phi), parameters);
  least_.emplace(s, parameters);
}

template <Number W>
Outcome Redundant<W>::hold(const Expansion<W>& point, bool start, std::vector<Miss>& misses) {
  misses.clear();
  if (!outputs_) return {};
  outputs_->evaluate(point);
  W size(1);
  for (std::size_t a = 0; a < s_.system.coordinates; ++a)
    for (int k = 0; k <= point.program().d[a]; ++k)
      if (W v = abs(point.derivative(a, k)); v > size) size = v;
  const std::vector<std::size_t>& kept = point.program().system->constraints;
  for (std::size_t r = 0; r < s_.model->constraints.size(); ++r) {
    if (std::find(kept.begin(), kept.end(), r) != kept.end()) continue;
    const double miss = to_double(W(abs((*outputs_)[r]) / size));
    misses.push_back({r, miss});
    if (!(miss <= kMiss)) {
      const std::string name = "the constraint '" + s_.model->constraints[r].name + "' ";
      if (start)
        return {OutcomeKind::inconsistent,
                name + "contradicts the others: it is missed by " +
                    number_text(std::abs(to_double((*outputs_)[r])), 3) + " at the start",
                "leave it out, or the one that it contradicts"};
      const double t = to_double(point.time());
      return told({OutcomeKind::singular, name + "no longer follows from the others" + at_time(t),
                   "it was redundant at the start only: start elsewhere, or leave out one of the constraints"},
                  t);
    }
  }
  return {};
}

template <Number W>
std::vector<W> Redundant<W>::multipliers(const Expansion<W>& point) {
  if (least_ && multiplier_orders(s_) == 0) return least_->at(point);
  const std::vector<std::size_t>& kept = point.program().system->constraints;
  std::vector<W> all(s_.model->constraints.size(), W(0));
  for (std::size_t i = 0; i < kept.size(); ++i) all[kept[i]] = point.derivative(s_.system.coordinates + i, 0);
  return all;
}

Outcome follow_beside_start(Workspace& s) {
  using N = long double;
  constexpr int kOrders = 4;
  if (s.redundant.empty()) return {};
  Column left_out;
  for (std::size_t r : s.redundant) left_out.push_back(put_masses(*s.model, s.mechanics->phi[r]));
  const Program p = program(s.system, s.structure, taking_part(s.system, left_out));
  Expansion<N> point(p, parameter_values<N>(*s.model), kOrders);
  const Start<double> start = start_of(s);
  point.load(start.t, {start.state.begin(), start.state.end()}, {start.leading.begin(), start.leading.end()});
  // Other checks report failures of these steps.
  if (!point.prepare().ok() || !point.project().ok() || !point.solve().ok() || !point.extend().ok()) return {};
  N size(1);
  for (std::size_t j = 0; j < p.unknowns(); ++j)
    for (int k = 0; k <= p.d[j] + kOrders; ++k)
      if (const N v = abs(point.coefficient(j, k)); v > size) size = v;
  for (std::size_t i = 0; i < s.redundant.size(); ++i)
    for (int k = 1; k <= kOrders; ++k)
      if (const N v = point.quadrature(i)[k]; is_finite(v) && abs(v) > N(kMiss) * size)
        return {
            OutcomeKind::singular,
            "the constraint '" + s.model->constraints[s.redundant[i]].name +
                "' does not follow from the others: its row depends on theirs at the start, and the motion that they "
                "make leaves it",
            "start elsewhere, where the rows are independent; or, if the constraints agree in their highest "
            "derivatives, write what they say together, such as their difference, in place of one of them"};
  return {};
}

template class Redundant<long double>;
template class Redundant<Quad>;
template class Redundant<Multi>;

}  // namespace anholon
