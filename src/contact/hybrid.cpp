#include "contact/hybrid.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>

#include "contact/contact_faults.h"
#include "contact/kept_gaps.h"
#include "contact/law/accumulation.h"
#include "contact/law/consistent_modes.h"
#include "contact/law/impact.h"
#include "contact/law/impact_states.h"
#include "contact/mode_segments.h"
#include "contact/refused_options.h"
#include "contact/slip_start.h"
#include "contact/surface/contact_exponents.h"
#include "contact/switched_motion.h"
#include "contact/unpressed.h"
#include "integrate/step_control.h"
#include "modelfile/check/coefficients.h"
#include "numeric/told_time.h"
#include "observe/floors/supports.h"

namespace anholon {

namespace {

class HybridMotion {
 public:
  HybridMotion(Workspace& s, const std::vector<Contact>& contacts, const SimulationOptions& o, RowSink& sink)
      : s_(s), contacts_(with_borders(s, contacts)), bodies_(s, contacts_, start_of(s, o)),
        faults_(s, contacts_, bodies_), joined_(*s.model, contacts), accumulation_(contacts.size()),
        impact_states_(s, contacts_), o_(o) {
    end_ = o.to && (o.at.empty() || *o.to > o.at.back()) ? *o.to : o.at.back();
    std::vector<Rational> times = times_of_rows(o, bodies_.at.t, end_);
    choose_order();
    segments_.emplace(s, o_, bodies_, joined_, sink, std::move(times), end_,
                      [this](std::size_t contact) { slips_->told(contact); });
    slips_.emplace(bodies_, joined_, end_,
                   [this](const Rational& to, Outcome& outcome) { return segments_->follow(to, outcome); });
  }

  SimulationReport go() {
    // If a parameter is varied, a coefficient may have any value.
    if (const std::vector<Diagnostic> wrong = wrong_coefficients(bodies_.contacts, *s_.model); !wrong.empty())
      return joined_.report({OutcomeKind::inconsistent, wrong[0].message, wrong[0].hint, wrong[0].span},
                            bodies_.at.t.get_d(), 0);
    if (Outcome o = all_pass_zero(*s_.model, bodies_.contacts); !o.ok())
      return joined_.report(std::move(o), bodies_.at.t.get_d(), 0);
    Outcome outcome = faults_.inside_at_start();
    if (outcome.ok()) bodies_.look(), outcome = kept_by_constraints(s_, bodies_);
    constexpr std::size_t kMostSegments = 100'000;
    // A motion that ends where it begins has its modes and one row, too.
    for (std::size_t k = 0; outcome.ok() && (bodies_.at.t < end_ || k == 0); ++k) {
      if (k == kMostSegments)
        outcome = told({OutcomeKind::interrupted, "more than 100000 changes of the contacts" + at_time(now()),
                        "end the motion earlier"},
                       now());
      else
        faults_.name_angles(outcome = choose());
      if (outcome.ok() && slips_->waits()) {
        if (!slips_->wait(outcome)) break;
        continue;
      }
      if (outcome.ok() && !segments_->follow(end_, outcome)) {
        faults_.explain(outcome);
        break;
      }
      take_back_touches();
      if (outcome.ok() && !slips_->hold(outcome)) break;
      if (outcome.ok()) outcome = faults_.inside();
    }
    if (outcome.ok()) outcome = faults_.inside();
    bodies_.look();
    if (outcome.ok()) outcome = faults_.not_as_its_mode();
    if (outcome.ok()) name_last_slips();
    if (!outcome.ok())
      if (Outcome flat = faults_.lies_flat(true); !flat.ok()) outcome = flat;
    if (bodies_.at.t < end_) segments_->end_early();
    return joined_.report(std::move(outcome), bodies_.at.t.get_d(), segments_->rows());
  }

 private:
  // A slip velocity with two components ends at this part of its earlier size.
  static constexpr long double kRest = 1e-12L;
  // The most impacts at one instant; further ones follow after a segment.
  static constexpr std::size_t kMostImpacts = 16;
  static ContactState start_of(const Workspace& s, const SimulationOptions& o) {
    return {o.state.t ? *o.state.t : Rational(s.state.t), s.state.q, s.state.qd, s.state.states};
  }
  std::string event_name(std::size_t c, ModeChange change) const {
    return bodies_.contacts[c].name + "." + word(bodies_.contacts[c], change);
  }
  double now() const { return bodies_.at.t.get_d(); }

