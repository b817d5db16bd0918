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
  kept_ = point.program().system->constraints;
  std::vector<N> independent;
  for (std::size_t i = 0; i < kept_.size(); ++i) independent.push_back(point.derivative(coordinates_ + i, 0));
  phi_.evaluate(point);
  rows_ = Matrix<N>(constraints_, coordinates_);
  for (std::size_t i = 0; i < rows_.data.size(); ++i) rows_.data[i] = phi_[i];
  return least_multipliers(rows_, kept_, independent);
}

template <Number N>
UndeterminedMultipliers LeastMultipliers<N>::undetermined() const {
  UndeterminedMultipliers found;
  if (rows_.rows == 0) return found;
  Matrix<double> phi(rows_.rows, rows_.cols);
  for (std::size_t i = 0; i < phi.data.size(); ++i) phi.data[i] = to_double(rows_.data[i]);
  IndependentConstraints choice;
  choice.independent = kept_;
  for (std::size_t r = 0; r < constraints_; ++r)
    if (std::find(kept_.begin(), kept_.end(), r) == kept_.end()) choice.redundant.push_back(r);
  found.redundant = choice.redundant;
  found.dependencies = dependencies(phi, choice);
  found.lasts.assign(choice.redundant.size(), false);
  return found;
}

template class LeastMultipliers<double>;
template class LeastMultipliers<long double>;
template class LeastMultipliers<Quad>;
template class LeastMultipliers<Multi>;

}  // namespace anholon
