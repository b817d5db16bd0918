#include "contact/contact_law.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "contact/rows.h"
#include "contact/shared_friction.h"

namespace anholon {

namespace {

using Real = long double;
using Numbers = ContactNumbers;

// Square linear equations, solved by Gauss with complete pivoting, rows scaled to 1 and columns to about 1, as friction
// may be large.
class PivotedEquations {
 public:
  explicit PivotedEquations(std::size_t n) : n_(n), m_(n * n, 0), right_(n, 0) {}

  Real* operator[](std::size_t row) { return m_.data() + row * n_; }
  Numbers& right() { return right_; }

  // nullopt if the matrix is singular. The equations are lost.
  std::optional<Numbers> solve() {
    std::vector<int> scales(n_, 0);
    if (!scale(scales)) return std::nullopt;
    std::vector<std::size_t> column(n_);
    for (std::size_t j = 0; j < n_; ++j) column[j] = j;
    Pivot pivot = largest_of(0);
    for (std::size_t k = 0; k < n_; ++k) {
      if (!(pivot.size > kSame)) return std::nullopt;
      exchange(k, pivot);
      std::swap(column[k], column[pivot.column]);
      pivot = eliminate(k);
    }
    Numbers x(n_);
    for (std::size_t k = n_; k-- > 0;) {
      const Real* row = (*this)[k];
      Real sum = right_[k];
      for (std::size_t j = k + 1; j < n_; ++j) sum -= row[j] * x[column[j]];
      x[column[k]] = sum / row[k];
    }
    for (std::size_t j = 0; j < n_; ++j) x[j] = std::scalbn(x[j], scales[j]);
    return x;
  }

 private:
  // The first of the largest elements, row by row.
  struct Pivot {
    std::size_t row = 0, column = 0;
    Real size = -1;
    void consider(Real x, std::size_t i, std::size_t j) {
      if (x = std::abs(x); x > size) *this = {i, j, x};
    }
  };

  // Returns false if a column or a row is zero, or a column is not finite.
  bool scale(std::vector<int>& scales) {
    Numbers most(n_, 0);
    for (std::size_t i = 0; i < n_; ++i)
      for (std::size_t j = 0; j < n_; ++j) most[j] = std::max(most[j], std::abs((*this)[i][j]));
    for (std::size_t j = 0; j < n_; ++j) {
      if (!(most[j] > 0) || !std::isfinite(most[j])) return false;
      scales[j] = -std::ilogb(most[j]);
      most[j] = std::scalbn(Real(1), scales[j]);
    }
    for (std::size_t i = 0; i < n_; ++i) {
      Real* row = (*this)[i];
      Real size = 0;
      for (std::size_t j = 0; j < n_; ++j) size = std::max(size, std::abs(row[j] *= most[j]));
      if (!(size > 0)) return false;
      for (std::size_t j = 0; j < n_; ++j) row[j] /= size;
      right_[i] /= size;
    }
    return true;
  }

  Pivot largest_of(std::size_t k) {
    Pivot pivot{k, k, -1};
    for (std::size_t i = k; i < n_; ++i)
      for (std::size_t j = k; j < n_; ++j) pivot.consider((*this)[i][j], i, j);
    return pivot;
  }

  void exchange(std::size_t k, const Pivot& pivot) {
    if (pivot.row != k) {
      std::swap_ranges((*this)[k], (*this)[k] + n_, (*this)[pivot.row]);
      std::swap(right_[k], right_[pivot.row]);
    }
    if (pivot.column != k)
      for (std::size_t i = 0; i < n_; ++i) std::swap((*this)[i][k], (*this)[i][pivot.column]);
  }

  // Returns the next pivot.
  Pivot eliminate(std::size_t k) {
    const Real* by = (*this)[k];
    Pivot next{k + 1, k + 1, -1};
    for (std::size_t i = k + 1; i < n_; ++i) {
      Real* row = (*this)[i];
      if (const Real factor = row[k] / by[k]; factor != 0) {
        for (std::size_t j = k + 1; j < n_; ++j) row[j] -= factor * by[j];
        right_[i] -= factor * right_[k];
      }
      for (std::size_t j = k + 1; j < n_; ++j) next.consider(row[j], i, j);
    }
    return next;
  }