  // Names the slips that passed zero where an event has ended the motion: whether they go on follows from the next
  // modes.
  void name_last_slips() {
    if (!bodies_.dynamics.has_values() || !faults_.not_regular().ok() || bodies_.shrinks()) return;
    if (std::none_of(bodies_.excluded.begin(), bodies_.excluded.end(), [](const auto& e) { return e.slips; })) return;
    const std::vector<ContactSolution> list = consistent_modes(bodies_.with_touching());
    if (list.size() != 1) return;
    bodies_.modes = list[0].modes;
    note_rests(bodies_, bodies_.with_touching(), list[0]);
    name_reversals(bodies_.modes);
  }

  // A slip that passes zero and goes on has reversed.
  void name_reversals(const ContactModes& modes) {
    for (std::size_t c = 0; c < bodies_.contacts.size(); ++c)
      if (bodies_.excluded[c].slips && modes[c].touch == Touch::slips && !modes[c].rests)
        joined_.rename(event_name(c, ModeChange::sticks), event_name(c, ModeChange::reverses));
  }

  // Friction that touches its bound and falls again is not a slip.
  void take_back_touches() {
    for (std::size_t c = 0; c < bodies_.contacts.size() && !shares_friction(bodies_.modes); ++c) {
      if (!bodies_.excluded[c].stick || bodies_.modes[c].touch != Touch::sticks) continue;
      if (!only_touches_bound(bodies_, c,
                              [this](const Rational& to, ContactState& at) { return segments_->last_until(to, at); }))
        continue;
      joined_.take_back(event_name(c, ModeChange::slips));
      bodies_.may_stick_again(c);
    }
  }

  // Computes impacts where a closed gap shrinks, then chooses the modes by the accelerations.
  Outcome choose() {
    bodies_.look();
    if (Outcome o = faults_.not_as_its_mode(); !o.ok()) return o;
    if (!bodies_.dynamics.has_values()) return what_has_no_value();
    const ContactModes before = bodies_.modes;
    bool over_border = false, struck = false;
    if (Outcome o = strike(over_border, struck); !o.ok()) return o;
    land();
    if (struck)
      if (const auto c = bodies_.on_edge()) return on_edge(bodies_.contacts[*c], now());
    bodies_.stop_ended_slips();
    ContactProblem p;
    std::vector<ContactSolution> list = modes_now(p);
    if (list.size() != 1) return faults_.undecided(list.size());
    if (!struck && !over_border) leave_open(bodies_, s_, p, list);
    slips_->tell_who_slips_too(list[0].modes);
    bodies_.modes = list[0].modes;
    if (over_border)
      tell_changes(before);
    else
      tell_openings(before, struck ? 0 : slips_->held_for());
    if (Outcome o = faults_.lies_flat(false); !o.ok()) return o;
    note_rests(bodies_, p, list[0]);
    name_reversals(bodies_.modes);
    const auto open = of_modes(p, ContactModes(bodies_.contacts.size()));
    if (open) {
      bodies_.before = 0;
      for (const long double a : open->x) bodies_.before = std::max(bodies_.before, std::abs(a));
    }
    bodies_.come_to_rest();
    put_round_off(p, list[0], open);
    std::vector<std::size_t> beginning;
    for (std::size_t c = 0; c < bodies_.contacts.size(); ++c) {
      if (bodies_.contacts[c].slip.size() < 2 || bodies_.modes[c].touch != Touch::slips) continue;
      if (p.contacts[c].moves)
        bodies_.modes[c].fast = slips_->has_just_begun(c) ? std::nullopt : bodies_.fast(c);
      else if (bodies_.contacts[c].rough())
        beginning.push_back(c);
    }
    slips_->begin(beginning, list[0].x);
    // The velocities at the end of a segment have the round-off of earlier velocities, which may be much larger.
    bodies_.dynamics.go(bodies_.at);
    bodies_.stop(bodies_.modes);
    bodies_.drop_left_over();
    bodies_.bound_rest();
    note_still(bodies_, s_, p);
    // The check is made again, because coordinates that are round-off were set to zero.
    return faults_.not_regular();
  }

  // Returns the consistent modes, and their equations. If what earlier events exclude leaves none, it is allowed again.
  std::vector<ContactSolution> modes_now(ContactProblem& p) {
    const auto find = [&] {
      p = bodies_.with_touching();
      slips_->guess_directions(p);
      return slips_->modes(p);
    };
    std::vector<ContactSolution> list = find();
    const bool any = std::any_of(bodies_.earlier.begin(), bodies_.earlier.end(),
                                 [](const TouchingBodies::Excluded& e) { return e.touch || e.stick; });
    if (list.size() == 1 || !any) return list;
    bodies_.earlier.assign(bodies_.contacts.size(), {});
    return find();
  }

