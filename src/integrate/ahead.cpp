// The part of the stepper that looks along the polynomial of the present step: where J may become singular, or its
// branch end.
#include <algorithm>
#include <cmath>

#include "integrate/taylor.h"

namespace anholon {

template <Number N>
void Stepper<N>::polynomial(const W& h, std::vector<W>& increments, std::vector<W>& leading) const {
  const Program& p = *program_;
  increments.assign(expansion_.state_size(), W(0));
  leading.assign(p.unknowns(), W(0));
  for (std::size_t j = 0; j < p.unknowns(); ++j) {
    const int d = p.d[j], top = degree(j);
    for (int k = 0; k <= d; ++k) {
      // sum_i x_(k+i) (k+i)!/i! h^i, without the term of order 0 (that is the state itself).
      W s(0);
      for (int i = top - k; i >= 1; --i) {
        W factor(1);
        for (int f = 1; f <= k; ++f) factor = factor * W(i + f);
        s = (s + dense(j, k + i) * factor) * h;
      }
      if (k < d)
        increments[expansion_.offset(j) + static_cast<std::size_t>(k)] = s;
      else
        leading[j] = point_.derivative(j, k) + s;
    }
  }
}

// State and leading derivatives h beyond where the expansion was made.
template <Number N>
void Stepper<N>::on_polynomial(const W& h, std::vector<W>& state, std::vector<W>& leading) const {
  if (by_kernel_) {
    settle();
    advance_kernel(h);
    if (!mapped()) return advanced_by_kernel(h, expanded_ ? state_ : base_state_, state, leading);
    std::vector<W> own_base, own, own_leading;
    fetch_own_base(own_base);
    advanced_by_kernel(h, own_base, own, own_leading);
    read(begun_[now_].t + h, own, state);
    leading = leading_at_base();
    return;
  }
  std::vector<W> increments;
  polynomial(h, increments, leading);
  point().state(state);
  for (std::size_t i = 0; i < state.size(); ++i) state[i] += increments[i];
}

// J and its LU at t + h on the polynomial, or nothing where it has none. What was met elsewhere says nothing there: the
// iteration for the singular value starts anew, so that a run that goes on finds the same.
template <Number N>
Expansion<N>* Stepper<N>::ahead(const W& h) {
  std::vector<W> leading, state;
  on_polynomial(h, state, leading);
  return prepared(t_ + h, state, leading);
}

template <Number N>
Expansion<N>* Stepper<N>::prepared(const W& t, const std::vector<W>& state, const std::vector<W>& leading) {
  Expansion<N>& there = loaded_ahead(t, state, leading);
  there.set_weakest_direction({});
  return there.prepare().ok() ? &there : nullptr;
}

template <Number N>
Expansion<N>& Stepper<N>::loaded_ahead(const W& t, const std::vector<W>& state, const std::vector<W>& leading) {
  if (!ahead_) ahead_ = std::make_unique<Expansion<N>>(*program_, parameters_, 1);
  convert_all(state, narrow_state_);
  convert_all(leading, narrow_leading_);
  ahead_->load(convert<N>(t), narrow_state_, narrow_leading_);
  return *ahead_;
}

// Of the polynomial itself, in formulas that follow from it without derivatives beyond the leading ones.
template <Number N>
std::optional<N> Stepper<N>::quadrature_ahead(std::size_t i, const N& h) {
  const std::optional<N> value = ahead(convert<W>(h)) ? quadrature_there(i) : std::nullopt;
  return value && is_finite(*value) ? value : std::nullopt;
}

// … where that was looked at last.
template <Number N>
std::optional<N> Stepper<N>::quadrature_there(std::size_t i) {
  ahead_->evaluate_quadratures();
  const N value = ahead_->quadrature(i)[0];
  return value == value ? std::optional<N>(value) : std::nullopt;
}

template <Number N>
bool Stepper<N>::near_in_branch(const W& h) {
  const Expansion<N>* there = ahead(h);
  return there && near(expansion_, *there);
}

// Steps end where J may become singular, and shrink towards a singular point.
template <Number N>
typename Stepper<N>::W Stepper<N>::on_the_branch(W h) {
  // From a horizon of e^300 (a polynomial motion) to far below any step.
  constexpr int kMostHalvings = 600;
  if (record_.branch_step > W(0) && abs(h) > record_.branch_step * W(4))
    h = h > W(0) ? record_.branch_step * W(4) : record_.branch_step * W(-4);
  for (int k = 0; k < kMostHalvings && !(near_in_branch(h) && near_in_branch(h * W(0.5))); ++k) h = h * W(0.5);
  record_.branch_step = abs(h);
  return h;
}

template <Number N>
std::optional<Mode<N>> Stepper<N>::mode_at(const W& t, const std::vector<W>& state) {
  return mode_of(prepared(t, state, {}));
}

template <Number N>
std::optional<Mode<N>> Stepper<N>::mode_of(Expansion<N>* there) {
  if (!there) return std::nullopt;
  const N sigma = there->smallest_singular_value();
  return weakest_mode(*there, sigma);
}

// Whether the weakest direction at one point is mapped to the opposite at another: where several singular values pass
// zero together, the weakest direction there is any of theirs.
template <Number N>
static bool reversed(const Mode<N>& from, const Expansion<N>& there) {
  constexpr double kOpposite = -0.5;
  const Matrix<N>& J = there.system_jacobian();
  double dot = 0, before = 0, after = 0;
  for (std::size_t i = 0; i < J.rows; ++i) {
    N image(0), largest(0);
    for (std::size_t j = 0; j < J.cols; ++j) {
      addmul(image, J(i, j), from.v[j]);
      if (N x = abs(J(i, j)); x > largest) largest = x;
    }
    const double a = to_double(from.image[i]), b = largest > N(0) ? to_double(N(image / largest)) : 0;
    dot += a * b, before += a * a, after += b * b;
  }
  return dot < kOpposite * std::sqrt(before * after);
}

// How far from t_ the first singular point is that is met within h; nothing if there is none.
template <Number N>
std::optional<typename Stepper<N>::W> Stepper<N>::singular_within(const W& h) {
  constexpr double kFaster = 0.6, kLonger = 1.5, kVanished = 1e-6;
  constexpr int kBisections = 60, kRoundoffs = 4096;
  // A singular value that vanishes within the step has fallen by more than half in one as long; what it was is not
  // known after steps by the kernel.
  const bool suspected = by_kernel_ || suspected_ || record_.last_step == W(0) ||
                         sigma_ < record_.sigma_before * N(kFaster) || abs(h) > record_.last_step * W(kLonger);
  if (!suspected) return std::nullopt;
  settle();
  const std::size_t n = program_->system->coordinates;
  const std::optional<Mode<N>> here = by_kernel_ ? mode_at(t_, state_) : weakest_mode(expansion_, sigma_);
  if (!here) return std::nullopt;
  Mode<N> low = *here;
  const N start = low.sigma;
  const auto passed = [&](const Mode<N>& at, Expansion<N>* there) {
    const std::optional<Mode<N>> m = mode_of(there);
    return m && (crossed(at, *m, n) || reversed(at, *there));
  };
  if (!passed(low, ahead(h))) return std::nullopt;
  W from(0), to = h;
  for (int k = 0; k < kBisections; ++k) {
    const W middle = from + (to - from) * W(0.5);
    if (middle == from || middle == to) break;
    Expansion<N>* there = ahead(middle);
    std::optional<Mode<N>> m = mode_of(there);
    if (!m) return middle;
    if (crossed(low, *m, n) || reversed(low, *there))
      to = middle;
    else
      from = middle, low = std::move(*m);
  }
  // A step that begins beside the singular point finds a value there that is round-off, however small it was.
  const N roundoff = unit_roundoff<N>() * N(kRoundoffs);
  return low.sigma < start * N(kVanished) || low.sigma < roundoff ? std::optional<W>(from) : std::nullopt;
}

#define INSTANTIATE(N)                                                                                                 \
  template void Stepper<N>::polynomial(const W&, std::vector<W>&, std::vector<W>&) const;                              \
  template void Stepper<N>::on_polynomial(const W&, std::vector<W>&, std::vector<W>&) const;                           \
  template Expansion<N>* Stepper<N>::ahead(const W&);                                                                  \
  template Expansion<N>* Stepper<N>::prepared(const W&, const std::vector<W>&, const std::vector<W>&);                 \
  template Expansion<N>& Stepper<N>::loaded_ahead(const W&, const std::vector<W>&, const std::vector<W>&);             \
  template std::optional<N> Stepper<N>::quadrature_ahead(std::size_t, const N&);                                       \
  template std::optional<N> Stepper<N>::quadrature_there(std::size_t);                                                 \
  template bool Stepper<N>::near_in_branch(const W&);                                                                  \
  template Wider<N> Stepper<N>::on_the_branch(W);                                                                      \
  template std::optional<Mode<N>> Stepper<N>::mode_at(const W&, const std::vector<W>&);                                \
  template std::optional<Mode<N>> Stepper<N>::mode_of(Expansion<N>*);                                                  \
  template std::optional<Wider<N>> Stepper<N>::singular_within(const W&);
INSTANTIATE(double)
INSTANTIATE(long double)
INSTANTIATE(Quad)
INSTANTIATE(Multi)
#undef INSTANTIATE

}  // namespace anholon
