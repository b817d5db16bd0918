#include "contact/law/slip_directions.h"

#include <limits>

#include "contact/law/pivoted_equations.h"

namespace anholon {

std::array<long double, 2> slip_rate(const ContactRows& rows, const ContactNumbers& x) {
  std::array<long double, 2> v{};
  for (std::size_t a = 0; a < rows.tangential.size(); ++a) v[a] = dot(rows.tangential[a], x) + rows.tangential_rate[a];
  return v;
}

namespace {

using Real = long double;
using Numbers = ContactNumbers;

bool has_direction_to_find(const ContactRows& rows, const ContactMode& mode) {
  return mode.touch == Touch::slips && !rows.moves && rows.tangential.size() == 2 && rows.rough;
}

// The direction of one slip that begins with two components, with those of the others as they are: the angle at which its
// rate has no part across. Where the slip hardly accelerates, the rate turns much faster than the direction, and the fixed
// point repels; the secant method finds it, or else bisection between angles all around.
class DirectionSearch {
 public:
  DirectionSearch(const ContactProblem& p, ContactModes& modes, std::size_t contact)
      : p_(p), modes_(modes), contact_(contact), first_(modes[contact].direction) {}

  // Leaves the direction in the modes; nullopt if no angle is found.
  std::optional<ContactSolution> find() {
    if (secant() || around()) return f_;
    modes_[contact_].direction = first_;
    return std::nullopt;
  }

 private:
  static constexpr Real kFound = 1e-9L;

  Real across(Real angle) {
    auto& d = modes_[contact_].direction;
    d = {first_[0] * std::cos(angle) - first_[1] * std::sin(angle),
         first_[1] * std::cos(angle) + first_[0] * std::sin(angle)};
    f_ = of_modes(p_, modes_);
    if (!f_) return std::numeric_limits<Real>::quiet_NaN();
    v_ = slip_rate(p_.contacts[contact_], f_->x);
    return v_[1] * d[0] - v_[0] * d[1];
  }

  // Whether the contact is pressed and slips along its direction, at the angle that was tried last.
  bool slips() const {
    const auto& d = modes_[contact_].direction;
    return f_ && f_->normal[contact_] >= 0 && v_[0] * d[0] + v_[1] * d[1] > 0;
  }

  bool secant() {
    constexpr int kMost = 40;
    constexpr Real kStep = 1e-4L, kTurn = 0.5L;
    Real a = kStep, fa = across(a), b = 0, fb = across(b);
    for (int k = 0; k < kMost && fa != fb && std::isfinite(fa) && std::isfinite(fb); ++k) {
      const Real step = std::clamp(fb * (b - a) / (fb - fa), -kTurn, kTurn);
      a = b, fa = fb, b -= step, fb = across(b);
      if (std::abs(fb) <= kFound * std::hypot(v_[0], v_[1]) && slips()) return true;
    }
    return false;
  }

  // A slip that hardly begins does so at angles very near to one of them only.
  bool around() {
    constexpr int kParts = 48;
    const Real part = 2 * std::acos(-1.0L) / kParts;
    Real a = 0, fa = across(a);
    for (int k = 1; k <= kParts; ++k) {
      const Real b = k * part, fb = across(b);
      if (std::isfinite(fa) && std::isfinite(fb) && (fa < 0) != (fb < 0) && slips_between(a, fa, b)) return true;
      a = b, fa = fb;
    }
    return false;
  }

  bool slips_between(Real low, Real f_low, Real high) {
    constexpr int kHalves = 70;
    for (int h = 0; h < kHalves; ++h) {
      const Real middle = low + (high - low) / 2;
      ((across(middle) < 0) == (f_low < 0) ? low : high) = middle;
    }
    return std::abs(across(low)) <= kFound * std::hypot(v_[0], v_[1]) && slips();
  }

  const ContactProblem& p_;
  ContactModes& modes_;
  std::size_t contact_;
  std::array<Real, 2> first_;
  std::optional<ContactSolution> f_;
  std::array<Real, 2> v_{};
};

// The directions of slips that begin together, near a first guess: the angles at which no slip rate has a part across, by
// Newton's method with differences.
class DirectionsTogether {
 public:
  DirectionsTogether(const ContactProblem& p, const ContactModes& modes, const std::vector<std::size_t>& list)
      : p_(p), modes_(modes), list_(list), first_(modes) {}

  std::optional<ContactSolution> find() {
    constexpr int kMost = 40;
    Numbers angles(list_.size(), 0), F = across(angles);
    for (int k = 0; k < kMost && f_; ++k) {
      if (found()) return f_;
      const auto change = newton(angles, F);
      if (!change || !improve(angles, F, *change)) return std::nullopt;
    }
    return std::nullopt;
  }

 private:
  Numbers across(const Numbers& angles) {
    for (std::size_t i = 0; i < list_.size(); ++i) {
      const auto& d = first_[list_[i]].direction;
      const Real cosine = std::cos(angles[i]), sine = std::sin(angles[i]);
      modes_[list_[i]].direction = {d[0] * cosine - d[1] * sine, d[1] * cosine + d[0] * sine};
    }
    f_ = of_modes(p_, modes_);
    Numbers F;
    along_.clear();
    for (const std::size_t c : list_) {
      const auto v = f_ ? slip_rate(p_.contacts[c], f_->x) : std::array<Real, 2>{};
      const auto& d = modes_[c].direction;
      F.push_back(v[1] * d[0] - v[0] * d[1]);
      along_.push_back(v[0] * d[0] + v[1] * d[1]);
    }
    return F;
  }

