#include "contact/law/least_constraint.h"

#include <limits>

#include "contact/law/positive_equations.h"
#include "contact/law/shared_forces.h"

namespace anholon {

namespace {

using Real = long double;
using Numbers = ContactNumbers;

// A component of the friction of a contact.
struct Component {
  std::size_t contact = 0, component = 0;
};

// The effects of friction, in units of a force of the problem: the slip accelerations W T + w, and the loads.
class Responses {
 public:
  Responses(const ContactProblem& p, const std::vector<bool>& touches) : p_(p) {
    ContactProblem smooth = p;
    ContactModes modes(touches.size());
    for (std::size_t c = 0; c < touches.size(); ++c) {
      smooth.contacts[c].friction = 0;
      if (!touches[c]) continue;
      modes[c].touch = Touch::slips;
      for (std::size_t a = 0; p.contacts[c].rough && a < p.contacts[c].tangential.size(); ++a)
        components_.push_back({c, a});
    }
    share_forces(p, modes);
    without_ = of_modes(smooth, modes);
    if (without_) force_ = size_of_forces(p, *without_);
    for (std::size_t k = 0; without_ && k < components_.size(); ++k) {
      for (std::size_t i = 0; i < p.b.size(); ++i) smooth.b[i] = p.b[i] - force_ * row(k)[i];
      const auto f = of_modes(smooth, modes);
      if (!f) {
        without_.reset();
        break;
      }
      Numbers x = f->x, N = f->normal;
      for (std::size_t i = 0; i < x.size(); ++i) x[i] -= without_->x[i];
      for (std::size_t c = 0; c < N.size(); ++c) N[c] -= without_->normal[c];
      x_.push_back(std::move(x)), N_.push_back(std::move(N));
    }
  }

  bool exist() const { return without_.has_value(); }
  const std::vector<Component>& components() const { return components_; }
  Real load(std::size_t c, const Numbers& T) const {
    Real N = without_->normal[c];
    for (std::size_t k = 0; k < T.size(); ++k) N += N_[k][c] * T[k];
    return N / force_;
  }
  Real slip_acceleration(std::size_t k, const Numbers& T) const {
    Real a = dot(row(k), without_->x) + p_.contacts[components_[k].contact].tangential_rate[components_[k].component];
    for (std::size_t j = 0; j < T.size(); ++j) a += of(k, j) * T[j];
    return a;
  }
  // W: the slip acceleration of component k by a unit of component j.
  Real of(std::size_t k, std::size_t j) const { return dot(row(k), x_[j]); }

 private:
  const Numbers& row(std::size_t k) const {
    return p_.contacts[components_[k].contact].tangential[components_[k].component];
  }

  const ContactProblem& p_;
  std::vector<Component> components_;
  Real force_ = 0;
  std::optional<ContactSolution> without_;
  std::vector<Numbers> x_, N_;  // by a unit of each component
};

// Finds the least of 1/2 T^T W T + w^T T over all friction within the bounds of the loads, which is the problem in
// least_constraint.h in terms of forces: by Newton's method with a barrier, with the loads of the last forces.
class LeastConstraint {
 public:
  LeastConstraint(const ContactProblem& p, const std::vector<bool>& touches)
      : p_(p), touches_(touches), by_(p, touches), T_(by_.components().size(), 0), slips_(touches.size(), false),
        bound_(touches.size(), 0) {}

  std::optional<ContactModes> find() {
    if (!by_.exist()) return std::nullopt;
    // A contact that slips has the coefficient of slip, and then others may slip as well.
    for (std::size_t k = 0; k <= touches_.size(); ++k) {
      if (!solve()) return std::nullopt;
      if (!slip_where_not_held()) return modes();
    }
    return std::nullopt;
  }

 private:
  bool at_rest(std::size_t c) const { return touches_[c] && p_.contacts[c].rough && !p_.contacts[c].moves; }
  bool free(std::size_t k) const {
    const std::size_t c = by_.components()[k].contact;
    return at_rest(c) && bound_[c] > 0;
  }

