#include "setup/outputs/choice_watch.h"

#include "structure/redundancy.h"

namespace anholon {

static Column expressions(Workspace& in, const Elimination& e, const std::vector<std::size_t>& rows) {
  Column es;
  if (!e.pivots().empty()) es = put_masses(*in.model, e.in_coordinates(e.on(e.pivots())));
  for (std::size_t r : rows)
    for (Expr entry : in.mechanics->Phi[r]) es.push_back(put_masses(*in.model, entry));
  return es;
}

template <Number W>
ChoiceWatch<W>::ChoiceWatch(Workspace& in, const Elimination& e, const std::vector<std::size_t>& rows,
                            const std::vector<W>& parameters)
    : of_elimination_(e.pivots().size()), rows_(rows), outputs_(in, expressions(in, e, rows), parameters) {
  for (std::size_t r : rows) orders_.push_back(in.mechanics->order[r]);
}

template <Number W>
std::vector<double> ChoiceWatch<W>::at(const Expansion<W>& point) {
  outputs_.evaluate(point);
  std::vector<double> sizes;
  for (std::size_t i = 0; i < of_elimination_; ++i) sizes.push_back(std::abs(to_double(outputs_[i])));
  if (rows_.empty()) return sizes;
  const std::size_t n = point.program().system->coordinates;
  Matrix<double> phi(rows_.size(), n);
  for (std::size_t i = 0; i < phi.data.size(); ++i) phi.data[i] = to_double(outputs_[of_elimination_ + i]);
  const IndependentConstraints choice = choose_independent(phi, orders_);
  sizes.push_back(choice.redundant.empty() ? choice.weakest : 0.0);
  return sizes;
}

template class ChoiceWatch<long double>;
template class ChoiceWatch<Quad>;
template class ChoiceWatch<Multi>;

}  // namespace anholon
