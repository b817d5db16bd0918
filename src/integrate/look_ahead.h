// Evaluates the equations along the polynomial of the present step: their values, J and its LU at a point ahead.
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
  // Chooses the quadratures that evaluate_watched() evaluates.
  void watch(const std::vector<std::size_t>& quadratures);
  // Loads the motion at this point, without evaluating anything.
  Expansion<N>& load(const W& t, const std::vector<W>& state, const std::vector<W>& leading);
  // Loads the motion at t by the series of the step, in their number type: coefficient(j, k) is that of order k of
  // unknown j, which has orders up to `beyond` + d_j. `h`: the distance of t from the point of the series.
  template <class Coefficient>
  Expansion<N>& load(const N& t, const N& h, int beyond, const Coefficient& coefficient) {
    state_.clear(), leading_.clear();
    for (std::size_t j = 0; j < program_->unknowns(); ++j) {
      const int d = program_->d[j];
      // Horner's scheme computes the polynomial and its derivatives, each divided by a factorial; for nearly all
      // motions the second derivative is the highest.
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
  // Loads the motion and computes J and its LU; returns nullptr if J has no LU. The iteration for the singular value
  // starts anew, so that a run that goes on from here gets the same result.
  Expansion<N>* prepare(const W& t, const std::vector<W>& state, const std::vector<W>& leading);
  // Evaluates what is watched where the motion was loaded last; other quadratures are unknown afterwards.
  void evaluate_watched();
  // Chooses the slots that decide which functions hold, which evaluate_kinks() evaluates.
  void watch_kinks(const std::vector<std::uint32_t>& slots);
  // Evaluates what decides which functions hold, where the motion was loaded last; no other slots are known afterwards.
  void evaluate_kinks() { there_->evaluate(kinks_); }
  // Returns a quadrature where the motion was loaded last, after evaluating the formulas; nullopt if it has no value
  // there.
  std::optional<N> quadrature(std::size_t i);
  // The magnitude of the terms of this quadrature.
  N quadrature_terms(std::size_t i);
  // The magnitude of everything that enters the quadrature, down to the unknowns, each of which may cause its
  // round-off.
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

// The present step, for the classes that judge it.
template <Number N>
struct PresentStep {
  using W = Wider<N>;
  const MotionTrack<N>& track;
  Expander<N>& expander;
  LookAhead<N>& look;

  // The time of the expansion. While the stepper looks back, the motion is farther on.
  const W& t() const { return track.begun().at.motion.t; }
  const Expansion<N>& series() const { return expander.series(); }
  // Loads the motion at h beyond the expansion.
  Expansion<N>& load(const W& h) {
    std::vector<W> state, leading;
    expander.state_at(track, h, state, leading);
    return look.load(t() + h, state, leading);
  }
  // Loads the motion by the series, which is fast; for values that are compared with the series.
  Expansion<N>& load_series(const W& h) {
    return look.load(convert<N>(W(t() + h)), convert<N>(h), expander.order() - 1,
                     [&](std::size_t j, int k) { return expander.coefficient(j, k); });
  }
  Expansion<N>* prepare(const W& h) {
    std::vector<W> state, leading;
    expander.state_at(track, h, state, leading);
    return look.prepare(t() + h, state, leading);
  }
  // Returns a quadrature on the polynomial itself, by its formula without derivatives beyond the leading ones; nullopt
  // if it has no finite value.
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