  std::size_t n_;
  Numbers m_, right_;
};

}  // namespace

std::vector<HeldComponent> held_components(const ContactProblem& p, const ContactModes& modes) {
  std::vector<HeldComponent> list;
  for (std::size_t c = 0; c < modes.size(); ++c)
    for (std::size_t a = 0; modes[c].touch == Touch::sticks && a < p.contacts[c].tangential.size(); ++a)
      if (!modes[c].shares[a].shared) list.push_back({c, a});
  return list;
}

bool shares_friction(const ContactModes& modes) {
  return std::any_of(modes.begin(), modes.end(), [](const ContactMode& m) {
    return m.touch == Touch::sticks && (m.shares[0].shared || m.shares[1].shared);
  });
}

namespace {

// The linear equations of given modes. Unknowns: x, lambda, N of each contact that touches, and the forces that hold.
class ModeEquations {
 public:
  ModeEquations(const ContactProblem& p, const ContactModes& modes)
      : p_(p), modes_(modes), held_(held_components(p, modes)) {
    std::size_t size = p.b.size() + p.beta.size();
    for (std::size_t c = 0; c < modes.size(); ++c) {
      normals_.push_back(size);
      if (modes[c].touch != Touch::open && !p.contacts[c].under) ++size;
    }
    forces_ = size;
    m_.emplace(size + held_.size());
    smooth();
    for (std::size_t c = 0; c < modes.size(); ++c)
      if (modes[c].touch != Touch::open) contact(c);
    for (std::size_t k = 0; k < held_.size(); ++k) {
      const ContactRows& rows = p.contacts[held_[k].contact];
      const Numbers& t = rows.tangential[held_[k].component];
      std::copy(t.begin(), t.end(), (*m_)[forces_ + k]);
      m_->right()[forces_ + k] = -rows.tangential_rate[held_[k].component];
    }
  }

  std::optional<ContactSolution> solve() {
    const auto found = m_->solve();
    if (!found) return std::nullopt;
    ContactSolution f;
    f.modes = modes_;
    f.x.assign(found->begin(), found->begin() + static_cast<std::ptrdiff_t>(p_.b.size()));
    for (std::size_t c = 0; c < modes_.size(); ++c) {
      const bool open = modes_[p_.contacts[c].under.value_or(c)].touch == Touch::open;
      f.normal.push_back((open ? 0 : (*found)[normal(c)]) + p_.contacts[c].pressed);
      std::array<Real, 2> t{};
      for (std::size_t a = 0; modes_[c].touch == Touch::sticks && a < p_.contacts[c].tangential.size(); ++a) {
        t[a] = modes_[c].shares[a].given;
        for (std::size_t k = 0; k < held_.size(); ++k) t[a] += part(c, a, k) * (*found)[forces_ + k];
      }
      f.friction.push_back(t);
    }
    return f;
  }

 private:
  std::size_t normal(std::size_t c) const { return normals_[p_.contacts[c].under.value_or(c)]; }
  // Of the force k that holds, in component a of the friction of a contact.
  Real part(std::size_t c, std::size_t a, std::size_t k) const {
    const FrictionShare& share = modes_[c].shares[a];
    if (share.shared) return k < share.of.size() ? share.of[k] : 0;
    return held_[k].contact == c && held_[k].component == a ? 1 : 0;
  }

  void smooth() {
    const std::size_t n = p_.b.size();
    PivotedEquations& m = *m_;
    for (std::size_t i = 0; i < n; ++i) {
      for (std::size_t j = 0; j < n; ++j) m[i][j] = p_.A[i][j];
      for (std::size_t r = 0; r < p_.beta.size(); ++r) m[i][n + r] = -p_.Phi[r][i], m[n + r][i] = p_.Phi[r][i];
      m.right()[i] = -p_.b[i];
    }
    for (std::size_t r = 0; r < p_.beta.size(); ++r) m.right()[n + r] = -p_.beta[r];
  }

