#include "ensemble/reduce/formula_summary.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "ensemble/reduce/growth.h"
#include "integrate/motion_state.h"
#include "integrate/series/sign_change.h"

namespace anholon {

bool agrees(double is, double foretold, double size, double tolerance) {
  constexpr double kRelative = 1e3, kLeast = 1e-9, kAbsolute = 10;
  return std::abs(is - foretold) <= std::max(kRelative * tolerance, kLeast) * size + kAbsolute * tolerance;
}

void FormulaSummary::ask(Reduction::Kind kind) {
  greatest_ = greatest_ || kind == Reduction::Kind::greatest;
  least_ = least_ || kind == Reduction::Kind::least;
  mean_ = mean_ || kind == Reduction::Kind::mean;
}

// Adds the integral of the polynomial c over x in [0, h], one unit of x being `scale` in time.
void FormulaSummary::integrate(const std::vector<double>& c, double h, double scale) {
  double over = 0;
  for (std::size_t k = c.size(); k-- > 0;) over = over * h + c[k] / static_cast<double>(k + 1);
  add_compensated(integral_, carry_, over * h * scale);
  weight_ += std::abs(over * h * scale);
}

void FormulaSummary::see(std::vector<double>& c, double h, const std::function<FormulaValue(double)>& f, bool kink) {
  // A polynomial of a formula that is never negative may be so by its round-off, and beyond a kink it is another
  // formula. The formula itself decides near zero and at kinks.
  constexpr double kNearZero = 1e-9, kRoundOff = 1e-12;
  const int degree = static_cast<int>(c.size()) - 1;
  last_ = value_at(c.data(), degree, h);
  if (mean_) integrate(c, h, 1);
  double size = 0, power = 1;
  for (const double x : c) size += std::abs(x * power), power *= h;
  const auto greatest = [&](double known, double sign) {
    const std::optional<double> at = place_above(c.data(), degree, h, known);
    if (!at) return known;
    const double foretold = value_at(c.data(), degree, *at);
    // At the beginning the polynomial is the formula.
    if (*at == 0 || (std::abs(foretold) > kNearZero * size && !(kink && *at == h))) return foretold;
    // An extreme that is exactly 0 is the bound of such a formula.
    if (known == 0 && std::abs(foretold) <= kRoundOff * size) return known;
    const auto value = [&](double x) { return sign * f(x).value; };
    const double is = greatest_near(value, h, *at);
    // The round-off of a formula such as acos(x) where x comes to 1 is much greater than that of its polynomial.
    const bool known_better = std::abs(is - foretold) <= kNearZero * size || is > value(*at);
    return std::isfinite(is) && known_better ? std::max(is, known) : foretold;
  };
  if (greatest_) most_ = greatest(most_, 1);
  if (!least_) return;
  for (double& x : c) x = -x;
  fewest_ = 0 - greatest(-fewest_, -1);  // 0, not -0
}

double FormulaSummary::value(Reduction::Kind kind, double length) const {
  // A step so short that its values are round-off, as between the last impacts of a ball, does not weigh.
  constexpr double kNegligible = 1e-10;
  constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
  if (lost_ || std::isnan(last_)) return kNone;
  if (kind == Reduction::Kind::greatest) return greatest_ ? most_ : kNone;
  if (kind == Reduction::Kind::least) return least_ ? fewest_ : kNone;
  if (!(doubt_ <= kNegligible * weight_)) return kNone;
  return length == beyond_ ? last_ : (integral_ + carry_) / (length - beyond_);
}

// ---- by values --------------------------------------------------------------------------------------------------------

// Halves a step until an interpolation of its values is as good as the tolerance. At a moment where the formula has no
// value, or no derivatives, the pieces become as short as the time can show, and their values represent the formula.
class FormulaSummary::ByValues {
 public:
  ByValues(FormulaSummary& summary, const std::function<FormulaValue(double)>& f, double h,
           const std::vector<double>& hidden, double tolerance)
      : s_(summary), f_(f), h_(h), hides_(!hidden.empty()), tolerance_(tolerance), left_(pieces_between(hidden, h)) {}

  void walk() {
    for (int pieces = 0; !left_.empty() && !s_.lost_;) {
      const Piece p = left_.back();
      left_.pop_back();
      const bool divisible = p.divisible() && pieces < kMostPieces;
      if (p.depth < kFirst && divisible) {
        halve(p, 0);
        continue;
      }
      ++pieces;
      see(p, divisible);
    }
    judge_deep();
    judge_rest();
    if (const double end = f_(h_).value; std::isfinite(end)) s_.last_ = end;
  }

 private:
  // A part of the step.
  struct Piece {
    double from, to;
    int depth;         // the number of halvings
    double error = 0;  // of the interpolation over twice the piece; 0 if there is none

