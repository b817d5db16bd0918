// The equations along the polynomial of the present step: their values, J and its LU at a point ahead.
#pragma once
#include <algorithm>
#include <memory>
#include <optional>

#include "integrate/expander.h"

namespace anholon {

template <Number N>
class LookAhead {
 public:
  using W = Wider<N>;
  LookAhead(const Program& program, const std::vector<N>& parameters) : program_(&program), parameters_(parameters) {}

  void set_parameters(const std::vector<N>& parameters) {
    parameters_ = parameters;
    if (there_) there_->set_parameters(parameters);
  }
  // These quadratures are those of evaluate_watched().
  void watch(const std::vector<std::size_t>& quadratures);
  // The motion there, without any values.
  Expansion<N>& load(const W& t, const std::vector<W>& state, const std::vector<W>& leading);
  // The same by the series of the step, in their numbers: coefficient(j, k) is that of order k of unknown j, which has
  // orders up to `beyond` + d_j. `h`: from where the series begin to t.
  template <class Coefficient>
  Expansion<N>& load(const N& t, const N& h, int beyond, const Coefficient& coefficient) {
    state_.clear(), leading_.clear();
    for (std::size_t j = 0; j < program_->unknowns(); ++j) {
      const int d = program_->d[j];
      // Horner's scheme for the polynomial and its derivatives, each divided by a factorial; the second is the highest
      // of nearly all motions.
      N value(0), first(0), second(0);
      higher_.assign(static_cast<std::size_t>(std::max(0, d - 2)), N(0));
      for (int i = h == N(0) ? d : beyond + d; i >= 0; --i) {
        for (std::size_t k = higher_.size(); k-- > 0;) higher_[k] = higher_[k] * h + (k > 0 ? higher_[k - 1] : second);
        second = second * h + first;
        first = first * h + value;
        value = value * h + coefficient(j, i);
      }
      N factorial(1);
      for (int k = 0; k <= d; ++k) {
        if (k > 1) factorial *= N(k);
        const N& x = k == 0 ? value : k == 1 ? first : k == 2 ? second : higher_[static_cast<std::size_t>(k - 3)];
        (k < d ? state_ : leading_).push_back(x * factorial);
      }
    }
    return load(t);
  }
  // … with J and its LU; null if J has none. What was met elsewhere says nothing there: the iteration for the singular
  // value starts anew, so that a run that goes on finds the same.
  Expansion<N>* prepare(const W& t, const std::vector<W>& state, const std::vector<W>& leading);
  // What is watched where the motion was loaded last; of the quadratures these alone are known then.
  void evaluate_watched();
  // These slots decide which functions hold, and are those of evaluate_kinks().
  void watch_kinks(const std::vector<std::uint32_t>& slots);
  // What decides which functions hold, where the motion was loaded last; no other slots are known then.
  void evaluate_kinks() { there_->evaluate(kinks_); }
  // A quadrature where the motion was loaded last, and the formulas evaluated; nullopt if it has no value there.
  std::optional<N> quadrature(std::size_t i);
  // The magnitude of the terms of this value.
  N quadrature_terms(std::size_t i);
  // The magnitude of all that the value is made of, down to the unknowns: its round-off may come from there.
  N quadrature_made_of(std::size_t i);

 private:
  void evaluate_quadratures();
  Expansion<N>& load(const N& t);

  const Program* program_;
  std::vector<N> parameters_;
  std::vector<std::uint32_t> watched_;   // the slots of what is watched, and
  std::vector<std::uint32_t> kinks_;     // of what decides which functions hold, each with all that they are made of
  std::unique_ptr<Expansion<N>> there_;  // made when it is first asked for
  std::vector<N> state_, leading_, higher_, sizes_;
  bool quadratures_known_ = false;
};

// What those who judge a step see of it.
template <Number N>
struct PresentStep {
  using W = Wider<N>;
  const MotionTrack<N>& track;
  Expander<N>& expander;
  LookAhead<N>& look;

  // Where the expansion was made. While the stepper looks back, the motion has come farther.
  const W& t() const { return track.begun().at.motion.t; }
  const Expansion<N>& series() const { return expander.series(); }
  // h beyond the expansion.
  Expansion<N>& load(const W& h) {
    std::vector<W> state, leading;
    expander.state_at(track, h, state, leading);
    return look.load(t() + h, state, leading);
  }
  // By the series, which is fast: for what is compared with them.
  Expansion<N>& load_series(const W& h) {
    return look.load(convert<N>(W(t() + h)), convert<N>(h), expander.order() - 1,
                     [&](std::size_t j, int k) { return expander.coefficient(j, k); });
  }
  Expansion<N>* prepare(const W& h) {
    std::vector<W> state, leading;
    expander.state_at(track, h, state, leading);
    return look.prepare(t() + h, state, leading);
  }
  // Of the polynomial itself, in formulas that follow from it without derivatives beyond the leading ones; nullopt if
  // it has no finite value.
  std::optional<N> quadrature(std::size_t i, const N& h) {
    const std::optional<N> value = prepare(convert<W>(h)) ? look.quadrature(i) : std::nullopt;
    return value && is_finite(*value) ? value : std::nullopt;
  }
};

extern template class LookAhead<double>;
extern template class LookAhead<long double>;
extern template class LookAhead<Quad>;
extern template class LookAhead<Multi>;

}  // namespace anholon
