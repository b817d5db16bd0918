#include "observe/defect.h"

#include <algorithm>

#include "base/assert.h"

namespace anholon {

namespace {

// A step is halved this often before a remainder that is too large is accepted as it is.
constexpr int kMostHalvings = 7;
// Beside a kink there is no remainder. The piece there is halved until its bounds are no larger than those of the other
// pieces, at most so often and into so many pieces.
constexpr int kMostHalvingsAtKinks = 60, kMostPieces = 200;

// Returns the polynomials about begin + by, by repeated Horner schemes.
BallSeries shifted(BallSeries x, const Ball& by) {
  for (std::vector<Ball>& c : x)
    for (std::size_t i = 0; i + 1 < c.size(); ++i)
      for (std::size_t k = c.size() - 1; k-- > i;) addmul(c[k], by, c[k + 1]);
  return x;
}

// True if the bound a is larger than the bound b. The balls are compared as intervals about 0, because the balls of
// remainders contain 0.
bool reaches_beyond(const Ball& a, const Ball& b) { return a.symmetric().contains_inside(b.symmetric()); }

}  // namespace

Defect::Defect(Workspace& s, std::size_t times, const Ball& begin, const Ball& end, long significand)
    : d_(s.structure.d), times_(times), bits_(2 * significand + 32), begin_(begin), end_(end), residuals_(s, bits_) {
  const BallScope precision(bits_);
  quiet_ = Ball(Rational(1, mpz_class(1) << static_cast<unsigned long>(significand)));
}

Defect::PieceBounds Defect::at_time(const DenseStep& step, const Ball& time) {
  residuals_.evaluate(shifted(step.coefficients, time - step.begin), time, 0);
  PieceBounds b;
  const std::size_t n = residuals_.coordinates();
  const std::vector<int>& hidden = residuals_.hidden();
  for (std::size_t a = 0; a < n; ++a) b.newton = max(b.newton, abs(residuals_.residual(a)[0]));
  const BallSeries delta = residuals_.correction(1);
  for (std::size_t a = 0; a < n; ++a) b.projected = max(b.projected, abs(residuals_.corrected(a, 0, delta)));
  const Ball scale = residuals_.newton_scale();
  b.newton /= scale;
  b.projected /= scale;
  for (std::size_t r = 0; r < hidden.size(); ++r)
    for (std::size_t k = 0; k <= static_cast<std::size_t>(hidden[r]); ++k) {
      const Ball factor = rising(0, k), value = residuals_.residual(n + r)[k] * factor;
      b.constraints = max(b.constraints, abs(value) / max(Ball(1), residuals_.terms(n + r, k) * factor));
    }
  return b;
}

Defect::PieceBounds Defect::over(const BallSeries& centered, const Ball& center, const Ball& radius) {
  int top = 1;
  for (const std::vector<Ball>& c : centered) top = std::max(top, static_cast<int>(c.size()));
  const std::size_t last = static_cast<std::size_t>(top);
  std::vector<Ball> power(last + 1, Ball(1));
  for (std::size_t k = 1; k <= last; ++k) power[k] = power[k - 1] * radius;

  // The polynomials about the center come first, then the coefficients that are valid on the whole interval.
  const std::size_t n = residuals_.coordinates();
  const std::vector<int>& hidden = residuals_.hidden();
  struct Part {
    std::size_t root, derivative;
    bool projected;
    Ball polynomial, remainder, value;  // value: enclosed on the whole interval
  };
  std::vector<Part> parts;
  for (std::size_t a = 0; a < n; ++a)
    for (const bool projected : {false, true}) parts.push_back({a, 0, projected, {}, {}, {}});
  for (std::size_t r = 0; r < hidden.size(); ++r)
    for (std::size_t k = 0; k <= static_cast<std::size_t>(hidden[r]); ++k)
      parts.push_back({n + r, k, false, {}, {}, {}});
  BallSeries delta;
  const auto coefficient = [&](const Part& p, std::size_t k) {
    if (p.projected) return abs(residuals_.corrected(p.root, k, delta));
    return abs(residuals_.residual(p.root)[p.derivative + k] * rising(k, p.derivative));
  };
  residuals_.reserve(top);
  residuals_.evaluate(centered, center, top - 1);
  delta = residuals_.correction(last);
  for (Part& p : parts)
    for (std::size_t k = 0; k < last; ++k) p.polynomial += coefficient(p, k) * power[k];
  const Ball spread = radius.symmetric();
  delta = shifted(delta, spread);
  residuals_.evaluate(shifted(centered, spread), center + spread, top);
  for (Part& p : parts) p.remainder = coefficient(p, last) * power[last], p.value = coefficient(p, 0);

  PieceBounds b;
  const Ball newton = residuals_.newton_scale();
  for (const Part& p : parts) {
    Ball scale = p.root >= n ? Ball(1) : newton;
    if (p.root >= n)
      if (const Ball terms = residuals_.terms(p.root, p.derivative) * rising(0, p.derivative); terms.is_finite())
        scale = max(scale, lower_end(terms));
    const Ball taylor = p.polynomial + p.remainder;
    const bool counts = reaches_beyond(p.remainder, p.polynomial) && reaches_beyond(p.remainder / scale, quiet_);
    if (!taylor.is_finite() || counts) b.sharp = false;
    if (!taylor.is_finite()) b.smooth = false;
    // The enclosed values on the interval are a bound, too; beside a kink they are the only one.
    Ball& worst = p.root >= n ? b.constraints : p.projected ? b.projected : b.newton;
    worst = max(worst, (taylor.is_finite() && !reaches_beyond(taylor, p.value) ? taylor : p.value) / scale);
  }
  return b;
}

void Defect::piece(const DenseStep& step, const Ball& begin, const Ball& end, int halvings) {
  const Ball half(Rational(1, 2)), center = (begin + end) * half, radius = abs(end - begin) * half;
  const PieceBounds b = over(shifted(step.coefficients, center - step.begin), center, radius);
  const bool beside_kink =
      !b.smooth && b.is_finite() && halvings < kMostHalvingsAtKinks && pieces_of_step_ < kMostPieces && says_more(b);
  if (b.sharp || (halvings >= kMostHalvings && !beside_kink)) {
    if (!b.smooth && says_more(b)) gave_up_at(center);
    // Shorter pieces lie beside a kink, whose time is rounded, so they may contain the formula of its other side.
    if (b.smooth && halvings <= kMostHalvings) put_larger(b, worst_smooth_);
    return keep(b);
  }
  piece(step, begin, center, halvings + 1);
  piece(step, center, end, halvings + 1);
}

// REQUIRES: the residuals have been evaluated on the piece.
void Defect::gave_up_at(const Ball& center) {
  if (const std::string formula = residuals_.turning(); !formula.empty())
    kink_ = RigorousReport::Kink{formula, center.midpoint_multi().to_double()};
}

void Defect::put_larger(const Bounds& b, Bounds& in) {
  in.newton = max(in.newton, b.newton);
  in.projected = max(in.projected, b.projected);
  in.constraints = max(in.constraints, b.constraints);
}

// True if one of the bounds is larger than those of the earlier pieces.
bool Defect::says_more(const Bounds& b) const {
  return reaches_beyond(b.newton, max(worst_.newton, quiet_)) ||
         reaches_beyond(b.projected, max(worst_.projected, quiet_)) ||
         reaches_beyond(b.constraints, max(worst_.constraints, quiet_));
}

void Defect::keep(const Bounds& b) {
  worst_.newton = max(worst_.newton, b.newton);
  // Any multipliers may be used, so those of the motion may, too.
  worst_.projected = max(worst_.projected, reaches_beyond(b.projected, b.newton) ? b.newton : b.projected);
  worst_.constraints = max(worst_.constraints, b.constraints);
  ++pieces_, ++pieces_of_step_;
}

void Defect::step(const DenseStep& step) {
  for (std::size_t j = 0; j < step.coefficients.size(); ++j)
    ANHOLON_ASSERT(step.coefficients[j].size() >= static_cast<std::size_t>(d_[j]));
  const BallScope precision(bits_);
  // The state at the joint, where the last step ended and this one begins.
  const BallSeries ends = shifted(step.coefficients, step.end - step.begin);
  for (std::size_t j = 0; j < last_.size(); ++j)
    for (std::size_t k = 0; k < static_cast<std::size_t>(d_[j]); ++k) {
      const Ball now = step.coefficients[j][k] * rising(0, k), jump = now - last_[j][k] * rising(0, k);
      joints_ = max(joints_, abs(jump) / max(Ball(1), abs(now)));
    }
  last_ = ends;
  pieces_of_step_ = 0;
  if (times_ == 0) return piece(step, step.begin, step.end, 0);
  for (; reached_ < times_; ++reached_) {
    const Rational part(static_cast<long>(2 * reached_ + 1), static_cast<long>(2 * times_));
    const Ball time = begin_ + (end_ - begin_) * Ball(part);
    if (((time - step.end) * (end_ - begin_)).is_positive()) break;
    keep(at_time(step, time));
  }
}

std::optional<RigorousReport> Defect::report() const {
  if (pieces_ == 0) return std::nullopt;
  // Beside a kink that is no jump the bounds are about as large as those of the other pieces.
  const auto larger = [&](const Ball& all, const Ball& smooth) {
    constexpr int kMuch = 1'000'000;
    return reaches_beyond(all, max(smooth, quiet_) * Ball(kMuch));
  };
  const bool by_kink = larger(worst_.newton, worst_smooth_.newton) ||
                       larger(worst_.projected, worst_smooth_.projected) ||
                       larger(worst_.constraints, worst_smooth_.constraints);
  const auto times = times_ == 0 ? std::nullopt : std::optional(reached_);
  return RigorousReport{times,
                        pieces_,
                        worst_.newton.bound_text(),
                        worst_.projected.bound_text(),
                        worst_.constraints.bound_text(),
                        joints_.bound_text(),
                        bits_,
                        by_kink ? kink_ : std::nullopt};
}

}  // namespace anholon
