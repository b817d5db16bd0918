#include "contact/law/shared_forces.h"

#include <limits>

#include "contact/law/positive_equations.h"

namespace anholon {

namespace {

using Real = long double;
using Numbers = ContactNumbers;

// A component that depends on others: t = sum of_held t_k + sum of_gaps n_c + combinations of the constraints.
struct Dependent {
  HeldComponent place;
  Numbers of_held, of_gaps;  // in the order of the held components; by contact
};

// Orthogonalizes rows one after the other by the method of Gram and Schmidt, and keeps for each direction the sum of
// rows that it is.
class GramSchmidt {
 public:
  explicit GramSchmidt(std::size_t most) : most_(most) {}

  // The part of a row that is orthogonal to the earlier rows.
  Numbers rest_of(const Numbers& row) const {
    Numbers v = row;
    for (const Numbers& direction : directions_) {
      const Real d = dot(v, direction);
      for (std::size_t i = 0; i < v.size(); ++i) v[i] -= d * direction[i];
    }
    return v;
  }
  // The length of this part, relative to the row.
  long double left_of(const Numbers& row) const {
    const Numbers v = rest_of(row);
    return std::sqrt(dot(v, v) / dot(row, row));
  }

  // Adds a row. If it depends on the earlier rows, returns its coefficients in them instead.
  std::optional<Numbers> add(const Numbers& row) {
    Numbers v = row, sum(most_, 0);
    sum[count_++] = 1;
    for (int again = 0; again < 2; ++again)
      for (std::size_t j = 0; j < directions_.size(); ++j) {
        const Real d = dot(v, directions_[j]);
        for (std::size_t i = 0; i < v.size(); ++i) v[i] -= d * directions_[j][i];
        for (std::size_t i = 0; i < most_; ++i) sum[i] -= d * sums_[j][i];
      }
    const Real length = std::sqrt(dot(v, v));
    if (!(length > kSame * std::sqrt(dot(row, row)))) {
      for (Real& x : sum) x = -x;
      sum[count_ - 1] = 0;
      return sum;
    }
    for (Real& x : v) x /= length;
    for (Real& x : sum) x /= length;
    directions_.push_back(std::move(v)), sums_.push_back(std::move(sum));
    return std::nullopt;
  }
  std::size_t count() const { return count_; }

 private:
  std::size_t most_, count_ = 0;
  std::vector<Numbers> directions_, sums_;
};

// The bound of the friction of a contact, up to a common factor.
Real bound(const ContactProblem& p, const ContactSolution& f, std::size_t c) {
  return std::max(0.0L, p.contacts[c].static_friction * f.normal[c]);
}

class Sharing {
 public:
  // `order`: the order in which contacts become holding ones.
  Sharing(const ContactProblem& p, ContactModes& modes, const std::vector<std::size_t>& order) : modes_(modes) {
    std::size_t most = p.beta.size();
    for (const ContactRows& rows : p.contacts) most += 1 + rows.tangential.size();
    GramSchmidt rows(most);
    for (const Numbers& r : p.Phi) rows.add(r);
    std::vector<std::size_t> gaps(modes.size(), most), held_gaps;
    for (std::size_t c = 0; c < modes.size(); ++c) {
      if (modes[c].touch == Touch::open || p.contacts[c].under) continue;
      gaps[c] = rows.count();
      const auto sum = rows.add(p.contacts[c].normal);
      modes[c].load = {};
      if (!sum) {
        held_gaps.push_back(c);
        continue;
      }
      // This contact has the least loads of all that have the same effect.
      modes[c].load.shared = true;
      for (const std::size_t g : held_gaps) modes[c].load.of.push_back((*sum)[gaps[g]]);
    }
    struct Found {
      HeldComponent place;
      std::size_t at;
      std::optional<Numbers> sum;
    };
    std::vector<Found> found;
    for (const std::size_t c : order) {
      if (modes[c].touch != Touch::sticks) continue;
      modes[c].shares = {};
      const std::vector<Numbers>& t = p.contacts[c].tangential;
      // Of two components, the one that depends less on others holds first; as bodies turn, it may be either.
      constexpr Real kMuchLess = 0.5L;
      const bool second_first = t.size() == 2 && rows.left_of(t[0]) < kMuchLess * rows.left_of(t[1]);
      for (std::size_t k = 0; k < t.size(); ++k) {
        const std::size_t a = second_first ? t.size() - 1 - k : k, at = rows.count();
        found.push_back({{c, a}, at, rows.add(p.contacts[c].tangential[a])});
        modes[c].shares[a].shared = found.back().sum.has_value();
      }
    }
    held_ = held_components(p, modes);
    for (const Found& d : found) {
      if (!d.sum) continue;
      Dependent row{d.place, Numbers(held_.size(), 0), Numbers(modes.size(), 0)};
      for (std::size_t k = 0; k < held_.size(); ++k)
        for (const Found& h : found)
          if (h.place.contact == held_[k].contact && h.place.component == held_[k].component)
            row.of_held[k] = (*d.sum)[h.at];
      for (std::size_t c = 0; c < modes.size(); ++c)
        if (gaps[c] < most) row.of_gaps[c] = (*d.sum)[gaps[c]];
      dependent_.push_back(std::move(row));
    }
  }

