#include "contact/law/consistent_modes.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "contact/law/contact_groups.h"
#include "contact/law/least_constraint.h"
#include "contact/law/rows.h"
#include "contact/law/shared_forces.h"
#include "contact/law/slip_directions.h"

namespace anholon {

namespace {

using Real = long double;
using Numbers = ContactNumbers;

// The round-off of a slip acceleration; `size`: the size of the accelerations, `free`: that without contacts.
Real round_off_of_slip(const ContactRows& rows, Real size, Real free) {
  constexpr Real kRounded = 1e-14L;
  Real most = 0;
  for (std::size_t a = 0; a < rows.tangential.size(); ++a)
    most = std::max(most, kSame * (largest(rows.tangential[a]) * size + std::abs(rows.tangential_rate[a])) +
                              kRounded * rows.friction * largest(rows.tangential[a]) * free);
  return most;
}

// The size of a given force, relative to which a force counts as zero. A force whose terms cancel is not known better than
// to the round-off of the terms.
Real size_of_given(const ContactProblem& p, std::size_t a) {
  constexpr Real kRoundOff = 1e-15L;
  const Real terms = p.terms_of_b.empty() ? 0 : p.terms_of_b[a];
  return std::max(std::abs(p.b[a]), terms * kRoundOff / kSame);
}

Real largest_given(const ContactProblem& p) {
  Real most = 0;
  for (std::size_t a = 0; a < p.b.size(); ++a) most = std::max(most, size_of_given(p, a));
  return most;
}

// The size of the accelerations that the given forces would cause without constraints and contacts: constraints may
// leave of them a round-off alone.
Real of_given_forces(const ContactProblem& p) {
  Real most = 0;
  for (std::size_t a = 0; a < p.b.size(); ++a)
    if (const Real inertia = std::abs(p.A[a][a]); inertia > 0) most = std::max(most, size_of_given(p, a) / inertia);
  return most;
}

// `free`: the size of the accelerations without contacts. If the contacts leave no acceleration, the accelerations of
// the modes are round-off of this size.
bool consistent(const ContactProblem& p, const ContactSolution& f, Real free) {
  const Real force = largest_given(p), size = std::max(largest(f.x), free);
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
    if (mode.load.shared && std::abs(dot(rows.normal, f.x) + rows.normal_rate) > scale) return false;
    if (!rows.rough) continue;
    const auto v = slip_rate(rows, f.x);
    const Real span = round_off_of_slip(rows, size, free);
    if (mode.touch == Touch::sticks) {
      for (std::size_t a = 0; a < rows.tangential.size(); ++a)
        if (mode.shares[a].shared && std::abs(v[a]) > span) return false;
      if (std::hypot(f.friction[c][0], f.friction[c][1]) > rows.static_friction * N + forces) return false;
    } else if (!rows.moves && v[0] * mode.direction[0] + v[1] * mode.direction[1] < -span) {
      return false;
    }
  }
  return true;
}

// The slip acceleration along the direction of a contact at rest that may stick, and slips in this mode; nullopt for
// another contact.
std::optional<Real> slip_that_begins(const ContactRows& rows, const ContactMode& mode, const Numbers& x) {
  if (mode.touch != Touch::slips || !rows.rough || rows.moves || !rows.may_stick) return std::nullopt;
  const auto v = slip_rate(rows, x);
  return v[0] * mode.direction[0] + v[1] * mode.direction[1];
}

// Gives slips that begin against no friction the direction of their accelerations, which do not depend on it.
void turn_smooth_slips(const ContactProblem& p, ContactSolution& f) {
  for (std::size_t c = 0; c < p.contacts.size(); ++c) {
    const ContactRows& rows = p.contacts[c];
    if (f.modes[c].touch != Touch::slips || !rows.rough || rows.moves || rows.friction != 0) continue;
    const auto v = slip_rate(rows, f.x);
    if (const Real size = std::hypot(v[0], v[1]); size > 0) f.modes[c].direction = {v[0] / size, v[1] / size};
  }
}

// True if a contact at rest that may stick, and that the others hold, slips in this solution by round-off only.
bool slips_by_round_off(const ContactProblem& p, const ContactSolution& f, Real free) {
  const auto sticks = [](const ContactMode& m) { return m.touch == Touch::sticks; };
  if (std::none_of(f.modes.begin(), f.modes.end(), sticks)) return false;
  const Real size = std::max(largest(f.x), free);
  for (std::size_t c = 0; c < p.contacts.size(); ++c) {
    const ContactRows& rows = p.contacts[c];
    const auto along = slip_that_begins(rows, f.modes[c], f.x);
    if (along && *along <= round_off_of_slip(rows, size, free)) return true;
  }
  return false;
}

ContactMode mode(Touch touch, const std::array<Real, 2>& direction) {
  ContactMode m;
  m.touch = touch, m.direction = direction;
  return m;
}

// The modes that one contact may take: first those that touch, sticking before slipping.
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

// True if two solutions are different motions. A contact that may stick does so, whether or not it could begin to slip
// as well, so only open and touching make a difference.
bool alternatives(const ContactSolution& a, const ContactSolution& b) {
  bool open = false;
  for (std::size_t c = 0; c < a.modes.size(); ++c)
    open = open || (a.modes[c].touch == Touch::open) != (b.modes[c].touch == Touch::open);
  return open;
}

// True if b differs from a by further touching contacts that carry nothing: their gaps stay closed in a, too, because
// others hold them. `free`: see consistent().
bool is_part(const ContactProblem& p, const ContactSolution& a, const ContactSolution& b, Real free) {
  bool more = false;
  for (std::size_t c = 0; c < a.modes.size(); ++c) {
    const bool touches_a = a.modes[c].touch != Touch::open, touches_b = b.modes[c].touch != Touch::open;
    if (touches_a && !touches_b) return false;
    if (touches_a || !touches_b || p.contacts[c].under) continue;
    const ContactRows& rows = p.contacts[c];
    const Real size = largest(rows.normal) * std::max(largest(a.x), free) + std::abs(rows.normal_rate);
    if (std::abs(dot(rows.normal, a.x) + rows.normal_rate) > kSame * size) return false;
    more = true;
  }
  return more;
}

// True if the contacts that touch in one of two solutions stay closed in both.
bool same_gaps_closed(const ContactProblem& p, const ContactSolution& a, const ContactSolution& b, Real free) {
  for (std::size_t c = 0; c < a.modes.size(); ++c) {
    const ContactRows& rows = p.contacts[c];
    if (rows.under || (a.modes[c].touch == Touch::open) == (b.modes[c].touch == Touch::open)) continue;
    const ContactSolution& open = a.modes[c].touch == Touch::open ? a : b;
    const Real size = largest(rows.normal) * std::max(largest(open.x), free) + std::abs(rows.normal_rate);
    if (std::abs(dot(rows.normal, open.x) + rows.normal_rate) > kSame * size) return false;
  }
  return true;
}

// True if the loads of a have a smaller part without effect along the gaps than those of b; contacts count that touch
// in one of the two.
bool takes_less(const ContactProblem& p, const ContactSolution& a, const ContactSolution& b) {
  std::vector<std::size_t> list;
  for (std::size_t c = 0; c < p.contacts.size(); ++c)
    if (!p.contacts[c].under && (a.modes[c].touch != Touch::open || b.modes[c].touch != Touch::open)) list.push_back(c);
  return load_without_effect(p, list, a) < load_without_effect(p, list, b);
}

// Resistance is open if its contact is, unless a given force presses it.
bool possible(const ContactProblem& p, const ContactModes& modes) {
  for (std::size_t c = 0; c < modes.size(); ++c)
    if (const auto& under = p.contacts[c].under)
      if ((modes[c].touch == Touch::open) != (modes[*under].touch == Touch::open && p.contacts[c].pressed == 0))
        return false;
  return true;
}

// The solutions found; each of them is another motion.
class Solutions {
 public:
  explicit Solutions(const ContactProblem& p) : p_(p) {
    const auto open = of_modes(p, ContactModes(p.contacts.size()));
    free_ = std::max({open ? largest(open->x) : 0, of_given_forces(p), Real(1e-300L)});
  }

