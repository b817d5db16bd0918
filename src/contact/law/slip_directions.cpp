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

// The loads and the slip rates of contacts whose slips begin, for any directions of these slips. Both are linear in the
// friction of these contacts, which the loads determine.
class BeginningSlips {
 public:
  BeginningSlips(const ContactProblem& p, const ContactModes& modes) : p_(p) {
    ContactProblem without = p;
    for (std::size_t c = 0; c < modes.size(); ++c)
      if (has_direction_to_find(p.contacts[c], modes[c])) list_.push_back(c), without.contacts[c].friction = 0;
    const auto f = of_modes(without, modes);
    if (!f) return;
    const Real force = size_of_forces(p, *f);
    const auto loads_and_rates = [&](const ContactSolution& of) {
      Numbers values;
      for (const std::size_t c : list_) {
        const auto v = slip_rate(p.contacts[c], of.x);
        values.insert(values.end(), {of.normal[c], v[0], v[1]});
      }
      return values;
    };
    without_ = loads_and_rates(*f);
    for (const std::size_t c : list_)
      for (const Numbers& t : p.contacts[c].tangential) {
        for (std::size_t i = 0; i < p.b.size(); ++i) without.b[i] = p.b[i] - force * t[i];
        const auto pushed = of_modes(without, modes);
        if (!pushed) return;
        by_.push_back(loads_and_rates(*pushed));
        for (std::size_t i = 0; i < without_.size(); ++i) by_.back()[i] = (by_.back()[i] - without_[i]) / force;
      }
    exist_ = true;
  }

  const std::vector<std::size_t>& list() const { return list_; }

  // Inserts the directions of modes; returns false if the loads are not determined.
  bool with(const ContactModes& modes) {
    if (!exist_) return false;
    const std::size_t n = list_.size();
    // The effect of a unit of each load through its friction.
    std::vector<Numbers> rubs(n);
    for (std::size_t k = 0; k < n; ++k) {
      const Real mu = p_.contacts[list_[k]].friction;
      const auto& d = modes[list_[k]].direction;
      for (std::size_t i = 0; i < without_.size(); ++i)
        rubs[k].push_back(-mu * (d[0] * by_[2 * k][i] + d[1] * by_[2 * k + 1][i]));
    }
    PivotedEquations m(n);
    for (std::size_t j = 0; j < n; ++j) {
      for (std::size_t k = 0; k < n; ++k) m[j][k] = (j == k ? 1 : 0) - rubs[k][3 * j];
      m.right()[j] = without_[3 * j];
    }
    const auto loads = m.solve();
    if (!loads) return false;
    now_ = without_;
    for (std::size_t k = 0; k < n; ++k)
      for (std::size_t i = 0; i < now_.size(); ++i) now_[i] += (*loads)[k] * rubs[k][i];
    return true;
  }
  // The load and the slip rate of contact k of the list.
  Real load(std::size_t k) const { return now_[3 * k]; }
  std::array<Real, 2> rate(std::size_t k) const { return {now_[3 * k + 1], now_[3 * k + 2]}; }

 private:
  const ContactProblem& p_;
  std::vector<std::size_t> list_;
  bool exist_ = false;
  Numbers without_, now_;    // load and two rates of each contact, without their friction and with it
  std::vector<Numbers> by_;  // changes by a unit of each component of friction
};

// Searches the direction of one slip that begins with two components, with the other directions fixed: the angle at
// which the slip rate has no part across the direction. If the slip hardly accelerates, the rate turns much faster than
// the direction, and the fixed point is repelling; the secant method finds it, or else bisection between angles all
// around.
class DirectionSearch {
 public:
  // `place`: the index of the contact in the list of those that begin to slip.
  DirectionSearch(BeginningSlips& slips, ContactModes& modes, std::size_t place)
      : slips_(slips), modes_(modes), place_(place), contact_(slips.list()[place]), first_(modes[contact_].direction) {}

  // Writes the direction into the modes; if no angle is found, returns false and restores the first direction.
  bool find() {
    if (secant() || around()) return true;
    modes_[contact_].direction = first_;
    return false;
  }

 private:
  static constexpr Real kFound = 1e-9L;

  Real across(Real angle) {
    auto& d = modes_[contact_].direction;
    d = {first_[0] * std::cos(angle) - first_[1] * std::sin(angle),
         first_[1] * std::cos(angle) + first_[0] * std::sin(angle)};
    determined_ = slips_.with(modes_);
    if (!determined_) return std::numeric_limits<Real>::quiet_NaN();
    v_ = slips_.rate(place_);
    return v_[1] * d[0] - v_[0] * d[1];
  }

  // True if, at the angle tried last, the contact is pressed and slips along its direction.
  bool slips() const {
    const auto& d = modes_[contact_].direction;
    return determined_ && slips_.load(place_) >= 0 && v_[0] * d[0] + v_[1] * d[1] > 0;
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

  // The slip rate of a slip that hardly begins is along the direction only at angles very near to one of these.
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

  BeginningSlips& slips_;
  ContactModes& modes_;
  std::size_t place_, contact_;
  std::array<Real, 2> first_;
  bool determined_ = false;
  std::array<Real, 2> v_{};
};

// Searches the directions of slips that begin together, near a first guess: the angles at which no slip rate has a part
// across its direction, by Newton's method with differences.
class DirectionsTogether {
 public:
  DirectionsTogether(BeginningSlips& slips, const ContactModes& modes)
      : slips_(slips), modes_(modes), list_(slips.list()), first_(modes) {}