  // Sets the shares of equal creep, weighted by the bounds of the contacts.
  void weigh(const Numbers& bounds) {
    for (const Dependent& d : dependent_) {
      Numbers of = d.of_held;
      for (std::size_t k = 0; k < of.size(); ++k)
        of[k] *= bounds[held_[k].contact] > 0 ? bounds[d.place.contact] / bounds[held_[k].contact] : 0;
      modes_[d.place.contact].shares[d.place.component].of = std::move(of);
    }
  }

  const std::vector<HeldComponent>& held() const { return held_; }
  const std::vector<Dependent>& dependent() const { return dependent_; }

 private:
  ContactModes& modes_;
  std::vector<HeldComponent> held_;
  std::vector<Dependent> dependent_;
};

std::vector<std::size_t> in_order(std::size_t count) {
  std::vector<std::size_t> order(count);
  for (std::size_t c = 0; c < count; ++c) order[c] = c;
  return order;
}

// The least spare part of a bound among contacts at rest; contacts without a bound and without friction do not count.
Real spare_of(const ContactProblem& p, const ContactSolution& f, Real force) {
  Real spare = 1;
  for (std::size_t c = 0; c < f.modes.size(); ++c) {
    if (f.modes[c].touch != Touch::sticks || !p.contacts[c].rough) continue;
    const Real most = bound(p, f, c), is = std::hypot(f.friction[c][0], f.friction[c][1]);
    if (most > kSame * force)
      spare = std::min(spare, 1 - is / most);
    else if (is > kSame * force)
      spare = std::min(spare, -is / force);
  }
  return spare;
}

// The distribution with the largest spare part: of all y and s with |T(y)| <= mu N(y) - s u for each contact, where u
// is its earlier bound, the one with the largest s; by Newton's method with a barrier that becomes steeper.
class MostSpared {
 public:
  MostSpared(const ContactProblem& p, const ContactSolution& f, const Sharing& sharing, Real force)
      : size_(sharing.dependent().size() + 1), z_(size_, 0) {
    Real s = 1;
    for (std::size_t c = 0; c < f.modes.size(); ++c) {
      const Real u = bound(p, f, c);
      if (f.modes[c].touch != Touch::sticks || !p.contacts[c].rough || !(u > kSame * force)) continue;
      Cone cone{u / force, Numbers(size_, 0), {f.friction[c][0] / force, f.friction[c][1] / force}, {}};
      cone.q_z.fill(Numbers(size_, 0));
      const std::size_t normal = p.contacts[c].under.value_or(c);
      for (std::size_t d = 0; d + 1 < size_; ++d) {
        const Dependent& row = sharing.dependent()[d];
        cone.p_z[d] = -p.contacts[c].static_friction * row.of_gaps[normal];
        if (row.place.contact == c) cone.q_z[row.place.component][d] += 1;
        for (std::size_t k = 0; k < row.of_held.size(); ++k)
          if (sharing.held()[k].contact == c) cone.q_z[sharing.held()[k].component][d] -= row.of_held[k];
      }
      cone.p_z[size_ - 1] = -u / force;
      s = std::min(s, 1 - std::hypot(cone.q[0], cone.q[1]) / cone.p);
      cones_.push_back(std::move(cone));
    }
    z_[size_ - 1] = s - 0.5L;
  }

  // Returns the changes of the dependent components, in units of `force`, followed by s.
  const Numbers& solve() {
    constexpr Real kFirst = 1, kLast = 1e13L, kSteeper = 10;
    constexpr int kMost = 30;
    for (Real steep = kFirst; steep <= kLast; steep *= kSteeper)
      for (int k = 0; k < kMost && step(steep); ++k) continue;
    return z_;
  }

 private:
  // The cone |q + q_z z| <= p + p_z z.
  struct Cone {
    Real p;
    Numbers p_z;
    std::array<Real, 2> q;
    std::array<Numbers, 2> q_z;
  };

  // -log of the product of all p^2 - |q|^2, plus -s times `steep`; infinite outside of a cone.
  Real barrier(const Numbers& z, Real steep) const {
    Real sum = -steep * z[size_ - 1];
    for (const Cone& c : cones_) {
      const Real p = c.p + dot(c.p_z, z), q0 = c.q[0] + dot(c.q_z[0], z), q1 = c.q[1] + dot(c.q_z[1], z);
      const Real q = std::hypot(q0, q1);
      if (!(p > q)) return std::numeric_limits<Real>::infinity();
      sum -= std::log(p - q) + std::log(p + q);
    }
    return sum;
  }