  // Returns the solution of modes; the directions of slips that begin are guesses. Returns nullopt if the modes are not
  // consistent.
  std::optional<ContactSolution> judge(const ContactModes& modes) const {
    auto f = solve(modes);
    if (f && !consistent(p_, *f, free_)) f.reset();
    return f;
  }
  // Like judge(), for modes of least constraint. A contact at its limit that slips in these modes, and would slip
  // backwards, sticks instead.
  std::optional<ContactSolution> settle(ContactModes modes) const {
    for (std::size_t k = 0; k <= modes.size(); ++k) {
      const auto f = solve(modes);
      if (!f) return std::nullopt;
      bool any = false;
      for (std::size_t c = 0; c < modes.size(); ++c)
        if (const auto along = slip_that_begins(p_.contacts[c], f->modes[c], f->x); along && !(*along > 0))
          modes[c].touch = Touch::sticks, any = true;
      if (!any) return consistent(p_, *f, free_) ? f : std::nullopt;
    }
    return std::nullopt;
  }
  bool slips_by_round_off(const ContactSolution& f) const { return anholon::slips_by_round_off(p_, f, free_); }
  // Adds a solution. Solutions in which the same gaps stay closed differ in the loads of contacts that hold them
  // together; the least loads are kept.
  void add(const ContactSolution& f) {
    if (known(f)) return;
    std::erase_if(list_, [&](const ContactSolution& o) {
      return is_part(p_, o, f, free_) || (same_gaps_closed(p_, o, f, free_) && takes_less(p_, f, o));
    });
    list_.push_back(f);
  }

