#include "contact/law/shared_forces.h"

#include "contact/law/cone_barrier.h"

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

  // True if friction that is distributed in another way changes the load of this contact.
  bool changes_load(const ContactProblem& p, std::size_t c) const {
    return std::any_of(dependent_.begin(), dependent_.end(), [&](const Dependent& d) {
      return std::abs(d.of_gaps[c]) > kSame && p.contacts[d.place.contact].static_friction > 0;
    });
  }

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

// The least spare part of a bound among contacts at rest. Contacts without a bound and without friction do not count,
// unless another distribution changes their loads. A load that pulls has a negative spare part.
Real spare_of(const ContactProblem& p, const ContactSolution& f, const Sharing& sharing, Real force) {
  Real spare = 1;
  for (std::size_t c = 0; c < f.modes.size(); ++c) {
    if (f.modes[c].touch == Touch::open) continue;
    const bool changes = sharing.changes_load(p, p.contacts[c].under.value_or(c));
    if (f.normal[c] < (changes ? kSame : -kSame) * force && !p.contacts[c].under)
      spare = std::min(spare, f.normal[c] / force);
    if (f.modes[c].touch != Touch::sticks || !p.contacts[c].rough) continue;
    const Real most = bound(p, f, c), is = std::hypot(f.friction[c][0], f.friction[c][1]);
    if (most > kSame * force)
      spare = std::min(spare, 1 - is / most);
    else if (is > kSame * force)
      spare = std::min(spare, -is / force);
  }
  return spare;
}

// All distributions of friction: the dependent components y are free, and the other forces are linear functions of them,
// because the motion stays the same, or because contacts that slip have friction in proportion to their loads.
class Distributions {
 public:
  // `f`: the distribution y = 0, with the modes of `sharing`.
  Distributions(const ContactProblem& p, const ContactSolution& f, const Sharing& sharing, Real force)
      : p_(p), f_(f), force_(force) {
    for (const Dependent& d : sharing.dependent()) {
      if (!(p.contacts[d.place.contact].static_friction > 0)) continue;
      ContactModes modes = f.modes;
      modes[d.place.contact].shares[d.place.component].given = force;
      if (auto by = of_modes(p, modes)) by_.push_back(std::move(*by));
    }
    for (const Real N : f.normal) load_ = std::max(load_, std::abs(N) / force);
    for (std::size_t c = 0; c < f.modes.size(); ++c) add_cone(c);
  }

  // Returns the distribution with the largest spare part: of all y and s with |T(y)| <= mu N(y) - s u for each contact,
  // the one with the largest s, where u is the bound at y = 0, or a part of the largest bound if y changes the load.
  // Loads that are larger than necessary, as of a wedge, are reduced.
  ContactModes most_spared() const {
    constexpr Real kSteepest = 1e13L, kMargin = 0.5L, kMost = 2, kPressed = 4;
    Numbers z(by_.size() + 1, 0), slope(by_.size() + 1, 0);
    Real s = kMost;
    for (const AffineCone& c : cones_) s = std::min(s, (c.p - std::hypot(c.q[0], c.q[1])) / -c.p_z.back());
    z.back() = s - kMargin, slope.back() = -1;
    std::vector<AffineCone> cones = cones_;
    if (loads_change_) {
      cones.push_back(linear(kMost, Numbers(z.size(), 0)));
      cones.back().p_z.back() = -1;
      cones.push_back(largest_sum());
    }
    minimize_within(cones, slope, kSteepest, z);
    if (loads_change_ && sum_of_bounds(z) > kPressed * (sum_of_bounds(Numbers(z.size(), 0)) + 1)) press_less(z);
    return given(z);
  }

 private:
  AffineCone linear(Real p, Numbers p_z) const {
    AffineCone c{p, std::move(p_z), {}, {}};
    c.q_z.fill(Numbers(by_.size() + 1, 0));
    return c;
  }