  // Makes one step of Newton's method with halving; returns false at the end of the iteration.
  bool step(Real steep) {
    constexpr Real kEnough = 1e-10L;
    std::vector<Numbers> H(size_, Numbers(size_, 0));
    Numbers g(size_, 0);
    g[size_ - 1] = -steep;
    for (const Cone& c : cones_) {
      const Real p = c.p + dot(c.p_z, z_), q0 = c.q[0] + dot(c.q_z[0], z_), q1 = c.q[1] + dot(c.q_z[1], z_);
      const Real q = std::hypot(q0, q1), h = (p - q) * (p + q);
      Numbers slope(size_);
      for (std::size_t i = 0; i < size_; ++i) slope[i] = 2 * (p * c.p_z[i] - q0 * c.q_z[0][i] - q1 * c.q_z[1][i]) / h;
      for (std::size_t i = 0; i < size_; ++i) {
        g[i] -= slope[i];
        for (std::size_t j = 0; j < size_; ++j)
          H[i][j] += slope[i] * slope[j] -
                     2 * (c.p_z[i] * c.p_z[j] - c.q_z[0][i] * c.q_z[0][j] - c.q_z[1][i] * c.q_z[1][j]) / h;
      }
    }
    const Numbers d = solve_positive(H, g);
    const Real decrement = dot(g, d);
    if (!(decrement > kEnough)) return false;
    const Real before = barrier(z_, steep);
    constexpr int kHalves = 60;
    Real part = 1;
    for (int k = 0; k < kHalves; ++k, part /= 2) {
      Numbers next = z_;
      for (std::size_t i = 0; i < size_; ++i) next[i] -= part * d[i];
      if (barrier(next, steep) < before) {
        z_ = std::move(next);
        return true;
      }
    }
    return false;
  }

  std::size_t size_;
  std::vector<Cone> cones_;
  Numbers z_;
};

// Makes the present forces of the contacts given ones, and leaves the shares for later changes.
void give(const ContactSolution& f, const Sharing& sharing, const Numbers& y, Real force, ContactModes& modes) {
  for (std::size_t c = 0; c < modes.size(); ++c)
    for (std::size_t a = 0; a < 2; ++a) modes[c].shares[a].given = f.friction[c][a];
  for (std::size_t d = 0; d < sharing.dependent().size(); ++d) {
    const Dependent& row = sharing.dependent()[d];
    modes[row.place.contact].shares[row.place.component].given += force * y[d];
    for (std::size_t k = 0; k < row.of_held.size(); ++k) {
      const HeldComponent& h = sharing.held()[k];
      modes[h.contact].shares[h.component].given -= force * y[d] * row.of_held[k];
    }
  }
}

}  // namespace

void share_forces(const ContactProblem& p, ContactModes& modes) {
  const auto touches = [](const ContactMode& m) { return m.touch != Touch::open; };
  if (std::none_of(modes.begin(), modes.end(), touches)) return;
  Sharing(p, modes, in_order(modes.size())).weigh(Numbers(modes.size(), 1));
}

long double load_without_effect(const ContactProblem& p, const std::vector<std::size_t>& contacts,
                                const ContactSolution& f) {
  // The part of the rows that is orthogonal to the constraints, as columns with one number for each contact.
  GramSchmidt constraints(p.beta.size() + contacts.size());
  for (const Numbers& r : p.Phi) constraints.add(r);
  std::vector<Numbers> rows;
  for (const std::size_t c : contacts) rows.push_back(constraints.rest_of(p.contacts[c].normal));
  GramSchmidt columns(p.b.size());
  Real size = 0;
  for (const Numbers& r : rows) size = std::max(size, largest(r));
  for (std::size_t i = 0; i < p.b.size(); ++i) {
    Numbers column;
    for (const Numbers& r : rows) column.push_back(r[i]);
    if (largest(column) > kSame * size) columns.add(column);
  }
  Numbers loads;
  for (const std::size_t c : contacts) loads.push_back(f.modes[c].touch == Touch::open ? 0 : f.normal[c]);
  const Numbers rest = columns.rest_of(loads);
  return std::sqrt(dot(rest, rest));
}

std::optional<ContactSolution> distributed(const ContactProblem& p, const ContactSolution& equal) {
  constexpr int kSettled = 3;
  constexpr Real kSpared = 1e-9L;
  const Real force = size_of_forces(p, equal);
  ContactModes modes = equal.modes;
  std::vector<std::size_t> order = in_order(modes.size());
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return bound(p, equal, a) > bound(p, equal, b); });
  Sharing sharing(p, modes, order);
  std::optional<ContactSolution> f = equal;
  for (int k = 0; f && k < kSettled; ++k) {
    Numbers bounds;
    for (std::size_t c = 0; c < modes.size(); ++c) bounds.push_back(bound(p, *f, c));
    sharing.weigh(bounds);
    f = of_modes(p, modes);
  }
  if (!f) return f;
  f->spare = spare_of(p, *f, force);
  if (*f->spare > kSpared) return f;
  MostSpared most(p, *f, sharing, force);
  const Numbers& y = most.solve();
  give(*f, sharing, y, force, modes);
  f = of_modes(p, modes);
  if (f) f->spare = spare_of(p, *f, force);
  return f;
}

}  // namespace anholon