  const std::vector<ContactSolution>& list() const { return list_; }

 private:
  bool known(const ContactSolution& f) const {
    return std::any_of(list_.begin(), list_.end(), [&](const ContactSolution& o) {
      Real difference = 0;
      for (std::size_t i = 0; i < o.x.size(); ++i) difference = std::max(difference, std::abs(o.x[i] - f.x[i]));
      return difference <= 100 * kSame * std::max({largest(o.x), largest(f.x), free_}) || !alternatives(o, f) ||
             is_part(p_, f, o, free_) || (same_gaps_closed(p_, o, f, free_) && !takes_less(p_, f, o));
    });
  }

  std::optional<ContactSolution> solve(ContactModes modes) const {
    share_forces(p_, modes);
    auto f = with_directions(p_, modes, free_);
    if (f && shares_friction(modes)) f = distributed(p_, *f);
    if (f) turn_smooth_slips(p_, *f);
    return f;
  }

  const ContactProblem& p_;
  Real free_ = 0;
  std::vector<ContactSolution> list_;
};

// True if these contacts, if they are slow, are inside of their cones by more than round-off.
bool inside_cones(const ContactProblem& p, const ContactSolution& f, const std::vector<bool>& list,
                  const std::vector<bool>& slow) {
  constexpr Real kInside = 1e-12L;
  for (std::size_t c = 0; c < list.size(); ++c) {
    const Real most = p.contacts[c].static_friction * f.normal[c];
    if (list[c] && slow[c] && !(std::hypot(f.friction[c][0], f.friction[c][1]) < (1 - kInside) * most)) return false;
  }
  return true;
}

// The contacts that slip in modes of least constraint, and might stick. Those modes cannot tell contacts that static
// friction barely holds from contacts that begin to slip: such contacts stick if they can. A contact with one coefficient
// begins to slip slowly, so that round-off of its cone would hold it; it sticks if it is inside.
class MightStick {
 public:
  MightStick(const ContactProblem& p, const Solutions& solutions, const ContactModes& modes)
      : p_(p), solutions_(solutions), modes_(modes), might_(modes.size(), false), slow_(modes.size(), false),
        groups_(contact_groups(p)) {
    for (std::size_t c = 0; c < modes.size(); ++c) {
      const ContactRows& rows = p.contacts[c];
      if (modes[c].touch != Touch::slips || !rows.rough || rows.moves || !rows.may_stick) continue;
      might_[c] = true;
      slow_[c] = rows.friction == rows.static_friction;
    }
  }

  // Returns the solution in which as many of them stick as can.
  std::optional<ContactSolution> find() {
    if (auto f = all_of(might_)) return f;
    std::set<std::size_t> groups;
    for (std::size_t c = 0; c < modes_.size(); ++c)
      if (might_[c]) groups.insert(groups_[c]);
    // Bodies that nothing joins do so one after the other.
    for (auto g = groups.begin(); groups.size() > 1 && g != groups.end(); ++g) {
      std::vector<bool> list = might_;
      for (std::size_t c = 0; c < list.size(); ++c) list[c] = list[c] && groups_[c] == *g;
      if (all_of(list) || all_of(without_slow(list))) modes_ = tried_;
    }
    if (auto f = all_of(without_slow(might_))) return f;
    return solutions_.settle(modes_);
  }

