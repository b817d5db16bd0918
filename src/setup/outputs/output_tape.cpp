#include "setup/outputs/output_tape.h"

#include "structure/redundancy.h"

namespace anholon {

static Column all_rows(const Workspace& s) {
  Column es;
  for (const Column& row : s.mechanics->Phi) es.insert(es.end(), row.begin(), row.end());
  return put_masses(*s.model, es);
}

template <Number N>
LeastMultipliers<N>::LeastMultipliers(Workspace& s, const std::vector<N>& parameters)
    : coordinates_(s.system.coordinates), constraints_(s.model->constraints.size()), phi_(s, all_rows(s), parameters) {}

template <Number N>
std::vector<N> LeastMultipliers<N>::at(const Expansion<N>& point) {
  const std::vector<std::size_t>& kept = point.program().system->constraints;
  std::vector<N> independent;
  for (std::size_t i = 0; i < kept.size(); ++i) independent.push_back(point.derivative(coordinates_ + i, 0));
  phi_.evaluate(point);
  Matrix<N> phi(constraints_, coordinates_);
  for (std::size_t i = 0; i < phi.data.size(); ++i) phi.data[i] = phi_[i];
  return least_multipliers(phi, kept, independent);
}

template class LeastMultipliers<double>;
template class LeastMultipliers<long double>;
template class LeastMultipliers<Quad>;
template class LeastMultipliers<Multi>;

}  // namespace anholon
