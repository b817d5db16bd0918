#include "contact/touching_bodies.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "contact/law/rows.h"
#include "contact/law/shared_forces.h"
#include "numeric/number.h"

namespace anholon {

// The jump that stops a velocity leaves a remainder of this part of the largest velocity.
static constexpr long double kLeftOver = 1e-16L;

TouchingBodies::TouchingBodies(Workspace& s, const std::vector<Contact>& of, ContactState start)
    : contacts(of), dynamics(s, of), at(std::move(start)), borders(s, of), near(of, dynamics, at), excluded(of.size()),
      earlier(of.size()), turned(of.size(), false) {
  borders.begin(at);
}

void TouchingBodies::look() {
  dynamics.go(at);
  if (dynamics.note_fall(at)) dynamics.go(at);
}

ContactProblem TouchingBodies::with_touching() const {
  ContactProblem p = dynamics.accelerations();
  for (std::size_t c = 0; c < contacts.size(); ++c) {
    ContactRows& rows = p.contacts[c];
    const bool leaves = excluded[c].touch || earlier[c].touch;
    rows.may_touch = near.closed(c) && near.gap_rate(c) == 0 && !leaves;
    rows.may_stick = !excluded[c].stick && !earlier[c].stick;
    if (leaves) rows.before = before * near.late();
    rows.moves = rows.moves && !slip_has_ended(c);
    // A gap that is open, or opens, is not bounded by its acceleration.
    if (!near.closed(c) || near.gap_rate(c) > 0) rows.normal.assign(at.q.size(), 0), rows.normal_rate = 0;
  }
  return p;
}

bool TouchingBodies::slip_has_ended(std::size_t c) const {
  constexpr long double kLeft = 1e-11L;
  const bool one_ended = std::any_of(excluded.begin(), excluded.end(), [](const Excluded& e) { return e.slips; });
  const ContactDynamics::Place& place = dynamics.place(c);
  return excluded[c].slips || (one_ended && std::hypot(place.slip[0], place.slip[1]) <= kLeft * place.slip_scale);
}

void TouchingBodies::stop_ended_slips() {
  ContactModes to(contacts.size());
  bool any = false;
  for (std::size_t c = 0; c < contacts.size(); ++c) {
    const std::size_t of = contacts[c].under.value_or(c);
    if (!near.closed(of) || near.gap_rate(of) != 0) continue;
    const bool ended = contacts[c].slip.size() == 2 && contacts[c].rough() && slip_has_ended(c);
    const bool stuck = c < modes.size() && modes[c].touch == Touch::sticks;
    to[c].touch = ended || stuck ? Touch::sticks : Touch::slips;
    any = any || ended;
  }
  if (any) stop(to);
}

void TouchingBodies::come_to_rest() {
  constexpr long double kZero = 1e-13L, kNoPlace = 1e-16L;
  most_place.resize(at.q.size(), 0);
  for (std::size_t a = 0; a < at.qd.size(); ++a) {
    if (std::abs(at.qd[a]) <= kZero * dynamics.most(a)) at.qd[a] = 0;
    most_place[a] = std::max<long double>(most_place[a], std::abs(at.q[a]));
    if (std::abs(at.q[a]) <= kNoPlace * most_place[a]) at.q[a] = 0;
  }
}

void TouchingBodies::drop_left_over() {
  const std::vector<double> found = at.qd;
  const long double slipped = slip_of_what_sticks();
  std::vector<bool> left_over;
  for (std::size_t a = 0; a < at.qd.size(); ++a)
    left_over.push_back(std::abs(at.qd[a]) <= kLeftOver * dynamics.most(a));
  keep_what_constraints_need(left_over);
  for (std::size_t a = 0; a < at.qd.size(); ++a)
    if (left_over[a]) at.qd[a] = 0;
  for (const std::vector<long double>& row : dynamics.accelerations().Phi) {
    long double now = 0, most = 0;
    for (std::size_t a = 0; a < row.size(); ++a)
      if (row[a] != 0) now = std::max<long double>(now, std::abs(at.qd[a])), most = std::max(most, dynamics.most(a));
    for (std::size_t a = 0; a < row.size(); ++a)
      if (row[a] != 0 && now <= RoundOff::kPlace * most) at.qd[a] = 0;
  }
  constexpr long double kContradicts = 1e-6L;
  dynamics.go(at);
  if (slip_of_what_sticks() > std::max(slipped, kContradicts)) {
    at.qd = found;
    dynamics.go(at);
  }
  // A constraint that holds the time may ask for velocities that are as small as round-off, where it turns the motion back.
  if (dynamics.velocities_hold()) return;
  if (const auto nearest = dynamics.nearest(at.qd, at)) at.qd = *nearest;
  dynamics.go(at);
}

void TouchingBodies::keep_what_constraints_need(std::vector<bool>& left_over) const {
  constexpr long double kOfTerms = 1e-17L;
  const std::vector<std::vector<long double>>& rows = dynamics.accelerations().Phi;
  for (bool again = true; std::exchange(again, false);)
    for (const std::vector<long double>& row : rows) {
      long double kept = 0;
      for (std::size_t a = 0; a < row.size(); ++a)
        if (!left_over[a]) kept += std::abs(row[a] * at.qd[a]);
      for (std::size_t a = 0; a < row.size(); ++a)
        if (left_over[a] && kept > 0 && std::abs(row[a] * at.qd[a]) > kOfTerms * kept)
          left_over[a] = false, again = true;
    }
}

long double TouchingBodies::slip_of_what_sticks() const {
  long double most = 0;
  for (std::size_t c = 0; c < modes.size(); ++c) {
    if (modes[c].touch != Touch::sticks) continue;
    const ContactRows& rows = dynamics.accelerations().contacts[c];
    for (std::size_t k = 0; k < rows.tangential.size(); ++k) {
      long double terms = 0;
      for (std::size_t a = 0; a < at.qd.size(); ++a) terms += std::abs(rows.tangential[k][a] * at.qd[a]);
      if (terms > 0) most = std::max(most, std::abs(dynamics.place(c).slip[k]) / terms);
    }
  }
  return most;
}

std::optional<std::string> TouchingBodies::contradiction() const {
  constexpr long double kMoves = 1e-8L;
  for (std::size_t c = 0; c < modes.size(); ++c) {
    const ContactDynamics::Place& place = dynamics.place(c);
    const long double most = kMoves * place.slip_reach, v = std::hypot(place.slip[0], place.slip[1]);
    const bool sticks = modes[c].touch == Touch::sticks && v > most;
    const bool against = modes[c].touch == Touch::slips && contacts[c].rough() && contacts[c].slip.size() == 1 &&
                         place.slip[0] * modes[c].direction[0] < -most;
    if ((sticks || against) && !near.hardly_slips(c))
      return "the contact '" + contacts[c].name +
             (sticks ? "' sticks, and slips with " : "' slips against its direction with ") +
             number_text(static_cast<double>(v), 6) +
             (contacts[c].units.slip.empty() ? "" : " " + contacts[c].units.slip);
  }
  return std::nullopt;
}

std::optional<long double> TouchingBodies::fast(std::size_t c) const {
  constexpr long double kFar = 1e-3L, kPart = 1.0L / 16;
  const ContactDynamics::Place& place = dynamics.place(c);
  const long double far = kFar * place.slip_scale, v = std::hypot(place.slip[0], place.slip[1]);
  if (v < far && !turned[c]) return std::nullopt;
  return kPart * std::min(v, far);
}

bool TouchingBodies::pass_borders() {
  std::vector<bool> closed;
  for (std::size_t c = 0; c < contacts.size(); ++c) closed.push_back(near.closed(c));
  if (!borders.pass(at)) return false;
  look();
  ContactModes held(contacts.size());
  bool any = false;
  for (std::size_t c = 0; c < contacts.size(); ++c) {
    // The border is located with the accuracy of an event.
    if (closed[c] && near.missed(c)) near.reached(c);
    if (c >= modes.size() || modes[c].touch == Touch::open || !near.closed(c) || near.gap_rate(c) != 0) continue;
    held[c].touch = Touch::slips;
    if (modes[c].touch != Touch::sticks) continue;
    if (slips_fast(c))
      modes[c].touch = Touch::slips;
    else
      held[c].touch = Touch::sticks, any = true;
  }
  if (any) stop(held);
  return true;
}

std::optional<std::size_t> TouchingBodies::on_edge() {
  std::optional<std::size_t> edge;
  const auto most = [this](std::size_t a) { return dynamics.most(a); };
  const ContactProblem here = dynamics.accelerations();
  for (const std::size_t k : borders.at_rest(at, most)) {
    ContactState beyond = at;
    beyond.borders[k] = -beyond.borders[k];
    dynamics.go(beyond);
    for (std::size_t c = 0; c < contacts.size() && !edge; ++c) {
      long double other = 0;
      for (std::size_t a = 0; a < at.q.size(); ++a)
        other = std::max(other, std::abs(dynamics.accelerations().contacts[c].normal[a] - here.contacts[c].normal[a]));
      if (near.closed(c) && other > kSame * largest(here.contacts[c].normal)) edge = c;
    }
  }
  dynamics.go(at);
  return edge;
}

bool TouchingBodies::slips_fast(std::size_t c) const {
  constexpr long double kMoves = 1e-8L;
  const ContactDynamics::Place& place = dynamics.place(c);
  return std::hypot(place.slip[0], place.slip[1]) > kMoves * place.slip_reach;
}

bool TouchingBodies::shrinks() const {
  bool any = false;
  for (std::size_t c = 0; c < contacts.size(); ++c) any = any || (near.closed(c) && near.gap_rate(c) < 0);
  return any;
}

void TouchingBodies::first_alone(std::vector<bool>& touches) const {
  std::size_t first = contacts.size();
  for (std::size_t c = 0; c < contacts.size(); ++c)
    if (touches[c] && near.gap_rate(c) < 0 &&
        (first == contacts.size() || dynamics.place(c).gap < dynamics.place(first).gap))
      first = c;
  for (std::size_t c = 0; c < contacts.size(); ++c) touches[c] = touches[c] && (c == first || near.gap_rate(c) == 0);
}

Impulses TouchingBodies::stop(const ContactModes& to) {
  ContactProblem p = dynamics.stop();
  const auto leave_out_dependent = [](const ContactProblem& of, ContactModes& stopped) {
    share_forces(of, stopped);
    for (ContactMode& m : stopped)
      for (ForceShare* share : {&m.load, &m.shares[0], &m.shares[1]}) share->of.clear();
  };
  ContactModes stopped(contacts.size());
  std::optional<ContactSolution> jump;
  if (!p.beta.empty()) jump = of_modes(p, stopped);
  for (std::size_t c = 0; c < contacts.size(); ++c) {
    if (to[c].direction != std::array<long double, 2>{})
      p.contacts[c].friction = dynamics.accelerations().contacts[c].friction;
    for (const Touch touch : {Touch::sticks, Touch::slips}) {
      if (touch > to[c].touch) continue;
      stopped[c].touch = touch;
      stopped[c].direction = to[c].direction;
      leave_out_dependent(p, stopped);
      if (auto further = of_modes(p, stopped)) {
        jump = std::move(further);
        break;
      }
      stopped[c] = {};
    }
  }
  Impulses impulses(contacts.size());
  if (jump) {
    add_to_velocities(jump->x);
    add_impulses(p, *jump, impulses);
  }
  dynamics.go(at);
  return impulses;
}

void TouchingBodies::close_gaps() {
  dynamics.go(at);
  ContactProblem p = dynamics.stop();
  std::fill(p.beta.begin(), p.beta.end(), 0);
  ContactModes closed(contacts.size());
  for (std::size_t c = 0; c < contacts.size(); ++c) {
    if (modes[c].touch == Touch::open || contacts[c].under) continue;
    closed[c].touch = Touch::slips;
    p.contacts[c].normal_rate = dynamics.place(c).gap;
  }
  share_forces(p, closed);
  for (ContactMode& m : closed) m.load.of.clear();
  const auto change = of_modes(p, closed);
  if (!change) return;
  for (std::size_t a = 0; a < at.q.size(); ++a) at.q[a] = static_cast<double>(at.q[a] + change->x[a]);
  come_to_rest();
  dynamics.go(at);
  stop(modes);
  drop_left_over();
}

void TouchingBodies::add_to_velocities(const std::vector<long double>& jump) {
  for (std::size_t a = 0; a < at.qd.size(); ++a) at.qd[a] = static_cast<double>(at.qd[a] + jump[a]);
}

void TouchingBodies::set_slip(std::size_t c, const std::array<long double, 2>& d, long double v) {
  ContactProblem p = dynamics.impact(std::vector<bool>(contacts.size(), false));
  ContactModes alone(contacts.size());
  alone[c].touch = Touch::sticks;
  p.contacts[c] = dynamics.accelerations().contacts[c];
  p.contacts[c].normal_rate = 0;
  for (std::size_t a = 0; a < 2; ++a) p.contacts[c].tangential_rate[a] = dynamics.place(c).slip[a] - v * d[a];
  const auto jump = of_modes(p, alone);
  if (!jump) return;
  add_to_velocities(jump->x);
}

void TouchingBodies::bound_rest() {
  for (std::size_t c = 0; c < contacts.size(); ++c) {
    if (modes[c].touch != Touch::slips || !contacts[c].rough() || contacts[c].slip.size() < 2) continue;
    const auto &v = dynamics.place(c).slip, &d = modes[c].direction;
    if (const long double along = v[0] * d[0] + v[1] * d[1]; along > 0)
      modes[c].rest = std::min(modes[c].rest, along / 2);
  }
}

void TouchingBodies::against_friction(ContactProblem& p, std::size_t c) const {
  ContactModes held_by = modes;
  for (std::size_t o = 0; o < held_by.size(); ++o)
    if (p.contacts[o].moves) held_by[o].direction = p.contacts[o].direction;
  held_by[c].touch = Touch::sticks;
  const auto held = of_modes(p, held_by);
  const long double size = held ? std::hypot(held->friction[c][0], held->friction[c][1]) : 0;
  if (size > 0) p.contacts[c].direction = {-held->friction[c][0] / size, -held->friction[c][1] / size};
}

bool TouchingBodies::deeper(const std::vector<double>& q) {
  ContactState begin = at;
  begin.q = q;
  dynamics.go(begin);
  bool any = false;
  for (std::size_t c = 0; c < contacts.size(); ++c) {
    const long double gap = dynamics.place(c).gap;
    if (modes[c].touch != Touch::open || gap > -modes[c].depth || !near.closed(c)) continue;
    modes[c].depth = near.depth(c) - gap;
    any = true;
  }
  dynamics.go(at);
  return any;
}

}  // namespace anholon