  // Inserts the loads of the present forces, and scales the friction of contacts at rest into the bounds. Returns the
  // largest change of a bound, relative to the largest bound.
  Real put_loads() {
    Real change = 0, most = std::numeric_limits<Real>::min();
    Numbers next = bound_;
    for (std::size_t c = 0; c < touches_.size(); ++c) {
      if (!touches_[c] || !p_.contacts[c].rough) continue;
      const ContactRows& rows = p_.contacts[c];
      const Real mu = at_rest(c) && rows.may_stick && !slips_[c] ? rows.static_friction : rows.friction;
      next[c] = std::max(0.0L, mu * by_.load(c, T_));
      most = std::max(most, next[c]);
    }
    for (std::size_t c = 0; c < touches_.size(); ++c) change = std::max(change, std::abs(next[c] - bound_[c]) / most);
    for (std::size_t k = 0; k < T_.size(); ++k) {
      const Component& at = by_.components()[k];
      if (!at_rest(at.contact))
        T_[k] = -next[at.contact] * p_.contacts[at.contact].direction[at.component];
      else
        T_[k] *= bound_[at.contact] > 0 ? next[at.contact] / bound_[at.contact] : 0;
    }
    bound_ = std::move(next);
    return change;
  }

  Real room(std::size_t c, const Numbers& T) const {
    Real square = 0;
    for (std::size_t k = 0; k < T.size(); ++k)
      if (by_.components()[k].contact == c) square += T[k] * T[k];
    const Real size = std::sqrt(square);
    return (bound_[c] - size) * (bound_[c] + size);
  }

  // The slip accelerations plus the slope of the barrier; they vanish where the barrier function is least.
  Numbers slope(const Numbers& T) const {
    Numbers g(T.size(), 0);
    for (std::size_t k = 0; k < T.size(); ++k)
      if (free(k)) g[k] = by_.slip_acceleration(k, T) + steep_ * 2 * T[k] / room(by_.components()[k].contact, T);
    return g;
  }

  bool inside(const Numbers& T) const {
    for (std::size_t k = 0; k < T.size(); ++k)
      if (free(k) && !(room(by_.components()[k].contact, T) > 0)) return false;
    return true;
  }

  // Makes one step of Newton's method, shortened until the slope along it has not passed zero by much. Returns false at
  // the end of the iteration.
  bool step() {
    constexpr Real kEnough = 1e-13L;
    constexpr int kHalves = 60;
    const std::size_t n = T_.size();
    const Numbers g = slope(T_);
    std::vector<Numbers> H(n, Numbers(n, 0));
    for (std::size_t k = 0; k < n; ++k) {
      if (!free(k)) continue;
      const std::size_t c = by_.components()[k].contact;
      const Real h = room(c, T_);
      for (std::size_t j = 0; j < n; ++j) {
        if (!free(j)) continue;
        H[k][j] = (by_.of(k, j) + by_.of(j, k)) / 2;
        if (by_.components()[j].contact == c)
          H[k][j] += steep_ * 4 * T_[k] * T_[j] / (h * h) + (j == k ? 2 * steep_ / h : 0);
      }
    }
    const Numbers d = solve_positive(H, g);
    const Real decrement = dot(g, d);
    if (!(decrement > kEnough * steep_)) return false;
    Real part = 1;
    for (int k = 0; k < kHalves; ++k, part /= 2) {
      Numbers next = T_;
      for (std::size_t i = 0; i < n; ++i) next[i] -= part * d[i];
      if (!inside(next) || !(dot(slope(next), d) > -decrement / 2)) continue;
      T_ = std::move(next);
      return true;
    }
    return false;
  }

