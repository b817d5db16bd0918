#include "contact/slip_start.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "contact/law/consistent_modes.h"
#include "contact/law/rows.h"
#include "contact/law/shared_forces.h"

namespace anholon {

// A slip velocity with two components begins at this part of the velocities, because at zero it has no direction.
static constexpr long double kSeed = 1e-10L;
// Contacts that share friction stick if all cones have more than this part of the bounds to spare.
static constexpr long double kSpared = 1e-12L;

// The part of the forces by which the friction of a contact that sticks is above its bound at a state; nullopt if the
// equations are singular there.
static std::optional<long double> beyond_bound(TouchingBodies& bodies, std::size_t c, const ContactState& at) {
  bodies.dynamics.go(at);
  const ContactProblem& p = bodies.dynamics.accelerations();
  ContactModes modes = bodies.modes;
  for (std::size_t o = 0; o < modes.size(); ++o)
    if (p.contacts[o].moves) modes[o].direction = p.contacts[o].direction;
  const auto f = of_modes(p, modes);
  bodies.dynamics.go(bodies.at);
  if (!f) return std::nullopt;
  const long double bound = p.contacts[c].static_friction * f->normal[c];
  return (std::hypot(f->friction[c][0], f->friction[c][1]) - bound) / std::max(bound, size_of_forces(p, *f));
}

bool only_touches_bound(TouchingBodies& bodies, std::size_t contact, const Ahead& ahead) {
  constexpr long double kRoundOff = 1e-14L;
  const long double speed = std::max(bodies.dynamics.speed(), 1.0L);
  // Friction that hardly changes is followed for a longer time.
  for (const long double time : {1e-6L, 1e-4L, 1e-2L}) {
    ContactState at;
    if (!ahead(Rational(bodies.at.t.get_d() + static_cast<double>(time / speed)), at)) return false;
    const auto by = beyond_bound(bodies, contact, at);
    if (!by || *by > kRoundOff) return false;
    if (*by < -kRoundOff) break;
  }
  return true;
}

bool SlipStart::hold(Outcome& outcome) {
  constexpr long double kTrial = 1e-6L;
  std::fill(held_.begin(), held_.end(), Held{});
  shared_anew_ = false;
  if (shares_friction(bodies_.modes)) return share_anew(outcome);
  together_ = 0;
  if (closed_contact_may_hold()) return true;
  std::size_t c = 0;
  while (c < bodies_.contacts.size() && !begins_at_rest(c)) ++c;
  if (c == bodies_.contacts.size()) return true;
  // A force that jumps begins a slip with an acceleration.
  constexpr long double kAtBound = 1e-9L;
  if (beyond_bound(bodies_, c, bodies_.at).value_or(0) > kAtBound) return true;
  const long double trial = kTrial / std::max(bodies_.dynamics.speed(), 1.0L);
  if (const Hold how = hold_for(c, trial, outcome); how != Hold::to_its_end) return how != Hold::motion_ends;
  bodies_.dynamics.go(bodies_.at);
  ContactProblem p = bodies_.with_touching();
  bodies_.against_friction(p, c);
  const std::vector<ContactSolution> list = consistent_modes(p);
  if (list.size() != 1 || list[0].modes[c].touch != Touch::slips) return true;
  const long double rate = bodies_.dynamics.slip_acceleration(c, list[0].x) / trial;
  held_[c] = {trial, rate};
  const long double h = time_to_grow(c, rate);
  if (!(h > 2 * trial)) return true;
  if (const Hold how = hold_for(c, h - trial, outcome); how != Hold::to_its_end) return how != Hold::motion_ends;
  held_[c].time = h;
  if (holds_again(c)) bodies_.may_stick_again(c);
  return true;
}

void SlipStart::tell_who_slips_too(const ContactModes& now) {
  for (std::size_t c = 0; c < now.size() && !bodies_.modes.empty() && shares_friction(bodies_.modes); ++c) {
    if (bodies_.modes[c].touch != Touch::sticks || now[c].touch != (told_[c] ? Touch::sticks : Touch::slips)) continue;
    const std::string name = bodies_.contacts[c].name + "." + word(bodies_.contacts[c], ModeChange::slips);
    if (told_[c])
      joined_.take_back(name);
    else
      joined_.event(name, bodies_.at.t.get_d() - static_cast<double>(together_));
  }
  told_.assign(bodies_.contacts.size(), false);
}

bool SlipStart::was_held(std::size_t c) const { return together_ > 0 && bodies_.modes[c].touch == Touch::sticks; }

long double SlipStart::first_slip(std::size_t c, const std::vector<long double>& accelerations) const {
  const long double seed = kSeed * std::max(bodies_.dynamics.speed(), 1.0L);
  const auto [time, rate] = held_[c];
  if (!(time > 0)) return seed;
  const long double a = bodies_.dynamics.slip_acceleration(c, accelerations);
  // This is the integral of a = rate t + c t^2.
  return std::max(seed, a * time / 3 + rate * time * time / 6);
}

void SlipStart::guess_directions(ContactProblem& p) const {
  for (std::size_t c = 0; c < bodies_.contacts.size(); ++c)
    if (bodies_.contacts[c].slip.size() == 2 && (bodies_.excluded[c].stick || was_held(c)))
      bodies_.against_friction(p, c);
}

void SlipStart::begin(const std::vector<std::size_t>& list, const std::vector<long double>& accelerations) {
  waits_.reset(), begun_.reset();
  if (list.size() > 1) return begin_together(list, accelerations);
  if (!list.empty() && !lets_wait(list[0], accelerations)) begin_alone(list[0], accelerations);
}

void SlipStart::begin_alone(std::size_t c, const std::vector<long double>& accelerations) {
  const std::vector<double> before = bodies_.at.qd;
  bodies_.set_slip(c, bodies_.modes[c].direction, first_slip(c, accelerations));
  // This is the way of a velocity that has grown with the square of the time.
  const long double mean = held_[c].time / 3;
  for (std::size_t a = 0; a < before.size(); ++a)
    bodies_.at.q[a] = static_cast<double>(bodies_.at.q[a] + mean * (bodies_.at.qd[a] - before[a]));
}

bool SlipStart::lets_wait(std::size_t c, const std::vector<long double>& accelerations) {
  constexpr long double kFirst = 1e-8L, kLongest = 3e-7L;
  if (held_[c].time > 0) return false;
  for (std::size_t o = 0; o < bodies_.contacts.size(); ++o) {
    const TouchingBodies::Excluded& e = bodies_.excluded[o];
    if (o != c && (e.touch || e.stick || e.slips)) return false;
  }
  const long double speed = std::max(bodies_.dynamics.speed(), 1.0L);
  const long double a = bodies_.dynamics.slip_acceleration(c, accelerations);
  if (bodies_.at.t == end_) {  // the row at the start of a motion without length
    waits_ = {c, 0};
    return true;
  }
  const long double time = Rational(later(std::min(kFirst * speed / a, kLongest / speed)) - bodies_.at.t).get_d();
  if (!(a * time > kSeed * speed)) return false;
  waits_ = {c, time};
  return true;
}

bool SlipStart::wait(Outcome& outcome) {
  const auto [c, time] = *waits_;
  waits_.reset();
  const Rational to = std::min(end_, later(time));
  bodies_.modes[c].begins = true;
  const bool goes_on = segment_(to, outcome);
  bodies_.modes[c].begins = false;
  begun_ = c;
  return goes_on && outcome.ok();
}

void SlipStart::begin_together(const std::vector<std::size_t>& list, const std::vector<long double>& accelerations) {
  const ContactProblem p = bodies_.with_touching();
  ContactModes at_rest = bodies_.modes;
  for (const std::size_t c : list) at_rest[c].touch = Touch::sticks;
  share_forces(p, at_rest);
  const auto held = of_modes(p, at_rest);
  if (!held) return;
  long double time = 0;
  for (const std::size_t c : list)
    if (const long double a = bodies_.dynamics.slip_acceleration(c, accelerations); a > 0)
      time = std::max(time, first_slip(c, accelerations) / a);
  std::vector<long double> jump;
  for (std::size_t a = 0; a < accelerations.size(); ++a) jump.push_back(accelerations[a] - held->x[a]);
  time = std::min(time, time_to_reverse(jump));
  for (long double& v : jump) v *= time;
  bodies_.add_to_velocities(jump);
}

long double SlipStart::time_to_reverse(const std::vector<long double>& accelerations) const {
  long double time = std::numeric_limits<long double>::infinity();
  for (std::size_t c = 0; c < bodies_.contacts.size(); ++c) {
    const ContactRows& rows = bodies_.dynamics.accelerations().contacts[c];
    if (bodies_.modes[c].touch != Touch::slips || !rows.rough || !rows.moves) continue;
    const auto& v = bodies_.dynamics.place(c).slip;
    long double square = 0, against = 0;
    for (std::size_t k = 0; k < rows.tangential.size(); ++k) {
      square += v[k] * v[k];
      against -= v[k] * dot(rows.tangential[k], accelerations);
    }
    if (against > 0) time = std::min(time, square / (2 * against));
  }
  return time;
}

std::optional<ContactSolution> SlipStart::goes_on(const std::vector<ContactSolution>& list) const {
  for (const bool closes : {false, true}) {
    const auto as_now = [&](const ContactSolution& f) {
      return std::equal(bodies_.modes.begin(), bodies_.modes.end(), f.modes.begin(),
                        [&](const ContactMode& now, const ContactMode& then) {
                          return now.touch == then.touch || (closes && now.touch == Touch::open);
                        });
    };
    if (const auto at = std::find_if(list.begin(), list.end(), as_now); at != list.end()) return *at;
  }
  return std::nullopt;
}

std::optional<ContactSolution> SlipStart::in_present_modes(const ContactProblem& p) const {
  ContactModes modes(p.contacts.size());
  for (std::size_t c = 0; c < modes.size(); ++c) {
    const ContactRows& rows = p.contacts[c];
    modes[c].touch = bodies_.modes[c].touch, modes[c].direction = rows.direction;
    if (modes[c].touch == Touch::open) continue;
    if (!p.contacts[rows.under.value_or(c)].may_touch) return std::nullopt;
    if (rows.rough && rows.moves != (modes[c].touch == Touch::slips)) return std::nullopt;
  }
  return consistent_in(p, modes);
}

bool SlipStart::stand_without_what_leaves() const {
  const ContactProblem p = bodies_.with_touching();
  const std::vector<ContactSolution> list = consistent_modes(p);
  const auto free = of_modes(p, ContactModes(p.contacts.size()));
  const auto pressed = [](const ContactMode& m) { return m.shares[0].given != 0 || m.shares[1].given != 0; };
  if (list.size() != 1 || !free || std::any_of(bodies_.modes.begin(), bodies_.modes.end(), pressed)) return false;
  for (std::size_t c = 0; c < p.contacts.size(); ++c) {
    const ContactRows& rows = p.contacts[c];
    if (bodies_.modes[c].touch == Touch::open) continue;
    if (!bodies_.excluded[c].touch) {
      if (list[0].modes[c].touch != bodies_.modes[c].touch) return false;
    } else if (std::abs(dot(rows.normal, list[0].x) + rows.normal_rate) >
               kSame * (largest(rows.normal) * largest(free->x) + std::abs(rows.normal_rate))) {
      return false;
    }
  }
  return true;
}

std::vector<ContactSolution> SlipStart::modes(const ContactProblem& p) const {
  if (!shared_anew_) return consistent_modes(p);
  if (auto now = in_present_modes(p); now && now->spare.value_or(0) > kSpared) return {std::move(*now)};
  std::vector<ContactSolution> list = consistent_modes(p);
  if (auto now = goes_on(list)) list = {std::move(*now)};
  return list;
}

bool SlipStart::finds_reserve() {
  const std::vector<TouchingBodies::Excluded> excluded = bodies_.excluded, earlier = bodies_.earlier;
  for (std::size_t c = 0; c < bodies_.contacts.size(); ++c)
    if (bodies_.modes[c].touch != Touch::open) bodies_.excluded[c].touch = bodies_.earlier[c].touch = false;
  ContactProblem p = bodies_.with_touching();
  for (ContactRows& rows : p.contacts) rows.may_stick = true;
  auto now = in_present_modes(p);
  if (!now || !(now->spare.value_or(0) > kSpared)) now = goes_on(consistent_modes(p));
  bool holds = now && now->spare.value_or(0) > kSpared;
  // A contact that leaves has to be pressed again.
  for (std::size_t c = 0; holds && c < bodies_.contacts.size(); ++c)
    holds =
        !excluded[c].touch || bodies_.modes[c].touch == Touch::open || now->normal[c] > kSame * size_of_forces(p, *now);
  if (!holds) {
    bodies_.excluded = excluded, bodies_.earlier = earlier;
    return false;
  }
  for (std::size_t c = 0; c < bodies_.contacts.size(); ++c) {
    if (excluded[c].touch && bodies_.modes[c].touch != Touch::open)
      joined_.take_back(bodies_.contacts[c].name + "." + word(bodies_.contacts[c], ModeChange::leaves));
    if (!excluded[c].stick || bodies_.modes[c].touch != Touch::sticks) continue;
    joined_.take_back(bodies_.contacts[c].name + "." + word(bodies_.contacts[c], ModeChange::slips));
    bodies_.may_stick_again(c);
    told_[c] = false;
  }
  return true;
}

bool SlipStart::closed_contact_may_hold() {
  bool limited = false, closed = false;
  for (std::size_t c = 0; c < bodies_.contacts.size(); ++c) {
    limited = limited || (bodies_.excluded[c].stick && bodies_.modes[c].touch == Touch::sticks);
    closed = closed || (bodies_.modes[c].touch == Touch::open && bodies_.near.closed(c));
  }
  if (!limited || !closed) return false;
  bodies_.look();
  return shared_anew_ = finds_reserve();
}

bool SlipStart::share_anew(Outcome& outcome) {
  constexpr long double kTrial = 1e-6L, kLonger = 4;
  std::vector<std::size_t> limited;
  bool leaves = false;
  for (std::size_t c = 0; c < bodies_.contacts.size(); ++c) {
    if (bodies_.excluded[c].stick && bodies_.modes[c].touch == Touch::sticks) limited.push_back(c);
    leaves = leaves || (bodies_.excluded[c].touch && bodies_.modes[c].touch != Touch::open);
  }
  // The time is longer than before if the contacts have been held just now, and still stick.
  const bool just_now = bodies_.at.t.get_d() - held_until_ <= static_cast<double>(together_);
  const long double last = just_now ? together_ : 0;
  together_ = 0;
  if (limited.empty() && !leaves) return true;
  bodies_.look();
  if (limited.empty() && stand_without_what_leaves()) return true;
  if (finds_reserve()) {
    shared_anew_ = true;
    return true;
  }
  if (limited.empty()) return true;
  ContactProblem p = bodies_.with_touching();
  for (ContactRows& rows : p.contacts) rows.may_stick = true;
  std::vector<ContactSolution> list = consistent_modes(p);
  const auto now = goes_on(list);
  const bool sticks = now.has_value();
  if (sticks) list = {*now};
  const auto at_limit = [&](std::size_t c) {
    constexpr long double kAtLimit = 1 - 1e-6L;
    return bodies_.modes[c].touch == Touch::sticks && std::hypot(list[0].friction[c][0], list[0].friction[c][1]) >=
                                                          kAtLimit * p.contacts[c].static_friction * list[0].normal[c];
  };
  const ContactRows& rows = p.contacts[limited[0]];
  if (rows.friction != rows.static_friction) {
    // All contacts at their limit slip with an acceleration.
    for (std::size_t c = 0; sticks && c < bodies_.contacts.size(); ++c)
      if (at_limit(c)) bodies_.excluded[c].stick = true;
    return true;
  }
  for (std::size_t c = 0; c < bodies_.contacts.size(); ++c)
    bodies_.modes[c].at_bound = list.size() == 1 && list[0].normal[c] > 0 && p.contacts[c].static_friction > 0 &&
                                (list[0].modes[c].touch == Touch::slips || at_limit(c));
  together_ = last > 0 ? kLonger * last : kTrial / std::max(bodies_.dynamics.speed(), 1.0L);
  for (const std::size_t c : limited) bodies_.may_stick_again(c);
  return hold_together(together_, outcome) && hold_to_grow(outcome);
}

bool SlipStart::hold_together(long double time, Outcome& outcome) {
  const Rational to = std::min(end_, later(time));
  const std::vector<bool> told = told_;
  for (ContactMode& m : bodies_.modes) m.held = m.touch == Touch::sticks;
  bodies_.stop(bodies_.modes);
  const bool goes_on = segment_(to, outcome);
  held_until_ = bodies_.at.t.get_d();
  for (ContactMode& m : bodies_.modes) m.held = m.begins = m.at_bound = false;
  told_ = told;
  return goes_on && outcome.ok();
}

bool SlipStart::hold_to_grow(Outcome& outcome) {
  bodies_.look();
  ContactProblem p = bodies_.with_touching();
  guess_directions(p);
  const std::vector<ContactSolution> list = consistent_modes(p);
  if (list.size() != 1) return true;
  long double h = 0;
  std::vector<std::size_t> slipping;
  for (std::size_t c = 0; c < bodies_.contacts.size(); ++c) {
    if (!was_held(c) || bodies_.contacts[c].slip.size() != 2 || list[0].modes[c].touch != Touch::slips) continue;
    slipping.push_back(c);
    bodies_.modes[c].begins = true;
    const long double rate = bodies_.dynamics.slip_acceleration(c, list[0].x) / together_;
    held_[c] = {together_, rate};
    h = std::max(h, time_to_grow(c, rate));
  }
  if (!(h > 2 * together_)) {
    for (const std::size_t c : slipping) bodies_.modes[c].begins = false;
    return true;
  }
  if (!hold_together(h - together_, outcome)) return false;
  together_ = h;
  for (const std::size_t c : slipping) held_[c].time = h;
  return true;
}

long double SlipStart::time_to_grow(std::size_t c, long double rate) const {
  constexpr long double kHeld = 1e-7L, kMost = 3e-2L, kBegins = 1e-7L;
  const ContactDynamics::Place& at = bodies_.dynamics.place(c);
  // The terms are of unknown size if the contact never moved, or if only the start of its slip is known.
  const long double scale = at.slip_scale > kBegins * at.slip_reach ? at.slip_scale : 1;
  return std::min(std::sqrt(2 * kHeld * scale / rate), kMost / std::max(bodies_.dynamics.speed(), 1.0L));
}

bool SlipStart::holds_again(std::size_t c) {
  bodies_.dynamics.go(bodies_.at);
  ContactProblem p = bodies_.with_touching();
  p.contacts[c].may_stick = true;
  const std::vector<ContactSolution> list = consistent_modes(p);
  if (list.size() != 1 || list[0].modes[c].touch != Touch::sticks) return false;
  const auto& T = list[0].friction[c];
  return std::hypot(T[0], T[1]) < p.contacts[c].static_friction * list[0].normal[c];
}

bool SlipStart::begins_at_rest(std::size_t c) const {
  const ContactRows& rows = bodies_.dynamics.accelerations().contacts[c];
  return bodies_.excluded[c].stick && bodies_.modes[c].touch == Touch::sticks && bodies_.contacts[c].slip.size() == 2 &&
         rows.friction == rows.static_friction;
}

Rational SlipStart::later(long double time) const { return Rational(bodies_.at.t.get_d() + static_cast<double>(time)); }

SlipStart::Hold SlipStart::hold_for(std::size_t c, long double time, Outcome& outcome) {
  const Rational to = std::min(end_, later(time));
  bodies_.modes[c].held = bodies_.modes[c].begins = true;
  bodies_.stop(bodies_.modes);
  const bool goes_on = segment_(to, outcome);
  bodies_.modes[c].held = bodies_.modes[c].begins = false;
  bodies_.excluded[c].stick = true;
  if (!goes_on || !outcome.ok()) return Hold::motion_ends;
  return bodies_.at.t >= to ? Hold::to_its_end : Hold::something_else_happens;
}

}  // namespace anholon