  // Adds the condition |T| <= mu N - s u, or N >= s u for a contact without friction that holds it.
  void add_cone(std::size_t c) {
    constexpr Real kLeast = 0.1L;
    const ContactRows& rows = p_.contacts[c];
    if (f_.modes[c].touch == Touch::open) return;
    const bool holds = f_.modes[c].touch == Touch::sticks && rows.rough && rows.static_friction > 0;
    if (!holds && rows.under) return;
    const Real mu = holds ? rows.static_friction : 1;
    AffineCone cone = linear(mu * f_.normal[c] / force_, Numbers(by_.size() + 1, 0));
    bool moves = false, presses = false;
    for (std::size_t d = 0; d < by_.size(); ++d) {
      cone.p_z[d] = mu * (by_[d].normal[c] - f_.normal[c]) / force_;
      presses = presses || std::abs(cone.p_z[d]) > kSame * mu;
      for (std::size_t a = 0; holds && a < 2; ++a) {
        cone.q_z[a][d] = (by_[d].friction[c][a] - f_.friction[c][a]) / force_;
        moves = moves || std::abs(cone.q_z[a][d]) > kSame;
      }
    }
    if (holds) cone.q = {f_.friction[c][0] / force_, f_.friction[c][1] / force_};
    if (!presses && (!holds || !(cone.p > kSame))) return;
    cone.p_z.back() = -std::max(cone.p, presses ? kLeast * mu * load_ : 0);
    loads_change_ = loads_change_ || presses;
    cones_.push_back(std::move(cone));
  }

  Real sum_of_bounds(const Numbers& z) const {
    Real sum = 0;
    for (const AffineCone& c : cones_) sum += std::abs(c.height(z) - c.p_z.back() * z.back());
    return sum;
  }
  // The condition that keeps the sum of the bounds finite.
  AffineCone largest_sum() const {
    constexpr Real kLargest = 1e6L;
    AffineCone all = linear(kLargest * (sum_of_bounds(Numbers(by_.size() + 1, 0)) + 1), Numbers(by_.size() + 1, 0));
    for (const AffineCone& c : cones_) {
      all.p -= c.p;
      for (std::size_t d = 0; d < by_.size(); ++d) all.p_z[d] -= c.p_z[d];
    }
    return all;
  }

  // Makes the sum of the bounds the least with which half of the spare part is left.
  void press_less(Numbers& z) const {
    constexpr Real kSteepest = 1e6L, kHalf = 0.5L;
    if (!(z.back() > 0)) return;
    const Real s = std::min(kHalf * z.back(), kHalf);
    std::vector<AffineCone> cones = cones_;
    Numbers slope(z.size() - 1, 0), y = z;
    y.pop_back();
    for (AffineCone& c : cones) {
      for (std::size_t d = 0; d < y.size(); ++d) slope[d] += c.p_z[d];
      c.p += s * c.p_z.back();
      c.p_z.pop_back(), c.q_z[0].pop_back(), c.q_z[1].pop_back();
    }
    minimize_within(cones, slope, kSteepest, y);
    std::copy(y.begin(), y.end(), z.begin());
  }

  // Makes the friction of a distribution given, and leaves the shares for later changes.
  ContactModes given(const Numbers& z) const {
    ContactModes modes = f_.modes;
    for (std::size_t c = 0; c < modes.size(); ++c)
      for (std::size_t a = 0; a < 2; ++a) {
        Real T = f_.friction[c][a];
        for (std::size_t d = 0; d < by_.size(); ++d) T += z[d] * (by_[d].friction[c][a] - f_.friction[c][a]);
        modes[c].shares[a].given = T;
      }
    return modes;
  }

  const ContactProblem& p_;
  const ContactSolution& f_;
  Real force_, load_ = 0;
  std::vector<ContactSolution> by_;  // the forces if one of the components is 1, in units of `force`
  std::vector<AffineCone> cones_;    // their last number is s
  bool loads_change_ = false;
};

}  // namespace

void share_forces(const ContactProblem& p, ContactModes& modes) {
  const auto touches = [](const ContactMode& m) { return m.touch != Touch::open; };
  if (std::none_of(modes.begin(), modes.end(), touches)) return;
  Sharing(p, modes, in_order(modes.size())).weigh(Numbers(modes.size(), 1));
}

bool others_keep_gap(const ContactProblem& p, const ContactModes& modes, std::size_t contact) {
  std::size_t most = p.beta.size();
  for (const ContactRows& rows : p.contacts) most += 1 + rows.tangential.size();
  GramSchmidt kept(most);
  for (const Numbers& r : p.Phi) kept.add(r);
  for (std::size_t c = 0; c < modes.size(); ++c) {
    if (modes[c].touch == Touch::open) continue;
    if (!p.contacts[c].under) kept.add(p.contacts[c].normal);
    for (const Numbers& t : p.contacts[c].tangential)
      if (modes[c].touch == Touch::sticks) kept.add(t);
  }
  return largest(p.contacts[contact].normal) > 0 && kept.left_of(p.contacts[contact].normal) <= kSame;
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
  f->spare = spare_of(p, *f, sharing, force);
  if (*f->spare > kSpared) return f;
  f = of_modes(p, Distributions(p, *f, sharing, force).most_spared());
  if (f) f->spare = spare_of(p, *f, sharing, force);
  return f;
}

}  // namespace anholon