  // Computes impacts where a closed gap shrinks: at a border of a surface, first those on the side from which the
  // bodies come, then those on the other side, if the velocities lead there.
  Outcome strike(bool& over_border, bool& struck) {
    for (std::size_t k = 0; k < kMostImpacts; ++k) {
      if (Outcome o = faults_.not_regular(); !o.ok()) return o;
      if (k == 0 && (bodies_.shrinks() || bodies_.modes.empty()))
        if (const auto c = bodies_.on_edge()) return meets_edge(bodies_.contacts[*c], now());
      if (bodies_.shrinks()) {
        struck = true;
        if (Outcome o = impact(); !o.ok()) return o;
      } else if (bodies_.pass_borders()) {
        over_border = true;
        if (Outcome o = faults_.inside_behind_jump(); !o.ok()) return o;
      } else {
        return {};
      }
    }
    for (std::size_t c = 0; over_border && c < bodies_.contacts.size(); ++c)
      if (bodies_.near.closed(c) && bodies_.near.gap_rate(c) < 0) return on_edge(bodies_.contacts[c], now());
    return {};
  }

  // Reports the changes of modes at a border of a surface.
  void tell_changes(const ContactModes& before) {
    for (std::size_t c = 0; c < before.size(); ++c) {
      const ContactMode& now = bodies_.modes[c];
      const bool touched = before[c].touch != Touch::open && now.touch != Touch::open;
      std::optional<ModeChange> change;
      if (now.touch == Touch::open && before[c].touch != Touch::open && !bodies_.contacts[c].under)
        change = ModeChange::leaves;
      else if (touched && bodies_.contacts[c].rough() && now.touch != before[c].touch)
        change = now.touch == Touch::sticks ? ModeChange::sticks : ModeChange::slips;
      else if (touched && now.touch == Touch::slips && now.direction[0] * before[c].direction[0] < 0 &&
               bodies_.contacts[c].slip.size() == 1)
        change = ModeChange::reverses;
      if (change == ModeChange::leaves)
        tell_leaves(c, bodies_.at.t.get_d());
      else if (change)
        joined_.event_once(event_name(c, *change), bodies_.at.t.get_d());
    }
  }
  // Reports the closed contacts that impacts of others have opened, or forces that jump as a slip begins.
  // `held`: for how long the contacts have been held before.
  void tell_openings(const ContactModes& before, double held) {
    for (std::size_t c = 0; c < before.size(); ++c) {
      const bool told = bodies_.excluded[c].touch || bodies_.earlier[c].touch || bodies_.contacts[c].under;
      if (before[c].touch != Touch::open && bodies_.modes[c].touch == Touch::open && !told)
        tell_leaves(c, now() - held);
    }
  }
  // If the contact itself has an impact, its event tells that the bodies part.
  void tell_leaves(std::size_t c, double t) {
    if (!joined_.has(event_name(c, ModeChange::hits), t)) joined_.event_once(event_name(c, ModeChange::leaves), t);
  }

  // The motion with all contacts open names the formula that has no value.
  Outcome what_has_no_value() {
    Outcome outcome, without = told({OutcomeKind::not_a_number, "masses or forces have no value" + at_time(now()),
                                     "start or stop the motion elsewhere"},
                                    now());
    bodies_.modes.assign(bodies_.contacts.size(), {});
    segments_->follow(end_, outcome);
    return outcome.ok() ? without : outcome;
  }

  // Writes into the modes what counts as round-off. `now`, `open`: the accelerations of the modes, and without
  // contacts.
  void put_round_off(const ContactProblem& p, const ContactSolution& now, const std::optional<ContactSolution>& open) {
    long double force = 0;
    for (const long double b : p.b) force = std::max(force, std::abs(b));
    for (std::size_t c = 0; c < bodies_.contacts.size(); ++c) {
      ContactMode& m = bodies_.modes[c];
      const ContactDynamics::Place& place = bodies_.dynamics.place(c);
      // An open contact needs no slip velocity.
      if (bodies_.dynamics.has_slip(c)) {
        m.rest = std::max(kRest * place.slip_scale, slip_in_last_digits_of_time(c, now.x));
        if (open) m.rest = std::max(m.rest, slip_in_last_digits_of_time(c, open->x));
      }
      m.depth = bodies_.near.depth(c) + std::max(0.0L, -place.gap);
      m.closed = m.touch == Touch::open && bodies_.near.closed(c) && bodies_.near.gap_is_round_off(c);
      m.slack = kRest * (force > 0 ? force : 1);
      if (bodies_.contacts[c].under) m.slack *= p.contacts[c].friction;
      // Friction found to be at its bound may be beyond it by half of the slack, so the mode ends only if friction
      // grows on.
      const long double beyond =
          std::hypot(now.friction[c][0], now.friction[c][1]) - p.contacts[c].static_friction * now.normal[c];
      if (m.touch == Touch::sticks) m.slack = std::max(m.slack, 2 * beyond);
      // A load may be negative by round-off in the same way.
      if (m.touch != Touch::open && !bodies_.contacts[c].under) m.slack = std::max(m.slack, -2 * now.normal[c]);
    }
  }