  bool solve() {
    constexpr Real kLast = 1e-17L, kFlatter = 8, kSettled = 1e-14L;
    constexpr int kSteps = 40, kLoads = 60;
    T_.assign(T_.size(), 0);
    bound_.assign(bound_.size(), 0);
    put_loads();
    Real size = 0;
    without_ = 0;
    for (std::size_t k = 0; k < T_.size(); ++k) {
      if (!free(k)) continue;
      const Real a = std::abs(by_.slip_acceleration(k, T_));
      without_ = std::max(without_, a);
      size = std::max(size, a * bound_[by_.components()[k].contact]);
    }
    if (!(size > 0)) return false;
    for (steep_ = size; steep_ > kLast * size; steep_ /= kFlatter) {
      for (int k = 0; k < kSteps && step(); ++k) continue;
      put_loads();
    }
    steep_ *= kFlatter;
    for (int k = 0; k < kLoads; ++k) {
      for (int s = 0; s < kSteps && step(); ++s) continue;
      if (put_loads() <= kSettled) return true;
    }
    return false;
  }

  std::array<Real, 2> rate(std::size_t c) const {
    std::array<Real, 2> v{};
    for (std::size_t k = 0; k < T_.size(); ++k)
      if (by_.components()[k].contact == c) v[by_.components()[k].component] = by_.slip_acceleration(k, T_);
    return v;
  }

  // True if a contact slips: the relative distance of its force from the bound is smaller than its relative slip
  // acceleration.
  bool slips(std::size_t c) const {
    constexpr Real kZero = 1e-10L;
    Real size = kZero * without_;
    for (std::size_t o = 0; o < touches_.size(); ++o)
      if (at_rest(o)) size = std::max(size, std::hypot(rate(o)[0], rate(o)[1]));
    if (!(bound_[c] > 0)) return std::hypot(rate(c)[0], rate(c)[1]) > kSame * size;
    return room(c, T_) / (bound_[c] * bound_[c]) < std::hypot(rate(c)[0], rate(c)[1]) / size;
  }

  // Notes the contacts that slip, and have another coefficient of slip than of sticking; returns true if there is any.
  bool slip_where_not_held() {
    bool any = false;
    for (std::size_t c = 0; c < touches_.size(); ++c) {
      const ContactRows& rows = p_.contacts[c];
      if (!at_rest(c) || slips_[c] || !rows.may_stick || rows.friction == rows.static_friction || !slips(c)) continue;
      slips_[c] = any = true;
    }
    return any;
  }

  std::optional<ContactModes> modes() const {
    ContactModes list(touches_.size());
    for (std::size_t c = 0; c < touches_.size(); ++c) {
      if (!touches_[c]) continue;
      if (!p_.contacts[c].under && by_.load(c, T_) < -kSame) return std::nullopt;
      list[c].touch = !at_rest(c) || slips(c) || !p_.contacts[c].may_stick ? Touch::slips : Touch::sticks;
      list[c].direction = p_.contacts[c].direction;
      const std::array<Real, 2> v = rate(c);
      if (const Real size = std::hypot(v[0], v[1]); at_rest(c) && list[c].touch == Touch::slips && size > 0)
        list[c].direction = {v[0] / size, v[1] / size};
    }
    return list;
  }

  const ContactProblem& p_;
  const std::vector<bool>& touches_;
  Responses by_;
  Numbers T_;
  std::vector<bool> slips_;  // contacts that slip with another coefficient than that by which they are held
  Numbers bound_;
  Real steep_ = 0;
  Real without_ = 0;  // the largest slip acceleration without friction
};

}  // namespace

std::optional<ContactModes> modes_of_least_constraint(const ContactProblem& p, const std::vector<bool>& touches) {
  std::size_t at_rest = 0;
  for (std::size_t c = 0; c < touches.size(); ++c)
    if (touches[c] && p.contacts[c].rough && !p.contacts[c].moves) ++at_rest;
  if (at_rest < 2) return std::nullopt;
  return LeastConstraint(p, touches).find();
}

}  // namespace anholon