    static constexpr int kDeepest = 48;
    double middle() const { return from + (to - from) / 2; }
    bool divisible() const { return depth < kDeepest && middle() != from && middle() != to; }
  };

  // The greatest and the least value of deep pieces that are next to each other, and their places.
  struct Deep {
    double high = -kInfinity, low = kInfinity, high_at = 0, low_at = 0;
    double reach = 0;  // the longest of the pieces
  };

  static constexpr int kFirst = 2, kTiny = 30, kShort = 20, kDeep = 16, kLongWithout = 8, kMostPieces = 1000;
  static constexpr double kInfinity = std::numeric_limits<double>::infinity();

  // Returns the pieces between these points, the first one last.
  static std::vector<Piece> pieces_between(const std::vector<double>& points, double h) {
    std::vector<Piece> list;
    double end = h;
    for (std::size_t k = points.size(); k-- > 0; end = points[k]) list.push_back({points[k], end, 0});
    list.push_back({0, end, 0});
    return list;
  }

  // Puts the halves of a piece before the pieces that are left; `error`: of the interpolation over the piece.
  void halve(const Piece& p, double error) {
    left_.push_back({p.middle(), p.to, p.depth + 1, error});
    left_.push_back({p.from, p.middle(), p.depth + 1, error});
  }

  void see(const Piece& p, bool divisible) {
    const Interpolation there(f_, p.from, p.to);
    size_ = std::max(size_, there.size());
    if (p.depth <= kFirst) noise_ = std::min(noise_, there.noise());
    if (p.depth < kDeep) judge_deep();
    if (there.without_value() > 0 && !has_value(there, p, divisible)) return;
    const auto [lowest, highest] = std::minmax_element(there.values().begin(), there.values().end());
    const bool good = (there.good(tolerance_ * size_) || there.is_noisy(p.error)) && ends_as(there, p);
    if (!good && divisible && (there.without_value() > 0 || matters(*lowest, *highest, p.to - p.from))) {
      halve(p, there.error());
      return;
    }
    if (s_.lost_) return;
    if (p.depth >= kDeep) add_deep(there, p);
    s_.last_ = there.values().back();
    weight_ += std::abs(there.mean() * (p.to - p.from));
    if (good) {
      there.polynomial(polynomial_);
      if (s_.mean_) s_.integrate(polynomial_, 1, p.to - p.from);
      see_extremes(p, *lowest, *highest);
      return;
    }
    add_compensated(s_.integral_, s_.carry_, there.mean() * (p.to - p.from));
    s_.weight_ += std::abs(there.mean() * (p.to - p.from));
    in_doubt_ += (*highest - *lowest) * std::abs(p.to - p.from);
    if (p.depth >= kDeep) return;
    most_ = std::max(most_, *highest), fewest_ = std::min(fewest_, *lowest);
  }

  // Takes the values of the formula where its polynomial has its extremes. A polynomial of a formula that has no
  // derivative at an end of the piece may go beyond the formula there.
  void see_extremes(const Piece& p, double lowest, double highest) {
    const int degree = static_cast<int>(polynomial_.size()) - 1;
    const auto greatest = [&](double known, double seen, double sign) {
      known = std::max(known, seen);
      const std::optional<double> u = place_above(polynomial_.data(), degree, 1, known);
      if (!u) return known;
      const double at = *u == 1 ? p.to : p.from + (p.to - p.from) * *u;
      const double is = greatest_near([&](double x) { return sign * f_(x).value; }, h_, at);
      return std::isfinite(is) ? std::max(is, known) : known;
    };
    if (s_.greatest_) s_.most_ = greatest(s_.most_, highest, 1);
    if (!s_.least_) return;
    for (double& x : polynomial_) x = -x;
    s_.fewest_ = 0 - greatest(-s_.fewest_, -lowest, -1);
  }

  // Returns false if the piece, on which some values are missing, is seen by that: it is short, or the motion has no
  // solution there. The summary is lost if the formula has no value on a longer piece.
  bool has_value(const Interpolation& there, const Piece& p, bool divisible) {
    // A motion that stops has no solution at the end of its last step.
    const bool all_beyond = there.beyond_motion() == Interpolation::kPoints && p.depth >= kLongWithout;
    if (all_beyond) s_.beyond_ += p.to - p.from;
    // Round-off may take the values away over a short piece, such as that of sqrt(z) where z comes to 0.
    const bool none_for_short = there.without_value() == Interpolation::kPoints && p.depth >= kShort;
    if (p.depth >= kTiny || all_beyond || none_for_short) {
      const double length = std::abs(p.to - p.from);
      for (const double v : there.values()) {
        if (std::isfinite(v)) in_doubt_ = std::max(in_doubt_, std::abs(v) * length);
      }
      add_deep(there, p);
      return false;
    }
    s_.lost_ = !divisible || (p.depth >= kLongWithout && there.beyond_motion() == 0 &&
                              there.without_value() == Interpolation::kPoints);
    return true;
  }

