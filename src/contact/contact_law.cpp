#include "contact/contact_law.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace anholon {

namespace {

using Real = long double;
using Numbers = std::vector<Real>;

// Solutions that differ by less, in relation to their size, are the same; a pivot below it is zero.
constexpr Real kSame = 1e-10L;

Real dot(const Numbers& a, const Numbers& b) {
  Real sum = 0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += a[i] * b[i];
  return sum;
}

Real largest(const Numbers& a) {
  Real most = 0;
  for (Real x : a) most = std::max(most, std::abs(x));
  return most;
}

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

// The linear equations of given modes. Columns: x, lambda, then N and T of each contact.
std::optional<ContactSolution> of_modes(const ContactProblem& p, const ContactModes& modes) {
  const std::size_t n = p.b.size(), s = p.beta.size();
  std::vector<std::size_t> first;
  std::size_t size = n + s;
  for (std::size_t c = 0; c < modes.size(); ++c) {
    first.push_back(size);
    if (modes[c].touch == Touch::open) continue;
    size += (p.contacts[c].under ? 0 : 1) +
            (modes[c].touch == Touch::sticks && !modes[c].free ? p.contacts[c].tangential.size() : 0);
  }
  const auto normal = [&](std::size_t c) { return first[p.contacts[c].under.value_or(c)]; };
  const auto tangential = [&](std::size_t c) { return first[c] + (p.contacts[c].under ? 0 : 1); };
  PivotedEquations m(size);
  Numbers& right = m.right();
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t j = 0; j < n; ++j) m[i][j] = p.A[i][j];
    for (std::size_t r = 0; r < s; ++r) m[i][n + r] = -p.Phi[r][i], m[n + r][i] = p.Phi[r][i];
    right[i] = -p.b[i];
  }
  for (std::size_t r = 0; r < s; ++r) right[n + r] = -p.beta[r];
  for (std::size_t c = 0; c < modes.size(); ++c) {
    const ContactRows& rows = p.contacts[c];
    if (modes[c].touch == Touch::open) continue;
    const std::size_t k = normal(c), kt = tangential(c);
    const bool presses = modes[rows.under.value_or(c)].touch != Touch::open;
    for (std::size_t i = 0; i < n; ++i) {
      if (!rows.under) m[k][i] = rows.normal[i], m[i][k] = -rows.normal[i];
      for (std::size_t a = 0; a < rows.tangential.size(); ++a) {
        if (modes[c].touch == Touch::sticks) {
          if (!modes[c].free) m[kt + a][i] = rows.tangential[a][i], m[i][kt + a] = -rows.tangential[a][i];
          continue;
        }
        const long double friction = rows.friction * modes[c].direction[a] * rows.tangential[a][i];
        if (presses) m[i][k] += friction;
        right[i] -= friction * rows.pressed;
      }
    }
    if (!rows.under) right[k] = -rows.normal_rate;
    if (modes[c].touch == Touch::sticks && !modes[c].free)
      for (std::size_t a = 0; a < rows.tangential.size(); ++a) right[kt + a] = -rows.tangential_rate[a];
  }
  const auto found = m.solve();
  if (!found) return std::nullopt;
  ContactSolution f;
  f.modes = modes;
  f.x.assign(found->begin(), found->begin() + static_cast<std::ptrdiff_t>(n));
  for (std::size_t c = 0; c < modes.size(); ++c) {
    const bool open = modes[p.contacts[c].under.value_or(c)].touch == Touch::open;
    f.normal.push_back((open ? 0 : (*found)[normal(c)]) + p.contacts[c].pressed);
    std::array<Real, 2> t{};
    if (modes[c].touch == Touch::sticks && !modes[c].free)
      for (std::size_t a = 0; a < p.contacts[c].tangential.size(); ++a) t[a] = (*found)[tangential(c) + a];
    f.friction.push_back(t);
  }
  return f;
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

// The directions of slips that begin, each by a search with the others as they are, one after the other until none turns.
std::optional<ContactSolution> with_searched_directions(const ContactProblem& p, ContactModes modes) {
  constexpr int kMost = 60;
  constexpr Real kSettled = 1e-12L;
  std::vector<std::size_t> list;
  for (std::size_t c = 0; c < modes.size(); ++c)
    if (has_direction_to_find(p.contacts[c], modes[c])) list.push_back(c);
  std::optional<ContactSolution> f;
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
    if (mode.touch == Touch::sticks) {
      if (mode.free ? std::hypot(v[0], v[1]) > span
                    : std::hypot(f.friction[c][0], f.friction[c][1]) > rows.static_friction * N + forces)
        return false;
    } else if (!rows.moves && v[0] * mode.direction[0] + v[1] * mode.direction[1] < -span) {
      return false;
    }
  }
  return true;
}

// The modes that one contact may take, those that touch first, and of them those that stick.
ContactModes choices(const ContactRows& rows, bool may_touch) {
  ContactModes list;
  if (may_touch) {
    if (rows.rough && !rows.moves && rows.may_stick)
      for (const bool free : {false, true}) list.push_back({Touch::sticks, {}, free});
    if (!rows.rough || rows.moves || rows.tangential.size() > 1) {
      list.push_back({Touch::slips, rows.direction, false});
    } else {
      list.push_back({Touch::slips, {1, 0}, false});
      list.push_back({Touch::slips, {-1, 0}, false});
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
    const auto f = with_directions(p, modes, free);
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