 private:
  std::vector<bool> without_slow(std::vector<bool> list) const {
    for (std::size_t c = 0; c < list.size(); ++c) list[c] = list[c] && !slow_[c];
    return list;
  }
  // Returns the solution in which these contacts stick, if there is any of them.
  std::optional<ContactSolution> all_of(const std::vector<bool>& list) {
    tried_ = modes_;
    bool any = false;
    for (std::size_t c = 0; c < list.size(); ++c)
      if (list[c]) tried_[c].touch = Touch::sticks, any = true;
    if (!any) return std::nullopt;
    auto f = solutions_.judge(tried_);
    if (f && !inside_cones(p_, *f, list, slow_)) f.reset();
    return f;
  }

  const ContactProblem& p_;
  const Solutions& solutions_;
  ContactModes modes_, tried_;
  std::vector<bool> might_, slow_;
  std::vector<std::size_t> groups_;
};

// Tries all sets of touching contacts together.
std::vector<ContactSolution> tried_together(const ContactProblem& p) {
  std::vector<ContactModes> each;
  std::size_t count = 1;
  for (const ContactRows& rows : p.contacts) {
    each.push_back(choices(rows, rows.under ? p.contacts[*rows.under].may_touch : rows.may_touch));
    count *= each.back().size();
  }
  Solutions solutions(p);
  // Tells for each set of touching contacts whether a solution is found.
  std::map<std::vector<bool>, bool> found;
  for (std::size_t k = 0; k < count; ++k) {
    ContactModes modes;
    std::vector<bool> touches;
    for (std::size_t c = 0, rest = k; c < each.size(); ++c) {
      modes.push_back(each[c][rest % each[c].size()]);
      touches.push_back(modes.back().touch != Touch::open);
      rest /= each[c].size();
    }
    if (!possible(p, modes)) continue;
    const auto [at, first] = found.try_emplace(touches, false);
    if (first)
      if (const auto guess = modes_of_least_constraint(p, touches))
        if (const auto f = MightStick(p, solutions, *guess).find()) at->second = true, solutions.add(*f);
    if (at->second) continue;
    // A second solution with the same touching contacts would be the same motion.
    if (const auto f = solutions.judge(modes); f && !solutions.slips_by_round_off(*f))
      at->second = true, solutions.add(*f);
  }
  return solutions.list();
}

// The equations with the contacts of one group alone: all others are open, and their gaps do not count.
ContactProblem of_group(const ContactProblem& p, const std::vector<std::size_t>& groups, std::size_t group) {
  ContactProblem alone = p;
  for (std::size_t c = 0; c < groups.size(); ++c) {
    ContactRows& rows = alone.contacts[c];
    if (groups[c] == group) continue;
    rows.normal.assign(p.b.size(), 0), rows.normal_rate = 0, rows.pressed = 0;
    rows.may_touch = false, rows.may_open = true;
  }
  return alone;
}

}  // namespace

std::vector<ContactSolution> consistent_modes(const ContactProblem& p) {
  const std::vector<std::size_t> groups = contact_groups(p);
  std::set<std::size_t> touching;
  for (std::size_t c = 0; c < groups.size(); ++c)
    if (p.contacts[c].may_touch || p.contacts[c].pressed != 0) touching.insert(groups[c]);
  if (touching.size() < 2) return tried_together(p);
  // Each solution of a group goes with each one of the others.
  std::vector<ContactModes> all = {ContactModes(groups.size())};
  for (const std::size_t group : touching) {
    const std::vector<ContactSolution> list = tried_together(of_group(p, groups, group));
    std::vector<ContactModes> more;
    for (const ContactModes& modes : all)
      for (const ContactSolution& f : list) {
        more.push_back(modes);
        for (std::size_t c = 0; c < groups.size(); ++c)
          if (groups[c] == group) more.back()[c] = f.modes[c];
      }
    all = std::move(more);
  }
  Solutions solutions(p);
  for (const ContactModes& modes : all) {
    const auto f = solutions.judge(modes);
    if (!f) return tried_together(p);
    solutions.add(*f);
  }
  return all.empty() ? tried_together(p) : solutions.list();
}

std::optional<ContactSolution> consistent_in(const ContactProblem& p, const ContactModes& modes) {
  return Solutions(p).judge(modes);
}

}  // namespace anholon