  // True if the interpolation ends in the values of the formula, in a step in which functions may hide their variation.
  bool ends_as(const Interpolation& there, const Piece& p) {
    if (!hides_) return true;
    there.polynomial(polynomial_);
    const double first = f_(p.from).value, last = f_(p.to).value;
    return agrees(first, polynomial_[0], std::max(there.size(), std::abs(first)), tolerance_) &&
           agrees(last, value_at(polynomial_.data(), Interpolation::kPoints - 1, 1.0),
                  std::max(there.size(), std::abs(last)), tolerance_);
  }

  // True if a piece may contain an extreme or weighs in the mean. If a value is a small difference, no interpolation of
  // its round-off is good, and pieces that do not matter are not halved.
  bool matters(double lowest, double highest, double length) const {
    const double spread = highest - lowest;
    return !(spread * std::abs(length) <= tolerance_ * size_ * std::abs(h_)) ||
           (s_.greatest_ && highest + spread > std::max(s_.most_, most_)) ||
           (s_.least_ && lowest - spread < std::min(s_.fewest_, fewest_));
  }

  void add_deep(const Interpolation& there, const Piece& p) {
    deep_.reach = std::max(deep_.reach, std::abs(p.to - p.from));
    for (int j = 0; j < Interpolation::kPoints; ++j) {
      const double v = there.values()[static_cast<std::size_t>(j)], at = Interpolation::point(j, p.from, p.to);
      if (v > deep_.high) deep_.high = v, deep_.high_at = at;
      if (v < deep_.low) deep_.low = v, deep_.low_at = at;
    }
  }

  // Looks at the growth of the formula towards the places of the extremes of the deep pieces.
  void judge_deep() {
    const Deep deep = std::exchange(deep_, Deep{});
    if (s_.lost_ || deep.high < deep.low) return;
    const std::function<double(double)> f = [this](double x) { return f_(x).value; };
    for (const auto& [sign, at] : {std::pair(1.0, deep.high_at), std::pair(-1.0, deep.low_at)}) {
      const Growth g = growth_at(f, sign, h_, at, deep.reach, noise_);
      if (std::isfinite(g.extreme))
        s_.most_ = std::max(s_.most_, g.extreme), s_.fewest_ = std::min(s_.fewest_, g.extreme);
      s_.greatest_ = s_.greatest_ && !g.no_upper;
      s_.least_ = s_.least_ && !g.no_lower;
      in_doubt_ += g.integrable ? g.rest : kInfinity;
    }
  }

  // Lets the values of the pieces count that are too many to be halved. The formula counts as one without a bound if
  // they go far beyond all others, and its integral diverges if they weigh in spite of the length of the pieces.
  void judge_rest() {
    const auto far_beyond = [this](double x, double others) {
      constexpr double kFar = 1e-3;
      return std::isfinite(others) && x - others > kFar * size_;
    };
    if (most_ > s_.most_) s_.greatest_ = s_.greatest_ && !far_beyond(most_, s_.most_), s_.most_ = most_;
    if (fewest_ < s_.fewest_) s_.least_ = s_.least_ && !far_beyond(-fewest_, -s_.fewest_), s_.fewest_ = fewest_;
    // Pieces that do not matter are as long as the tolerance allows.
    constexpr double kMostDoubt = 1e-6, kTolerances = 10, kCoarse = 0.1;
    if (in_doubt_ > std::max(kMostDoubt, std::min(kTolerances * tolerance_, kCoarse)) * weight_) s_.doubt_ += in_doubt_;
  }

  FormulaSummary& s_;
  const std::function<FormulaValue(double)>& f_;
  double h_;
  bool hides_;
  double tolerance_;
  std::vector<Piece> left_;  // the next one last
  std::vector<double> polynomial_;
  double size_ = 0, weight_ = 0;                   // of what is seen
  double noise_ = kInfinity;                       // the least round-off of the first pieces
  double most_ = -kInfinity, fewest_ = kInfinity;  // of the pieces that are too many to be halved
  double in_doubt_ = 0;                            // of the integral
  Deep deep_;
};

void FormulaSummary::see_by_values(const std::function<FormulaValue(double)>& f, double h,
                                   const std::vector<double>& hidden, double tolerance) {
  ByValues(*this, f, h, hidden, tolerance).walk();
}

}  // namespace anholon