  bool found() const {
    constexpr Real kFound = 1e-9L;
    for (std::size_t i = 0; i < list_.size(); ++i) {
      const auto v = slip_rate(p_.contacts[list_[i]], f_->x);
      if (!(along_[i] > 0) || f_->normal[list_[i]] < 0 ||
          !(std::hypot(v[0], v[1]) - along_[i] <= kFound * kFound * along_[i]))
        return false;
    }
    return true;
  }

  std::optional<Numbers> newton(const Numbers& angles, const Numbers& F) {
    constexpr Real kStep = 1e-7L;
    PivotedEquations m(list_.size());
    for (std::size_t j = 0; j < list_.size(); ++j) {
      Numbers turned = angles;
      turned[j] += kStep;
      const Numbers there = across(turned);
      if (!f_) return std::nullopt;
      for (std::size_t i = 0; i < list_.size(); ++i) m[i][j] = (there[i] - F[i]) / kStep;
    }
    m.right() = F;
    return m.solve();
  }

  // Takes as much of a change as makes F smaller.
  bool improve(Numbers& angles, Numbers& F, const Numbers& change) {
    constexpr int kHalves = 12;
    constexpr Real kTurn = 0.5L;
    Real part = std::min<Real>(1, kTurn / std::max(largest(change), std::numeric_limits<Real>::min()));
    for (int k = 0; k < kHalves; ++k, part /= 2) {
      Numbers next = angles;
      for (std::size_t i = 0; i < next.size(); ++i) next[i] -= part * change[i];
      const Numbers there = across(next);
      if (!f_ || !(largest(there) <= largest(F))) continue;
      angles = std::move(next), F = there;
      return true;
    }
    across(angles);
    return false;
  }

  const ContactProblem& p_;
  ContactModes modes_;
  const std::vector<std::size_t>& list_;
  const ContactModes first_;
  std::optional<ContactSolution> f_;
  Numbers along_;  // the parts of the slip rates along the directions
};

// The directions of slips that begin, by the two ways above: each with the others as they are until none turns.
std::optional<ContactSolution> with_searched_directions(const ContactProblem& p, ContactModes modes) {
  constexpr int kMost = 60;
  constexpr Real kSettled = 1e-12L;
  std::vector<std::size_t> list;
  for (std::size_t c = 0; c < modes.size(); ++c)
    if (has_direction_to_find(p.contacts[c], modes[c])) list.push_back(c);
  std::optional<ContactSolution> f;
  if (list.size() > 1)
    if (f = DirectionsTogether(p, modes, list).find(); f) return f;
  for (int k = 0; k < kMost; ++k) {
    Real change = 0;
    for (const std::size_t c : list) {
      const std::array<Real, 2> before = modes[c].direction;
      f = DirectionSearch(p, modes, c).find();
      if (!f) return f;
      change = std::max(change, std::hypot(modes[c].direction[0] - before[0], modes[c].direction[1] - before[1]));
    }
    if (list.size() < 2 || change <= kSettled) return f;
  }
  return std::nullopt;
}

}  // namespace

std::optional<ContactSolution> with_directions(const ContactProblem& p, ContactModes modes, long double free) {
  // From kPlain on the steps are damped, as they may go to and fro about the fixed point.
  constexpr int kMost = 400, kPlain = 30, kSlow = 100;
  constexpr Real kFound = 1e-17L, kNear = 1e-9L;
  const ContactModes first = modes;
  // A fixed point may be one of a force that pulls, beside one of a force that pushes.
  const auto pressed = [&](const ContactSolution& f) {
    for (std::size_t c = 0; c < modes.size(); ++c)
      if (has_direction_to_find(p.contacts[c], first[c]) && f.normal[c] < 0) return false;
    return true;
  };
  Real change = 0;
  for (int k = 0; k < kMost; ++k) {
    auto f = of_modes(p, modes);
    if (!f) return f;
    change = 0;
    const Real step = k < kPlain ? 1 : k < kSlow ? 0.5L : 0.1L;
    for (std::size_t c = 0; c < modes.size(); ++c) {
      const ContactRows& rows = p.contacts[c];
      if (!has_direction_to_find(rows, modes[c])) continue;
      const auto v = slip_rate(rows, f->x);
      const Real size = std::hypot(v[0], v[1]),
                 terms = std::max(largest(rows.tangential[0]), largest(rows.tangential[1]));
      if (!(size > kSame * terms * free)) continue;
      auto& d = modes[c].direction;
      const std::array<Real, 2> away{v[0] / size - d[0], v[1] / size - d[1]};
      change = std::max(change, std::hypot(away[0], away[1]));
      const std::array<Real, 2> next{d[0] + step * away[0], d[1] + step * away[1]};
      const Real length = std::hypot(next[0], next[1]);
      if (length > 0) d = {next[0] / length, next[1] / length};
    }
    if (change <= kFound) return pressed(*f) ? f : with_searched_directions(p, first);
  }
  if (change > kNear) return with_searched_directions(p, first);
  return of_modes(p, modes);
}

}  // namespace anholon