  void contact(std::size_t c) {
    const ContactRows& rows = p_.contacts[c];
    PivotedEquations& m = *m_;
    const std::size_t N = normal(c);
    const bool presses = modes_[rows.under.value_or(c)].touch != Touch::open;
    for (std::size_t i = 0; i < p_.b.size(); ++i) {
      if (!rows.under) m[N][i] = rows.normal[i], m[i][N] -= rows.normal[i];
      for (std::size_t a = 0; a < rows.tangential.size(); ++a) {
        const Real t = rows.tangential[a][i];
        if (modes_[c].touch == Touch::sticks) {
          for (std::size_t k = 0; k < held_.size(); ++k) m[i][forces_ + k] -= part(c, a, k) * t;
          m.right()[i] += modes_[c].shares[a].given * t;
          continue;
        }
        const Real friction = rows.friction * modes_[c].direction[a] * t;
        if (presses) m[i][N] += friction;
        m.right()[i] -= friction * rows.pressed;
      }
    }
    if (!rows.under) m.right()[N] = -rows.normal_rate;
  }

  const ContactProblem& p_;
  const ContactModes& modes_;
  std::vector<HeldComponent> held_;
  std::vector<std::size_t> normals_;
  std::size_t forces_ = 0;
  std::optional<PivotedEquations> m_;
};

}  // namespace

std::optional<ContactSolution> of_modes(const ContactProblem& p, const ContactModes& modes) {
  return ModeEquations(p, modes).solve();
}

namespace {

std::array<Real, 2> slip_rate(const ContactRows& rows, const Numbers& x) {
  std::array<Real, 2> v{};
  for (std::size_t a = 0; a < rows.tangential.size(); ++a) v[a] = dot(rows.tangential[a], x) + rows.tangential_rate[a];
  return v;
}

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

