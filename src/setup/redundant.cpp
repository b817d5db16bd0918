#include "setup/redundant.h"

#include <algorithm>

#include "structure/redundancy.h"

namespace anholon {

// Missed by more than this of the size of the state a constraint no longer follows from the others.
static constexpr double kMiss = 1e-7;

template <Number W>
Redundant<W>::Redundant(Workspace& s, const std::vector<W>& parameters) : s_(s) {
  if (!s.redundant.empty()) outputs_.emplace(s, expressions(), parameters);
}

// The constraints left out, then Phi: the rows of those kept, the rows of those left out.
template <Number W>
Column Redundant<W>::expressions() const {
  const Mechanics& m = *s_.mechanics;
  Column es;
  for (std::size_t r : s_.redundant) es.push_back(m.phi[r]);
  for (const std::vector<std::size_t>* rows : {&s_.system.constraints, &s_.redundant})
    for (std::size_t r : *rows) es.insert(es.end(), m.Phi[r].begin(), m.Phi[r].end());
  return put_masses(*s_.model, es);
}

template <Number W>
Outcome Redundant<W>::hold(const Expansion<W>& point, bool start, double& worst) {
  worst = 0;
  if (!outputs_) return {};
  outputs_->evaluate(point);
  W size(1);
  for (std::size_t a = 0; a < s_.system.coordinates; ++a)
    for (int k = 0; k <= point.program().d[a]; ++k)
      if (W v = abs(point.derivative(a, k)); v > size) size = v;
  for (std::size_t i = 0; i < s_.redundant.size(); ++i) {
    const double miss = to_double(W(abs((*outputs_)[i]) / size));
    worst = std::max(worst, miss);
    if (!(miss <= kMiss)) {
      const std::string name = "the constraint '" + s_.model->constraints[s_.redundant[i]].name + "' ";
      if (start)
        return {OutcomeKind::inconsistent,
                name + "contradicts the others: it is missed by " +
                    number_text(std::abs(to_double((*outputs_)[i])), 3) + " at the start",
                "leave it out, or the one that it contradicts"};
      return {OutcomeKind::singular,
              name + "no longer follows from the others at t = " + number_text(to_double(point.time()), 12),
              "it was redundant at the start only: start elsewhere, or leave out one of the constraints"};
    }
  }
  return {};
}

template <Number W>
std::vector<W> Redundant<W>::multipliers(const Expansion<W>& point) {
  const std::size_t n = s_.system.coordinates, kept = s_.system.constraints.size(), rows = kept + s_.redundant.size();
  std::vector<W> all(s_.model->constraints.size(), W(0)), independent;
  for (std::size_t i = 0; i < kept; ++i) {
    independent.push_back(point.derivative(n + i, 0));
    all[s_.system.constraints[i]] = independent[i];
  }
  if (!outputs_ || multiplier_orders(s_) > 0) return all;
  outputs_->evaluate(point);
  Matrix<W> phi(rows, n);
  for (std::size_t i = 0; i < phi.data.size(); ++i) phi.data[i] = (*outputs_)[s_.redundant.size() + i];
  std::vector<std::size_t> first;
  for (std::size_t i = 0; i < kept; ++i) first.push_back(i);
  const std::vector<W> least = least_multipliers(phi, first, independent);
  for (std::size_t i = 0; i < rows; ++i) all[i < kept ? s_.system.constraints[i] : s_.redundant[i - kept]] = least[i];
  return all;
}

template class Redundant<long double>;
template class Redundant<Quad>;
template class Redundant<Multi>;

}  // namespace anholon
