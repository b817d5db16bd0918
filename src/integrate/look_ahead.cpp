#include "integrate/look_ahead.h"

#include <utility>

namespace anholon {

template <Number N>
Expansion<N>& LookAhead<N>::load(const W& t, const std::vector<W>& state, const std::vector<W>& leading) {
  convert_all(state, state_);
  convert_all(leading, leading_);
  return load(convert<N>(t));
}

template <Number N>
Expansion<N>& LookAhead<N>::load(const N& t) {
  if (!there_) there_ = std::make_unique<Expansion<N>>(*program_, parameters_, 1);
  quadratures_known_ = false;
  there_->load(t, state_, leading_);
  return *there_;
}

template <Number N>
Expansion<N>* LookAhead<N>::prepare(const W& t, const std::vector<W>& state, const std::vector<W>& leading) {
  Expansion<N>& there = load(t, state, leading);
  there.set_weakest_direction({});
  return there.prepare().ok() ? &there : nullptr;
}

template <Number N>
void LookAhead<N>::watch(const std::vector<std::size_t>& quadratures) {
  std::vector<std::uint32_t> roots;
  for (const std::size_t i : quadratures) roots.push_back(program_->tape.roots[program_->unknowns() + i]);
  watched_ = precedents(program_->tape, roots);
}

template <Number N>
void LookAhead<N>::watch_kinks(const std::vector<std::uint32_t>& slots) {
  kinks_ = slots.empty() ? slots : precedents(program_->tape, slots);
}

template <Number N>
void LookAhead<N>::evaluate_watched() {
  there_->evaluate(watched_);
  quadratures_known_ = true;
}

template <Number N>
void LookAhead<N>::evaluate_quadratures() {
  if (!std::exchange(quadratures_known_, true)) there_->evaluate_quadratures();
}

template <Number N>
N LookAhead<N>::quadrature_terms(std::size_t i) {
  evaluate_quadratures();
  return there_->quadrature_terms(i);
}

template <Number N>
N LookAhead<N>::quadrature_made_of(std::size_t i) {
  evaluate_quadratures();
  there_->machine().made_of(sizes_);
  return sizes_[program_->tape.roots[program_->unknowns() + i]];
}

template <Number N>
std::optional<N> LookAhead<N>::quadrature(std::size_t i) {
  evaluate_quadratures();
  const N value = there_->quadrature(i)[0];
  return value == value ? std::optional<N>(value) : std::nullopt;
}

template class LookAhead<double>;
template class LookAhead<long double>;
template class LookAhead<Quad>;
template class LookAhead<Multi>;

}  // namespace anholon