  bool around() {
    constexpr int kParts = 48, kHalves = 70;
    const Real part = 2 * std::acos(-1.0L) / kParts;
    Real a = 0, fa = across(a);
    bool slips_at_a = slips();
    for (int k = 1; k <= kParts; ++k) {
      Real b = k * part, fb = across(b);
      const bool slips_at_b = slips();
      if ((slips_at_a || slips_at_b) && (fa < 0) != (fb < 0)) {
        Real low = a, high = b;
        for (int h = 0; h < kHalves; ++h) {
          const Real middle = low + (high - low) / 2, fm = across(middle);
          ((fm < 0) == (fa < 0) ? low : high) = middle;
        }
        if (std::abs(across(low)) <= kFound * std::hypot(v_[0], v_[1]) && slips()) return true;
      }
      a = b, fa = fb, slips_at_a = slips_at_b;
    }
    return false;
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

// Directions of slip that begins are those of the slip rates that follow from them: a fixed point. A rate that is
// round-off of the accelerations `free` has no direction, and the first guess stays.
std::optional<ContactSolution> with_directions(const ContactProblem& p, ContactModes modes, Real free) {
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

// free: the size of the accelerations without contacts. Where the contacts leave no acceleration, those of the modes
// are the round-off of this size.
bool consistent(const ContactProblem& p, const ContactSolution& f, Real free) {
  // A contact at rest that the others hold does not slip.
  const bool others_hold =
      std::any_of(f.modes.begin(), f.modes.end(), [](const ContactMode& m) { return m.touch == Touch::sticks; });
  const Real force = largest(p.b), size = std::max(largest(f.x), free);
  for (std::size_t c = 0; c < p.contacts.size(); ++c) {
    const ContactRows& rows = p.contacts[c];
    const ContactMode& mode = f.modes[c];
    const Real scale = kSame * (largest(rows.normal) * std::max(size, rows.before) + std::abs(rows.normal_rate));
    const Real N = f.normal[c];
    if (mode.touch == Touch::open) {
      if (rows.under) continue;
      if (dot(rows.normal, f.x) + rows.normal_rate < -scale) return false;
      continue;
    }
    // Friction multiplies the round-off of N.
    constexpr Real kRounded = 1e-14L;
    const Real lever = rows.under ? rows.static_friction : 1;
    const Real forces = kSame * lever * std::max(force, std::abs(N)) + kRounded * rows.static_friction * force;
    if (!rows.under && N < -forces) return false;
    if (!rows.rough) continue;
    const auto v = slip_rate(rows, f.x);
    Real span = 0;
    for (std::size_t a = 0; a < rows.tangential.size(); ++a)
      span = std::max(span, kSame * (largest(rows.tangential[a]) * size + std::abs(rows.tangential_rate[a])) +
                                kRounded * rows.friction * largest(rows.tangential[a]) * free);
    const Real along = v[0] * mode.direction[0] + v[1] * mode.direction[1];
    if (mode.touch == Touch::sticks) {
      for (std::size_t a = 0; a < rows.tangential.size(); ++a)
        if (mode.shares[a].shared && std::abs(v[a]) > span) return false;
      if (std::hypot(f.friction[c][0], f.friction[c][1]) > rows.static_friction * N + forces) return false;
    } else if (!rows.moves && (along < -span || (others_hold && rows.may_stick && along <= span))) {
      return false;
    }
  }
  return true;
}

ContactMode mode(Touch touch, const std::array<Real, 2>& direction) {
  ContactMode m;
  m.touch = touch, m.direction = direction;
  return m;
}

// The modes that one contact may take, those that touch first, and of them those that stick.
ContactModes choices(const ContactRows& rows, bool may_touch) {
  ContactModes list;
  if (may_touch) {
    if (rows.rough && !rows.moves && rows.may_stick) list.push_back(mode(Touch::sticks, {}));
    if (!rows.rough || rows.moves || rows.tangential.size() > 1) {
      list.push_back(mode(Touch::slips, rows.direction));
    } else {
      list.push_back(mode(Touch::slips, {1, 0}));
      list.push_back(mode(Touch::slips, {-1, 0}));
    }
  }
  if (rows.may_open) list.push_back({});
  return list;
}

// Sticking is the way in which a contact that may stick goes on, whether or not it could begin to slip as well.
bool alternatives(const ContactSolution& a, const ContactSolution& b) {
  bool open = false;
  for (std::size_t c = 0; c < a.modes.size(); ++c)
    open = open || (a.modes[c].touch == Touch::open) != (b.modes[c].touch == Touch::open);
  return open;
}

// Resistance is open where its contact is, unless a given force presses it.
bool possible(const ContactProblem& p, const ContactModes& modes) {
  for (std::size_t c = 0; c < modes.size(); ++c)
    if (const auto& under = p.contacts[c].under)
      if ((modes[c].touch == Touch::open) != (modes[*under].touch == Touch::open && p.contacts[c].pressed == 0))
        return false;
  return true;
}

}  // namespace

std::vector<ContactSolution> consistent_modes(const ContactProblem& p) {
  std::vector<ContactModes> each;
  std::size_t count = 1;
  for (const ContactRows& rows : p.contacts) {
    each.push_back(choices(rows, rows.under ? p.contacts[*rows.under].may_touch : rows.may_touch));
    count *= each.back().size();
  }
  std::vector<ContactSolution> list;
  const auto open = of_modes(p, ContactModes(p.contacts.size()));
  const Real free = std::max(open ? largest(open->x) : 0, Real(1e-300L));
  for (std::size_t k = 0; k < count; ++k) {
    ContactModes modes;
    for (std::size_t c = 0, rest = k; c < each.size(); ++c) {
      modes.push_back(each[c][rest % each[c].size()]);
      rest /= each[c].size();
    }
    if (!possible(p, modes)) continue;
    share_friction(p, modes);
    auto f = with_directions(p, modes, free);
    if (f && shares_friction(modes)) f = distributed(p, *f);
    if (!f || !consistent(p, *f, free)) continue;
    const bool known = std::any_of(list.begin(), list.end(), [&](const ContactSolution& o) {
      Real difference = 0;
      for (std::size_t i = 0; i < o.x.size(); ++i) difference = std::max(difference, std::abs(o.x[i] - f->x[i]));
      return difference <= 100 * kSame * std::max({largest(o.x), largest(f->x), free}) || !alternatives(o, *f);
    });
    if (!known) list.push_back(*f);
  }
  return list;
}

}  // namespace anholon