  // The change of a slip velocity in the last digits of the times of the motion, with these accelerations. At the time
  // at which the velocity vanishes, a smaller velocity cannot be resolved.
  long double slip_in_last_digits_of_time(std::size_t c, const std::vector<long double>& accelerations) const {
    constexpr long double kDigits = 16 * std::numeric_limits<double>::epsilon();
    return std::max(least_time(order_), kDigits * std::abs(static_cast<long double>(end_.get_d()))) *
           bodies_.dynamics.slip_acceleration(c, accelerations);
  }

  // The least time before a slip with two components vanishes. At a shorter time, Taylor coefficients of its direction
  // overflow in doubles: the coefficients, up to an order a few above that of the polynomials, are powers of the
  // inverse of this time; kOfOrder is the time for order 19.
  static long double least_time(int order) {
    constexpr long double kOfOrder = 5e-14L;
    constexpr int kOrder = 19, kMore = 4;
    return std::pow(kOfOrder, static_cast<long double>(kOrder + kMore) / (std::min(order, kOrder) + kMore));
  }

  // In a motion that is short in the unit of time, polynomials of lower order let slips with two components come nearer
  // to zero.
  void choose_order() {
    constexpr long double kPart = 5e-11L;  // of the time of the motion
    constexpr int kLowest = 8;
    order_ = o_.order > 0 ? o_.order : taylor_order(std::log(o_.tolerance.get_d()));
    if (o_.order > 0) return;
    const long double least = kPart * Rational(end_ - bodies_.at.t).get_d();
    const bool any = std::any_of(bodies_.contacts.begin(), bodies_.contacts.end(),
                                 [](const Contact& c) { return c.slip.size() == 2 && c.rough(); });
    while (any && least > 0 && order_ > kLowest && least_time(order_) > least) o_.order = --order_;
  }

  Outcome impact() {
    const std::size_t n = bodies_.at.q.size();
    std::vector<bool> touches;
    std::size_t striking = 0;
    for (std::size_t c = bodies_.contacts.size(); c-- > 0;)
      if (bodies_.near.closed(c) && bodies_.near.gap_rate(c) < 0 && !bodies_.contacts[c].under) striking = c;
    for (std::size_t c = 0; c < bodies_.contacts.size(); ++c)
      touches.push_back(bodies_.near.closed(c) && bodies_.near.gap_rate(c) <= 0);
    if (const std::string& nonlinear = bodies_.dynamics.nonlinear_constraint(); !nonlinear.empty())
      return told({OutcomeKind::inconsistent,
                   "the contact '" + bodies_.contacts[striking].name + "' strikes" + at_time(now()) +
                       ", and the constraint '" + nonlinear +
                       "' is not linear in the velocities: no law tells its impulse",
                   "end the motion before the impact, or write the constraint so that it is linear in the velocities"},
                  now());
    std::vector<Impact> list = impacts(bodies_.dynamics, bodies_.contacts, touches);
    if (list.size() != 1) {
      bodies_.first_alone(touches);
      list = impacts(bodies_.dynamics, bodies_.contacts, touches);
    }
    if (list.size() != 1) return faults_.undecided(list.size());
    std::vector<long double> after(bodies_.at.qd.begin(), bodies_.at.qd.end());
    for (std::size_t a = 0; a < n; ++a) after[a] += list[0].jump[a];
    constexpr long double kGrows = 1e-12L;
    if (list[0].work > kGrows * list[0].terms)
      return told({OutcomeKind::inconsistent, "the impact would raise the energy" + at_time(now()),
                   bodies_.contacts[0].law == ImpactLaw::newton
                       ? "Newton's law with friction does so in this direction: impact = \"poisson\" in the contacts"
                       : "take a smaller restitution"},
                  now());
    std::vector<EventReport::Change> changes;
    const std::vector<double> states = bodies_.at.states;
    impact_states_.add(bodies_.at, after, list[0].impulses);
    for (std::size_t a = 0; a < n; ++a) {
      const auto v = static_cast<double>(after[a]);
      if (v != bodies_.at.qd[a])
        changes.push_back({s_.model->coordinates[a].name + "'", {bodies_.at.qd[a], ""}, {v, ""}});
      bodies_.at.qd[a] = v;
    }
    for (std::size_t z = 0; z < states.size(); ++z)
      if (states[z] != bodies_.at.states[z])
        changes.push_back({s_.model->states[z].name, {states[z], ""}, {bodies_.at.states[z], ""}});
    joined_.set(bodies_.at.t.get_d(), changes, event_name(striking, ModeChange::hits));
    for (std::size_t c = 0; c < bodies_.contacts.size(); ++c) {
      if (touches[c] && bodies_.near.gap_rate(c) != 0 && !bodies_.contacts[c].under)
        accumulation_.impact(c, bodies_.at.t.get_d());
      bodies_.excluded[c] = {};
    }
    bodies_.dynamics.go(bodies_.at);
    land();
    return {};
  }