  std::optional<ContactModes> find() {
    constexpr int kMost = 40;
    Numbers angles(list_.size(), 0), F = across(angles);
    for (int k = 0; k < kMost && determined_; ++k) {
      if (found()) return modes_;
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
    determined_ = slips_.with(modes_);
    Numbers F;
    along_.clear();
    for (std::size_t i = 0; i < list_.size(); ++i) {
      const auto v = determined_ ? slips_.rate(i) : std::array<Real, 2>{};
      const auto& d = modes_[list_[i]].direction;
      F.push_back(v[1] * d[0] - v[0] * d[1]);
      along_.push_back(v[0] * d[0] + v[1] * d[1]);
    }
    return F;
  }

  bool found() const {
    constexpr Real kFound = 1e-9L;
    for (std::size_t i = 0; i < list_.size(); ++i) {
      const auto v = slips_.rate(i);
      if (!(along_[i] > 0) || slips_.load(i) < 0 ||
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
      if (!determined_) return std::nullopt;
      for (std::size_t i = 0; i < list_.size(); ++i) m[i][j] = (there[i] - F[i]) / kStep;
    }
    m.right() = F;
    return m.solve();
  }

  // Applies as large a part of a change as makes F smaller.
  bool improve(Numbers& angles, Numbers& F, const Numbers& change) {
    constexpr int kHalves = 12;
    constexpr Real kTurn = 0.5L;
    Real part = std::min<Real>(1, kTurn / std::max(largest(change), std::numeric_limits<Real>::min()));
    for (int k = 0; k < kHalves; ++k, part /= 2) {
      Numbers next = angles;
      for (std::size_t i = 0; i < next.size(); ++i) next[i] -= part * change[i];
      const Numbers there = across(next);
      if (!determined_ || !(largest(there) <= largest(F))) continue;
      angles = std::move(next), F = there;
      return true;
    }
    across(angles);
    return false;
  }

  BeginningSlips& slips_;
  ContactModes modes_;
  const std::vector<std::size_t>& list_;
  const ContactModes first_;
  bool determined_ = false;
  Numbers along_;  // the parts of the slip rates along the directions
};

// Returns the modes with the directions of slips that begin, by the two searches above: one direction after the other
// until none turns.
std::optional<ContactModes> with_searched_directions(BeginningSlips& slips, ContactModes modes) {
  constexpr int kMost = 60;
  constexpr Real kSettled = 1e-12L;
  const std::vector<std::size_t>& list = slips.list();
  if (list.size() > 1)
    if (auto found = DirectionsTogether(slips, modes).find()) return found;
  for (int k = 0; k < kMost; ++k) {
    Real change = 0;
    for (std::size_t i = 0; i < list.size(); ++i) {
      const std::array<Real, 2> before = modes[list[i]].direction;
      if (!DirectionSearch(slips, modes, i).find()) return std::nullopt;
      const std::array<Real, 2>& now = modes[list[i]].direction;
      change = std::max(change, std::hypot(now[0] - before[0], now[1] - before[1]));
    }
    if (list.size() < 2 || change <= kSettled) return modes;
  }
  return std::nullopt;
}

// Writes the fixed point of the directions into the modes. Returns true if its forces push; there may be another fixed
// point with forces that pull.
bool find_fixed_point(const ContactProblem& p, BeginningSlips& slips, ContactModes& modes, Real free) {
  // From kPlain on the steps are damped, because they may oscillate about the fixed point.
  constexpr int kMost = 400, kPlain = 30, kSlow = 100;
  constexpr Real kFound = 1e-17L, kNear = 1e-9L;
  Real change = 0;
  for (int k = 0; k < kMost; ++k) {
    if (!slips.with(modes)) return false;
    change = 0;
    bool pressed = true;
    const Real step = k < kPlain ? 1 : k < kSlow ? 0.5L : 0.1L;
    for (std::size_t i = 0; i < slips.list().size(); ++i) {
      const std::size_t c = slips.list()[i];
      pressed = pressed && slips.load(i) >= 0;
      const ContactRows& rows = p.contacts[c];
      const auto v = slips.rate(i);
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
    if (change <= kFound) return pressed;
  }
  return change <= kNear;
}

}  // namespace

std::optional<ContactSolution> with_directions(const ContactProblem& p, ContactModes modes, long double free) {
  const auto begins = [&](std::size_t c) { return has_direction_to_find(p.contacts[c], modes[c]); };
  bool any = false;
  for (std::size_t c = 0; c < modes.size(); ++c) any = any || begins(c);
  if (!any) return of_modes(p, modes);
  BeginningSlips slips(p, modes);
  const ContactModes first = modes;
  if (find_fixed_point(p, slips, modes, free)) return of_modes(p, modes);
  const auto found = with_searched_directions(slips, first);
  if (!found) return std::nullopt;
  return of_modes(p, *found);
}

}  // namespace anholon