  // Brings gaps to rest. A gap comes to rest if the time is near the limit of its impacts, or if it is pressed together
  // and would rise, with its velocity after the impact, by no more than the round-off of its place. Such gaps come to
  // rest together, because the impacts of each set the others in motion; slips that friction ends within the round-off
  // of the place end with them.
  void land() {
    const double t = bodies_.at.t.get_d();
    ContactModes stops(bodies_.contacts.size());
    bool any = false;
    for (std::size_t c = 0; c < bodies_.contacts.size(); ++c) {
      if (!bodies_.near.closed(c) || bodies_.contacts[c].under) continue;
      const std::optional<double> limit = accumulation_.limit(c);
      const bool rests =
          bodies_.near.gap_rate(c) != 0 && (accumulation_.near_limit(c, t) || bodies_.near.hardly_rises(c));
      // What does not slip holds as the others stop: the loss of its neighbour's velocity would make it slip.
      if (rests || bodies_.near.gap_rate(c) == 0)
        stops[c].touch = bodies_.near.hardly_slips(c) ? Touch::sticks : Touch::slips;
      if (!rests) continue;
      any = true;
      if (limit && bodies_.fast(c)) stops[c].direction = bodies_.dynamics.accelerations().contacts[c].direction;
      joined_.event(bodies_.contacts[c].name + ".rests", limit ? std::max(*limit, t) : t);
      accumulation_.forget(c);
    }
    if (!any) return;
    stop_at_rest(stops);
    for (std::size_t c = 0; c < bodies_.contacts.size(); ++c)
      if (stops[c].touch == Touch::slips && bodies_.near.hardly_slips(c)) stops[c].touch = Touch::sticks;
    stop_at_rest(stops);
  }

  // Stops the last velocities of what comes to rest; states whose rates hold forces get the impulses of this jump.
  void stop_at_rest(const ContactModes& stops) {
    ContactState before = bodies_.at;
    const Impulses impulses = bodies_.stop(stops);
    impact_states_.add(before, {bodies_.at.qd.begin(), bodies_.at.qd.end()}, impulses);
    bodies_.at.states = before.states;
  }

  Workspace& s_;
  const std::vector<Contact> contacts_;
  TouchingBodies bodies_;
  ContactFaults faults_;
  JoinedReport joined_;
  Rational end_;
  Accumulation accumulation_;
  ImpactStates impact_states_;
  SimulationOptions o_;
  int order_ = 0;  // of the Taylor polynomials
  std::optional<ModeSegments> segments_;
  std::optional<SlipStart> slips_;
};

}  // namespace

SimulationReport simulate_with_contacts(Workspace& s, const std::vector<Contact>& contacts,
                                        const SimulationOptions& options, RowSink& sink) {
  refuse_options(options, s, contacts);
  const auto start = std::chrono::steady_clock::now();
  const std::vector<Contact> own = with_whole_exponents(s, contacts);
  SimulationReport r =
      are_switches(own) ? simulate_with_switches(s, own, options, sink) : HybridMotion(s, own, options, sink).go();
  for (const std::string& note : r.notes)
    if (options.note && is_of_support(note)) options.note(note);
  for (const std::string& note : notes_of_redundancy(s)) {
    if (options.note) options.note(note);
    if (std::find(r.notes.begin(), r.notes.end(), note) == r.notes.end()) r.notes.push_back(note);
  }
  r.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return r;
}

}  // namespace anholon
