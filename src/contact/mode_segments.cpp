#include "contact/mode_segments.h"

#include <algorithm>
#include <cmath>

#include "contact/slow_slips.h"
#include "motion/stiff_method.h"
#include "observe/floors/supports.h"
#include "simulation/near_singular.h"
#include "simulation/simulate.h"

namespace anholon {

ModeSegments::ModeSegments(const Workspace& s, const SimulationOptions& options, TouchingBodies& bodies,
                           JoinedReport& joined, RowSink& rows, std::vector<Rational> times, Rational end,
                           std::function<void(std::size_t)> slips)
    : o_(options), looks_for_events_(!s.model->events.empty()), has_supports_(!floors(s, translations(s)).empty()),
      bodies_(bodies), joined_(joined), ready_(s, bodies.contacts), rows_(rows, bodies.contacts),
      times_(std::move(times)), end_(std::move(end)), slips_(std::move(slips)) {
  rows_.only_at(times_);
}

// The indices of events of a mode whose gaps begin at zero.
static std::vector<std::size_t> from_zero(const ReadyMode& mode, const TouchingBodies& bodies) {
  std::vector<std::size_t> list;
  const std::vector<Event>& events = mode.own->model->events;
  for (std::size_t i = 0; i < events.size(); ++i) {
    const auto known = mode.of.events.find(events[i].name);
    if (known == mode.of.events.end() || known->second.change != ModeChange::hits) continue;
    const std::size_t c = known->second.contact;
    if (bodies.modes[c].closed &&
        events[i].name == bodies.contacts[c].name + "." + word(bodies.contacts[c], ModeChange::hits))
      list.push_back(i);
  }
  return list;
}

// Drops slips of contacts that leave at the same time: the bound of friction vanishes with the load, and so does the
// friction of a contact that leaves without a slip.
static void drop_slips_of_what_leaves(SimulationReport& r, const std::map<std::string, ModeEvent>& known,
                                      const std::vector<Contact>& contacts) {
  const auto leaves_at = [&](std::size_t contact, double t) {
    return std::any_of(r.events.begin(), r.events.end(), [&](const EventReport& e) {
      const auto at = known.find(e.name);
      return at != known.end() && at->second.change == ModeChange::leaves && at->second.contact == contact &&
             e.t.value == t;
    });
  };
  std::vector<EventReport> kept;
  for (const EventReport& e : r.events) {
    const auto at = known.find(e.name);
    const bool slips = at != known.end() && at->second.change == ModeChange::slips;
    if (slips && leaves_at(contacts[at->second.contact].under.value_or(at->second.contact), e.t.value)) continue;
    kept.push_back(e);
  }
  r.events = std::move(kept);
}

bool ModeSegments::follow(const Rational& to, Outcome& outcome) {
  const ContactState from = bodies_.at;
  if (by_bdf(to)) {
    rows_.end_segment(true);
    rows_.last_state(bodies_.at);
    bodies_.dynamics.pass(from, bodies_.at);
    bodies_.near.segment_has_ended((bodies_.at.t - from.t).get_d());
    nothing_has_changed();
    return bodies_.at.t < end_;
  }
  SimulationReport r;
  ReadyMode* mode = simulate_mode(to, r, outcome);
  // The mode closes gaps that are round-off, and the velocities have to fit the places with these gaps.
  if (outcome.kind == OutcomeKind::inconsistent && r.steps == 0) {
    bodies_.close_gaps();
    mode = simulate_mode(to, r, outcome);
  }
  if (!mode) {
    rows_.end_segment(true);
    return false;
  }
  rows_.last_state(bodies_.at);
  bodies_.dynamics.pass(from, bodies_.at);
  bodies_.near.segment_has_ended((bodies_.at.t - from.t).get_d());
  // The holding components are chosen anew.
  const bool holds_others = bodies_.at.t > from.t && may_hold_others(r);
  if (holds_others) forget_singularity(r);
  drop_slips_of_what_leaves(r, mode->of.events, bodies_.contacts);
  const bool every_event_known = joined_.add(r, mode->of.events);
  const bool vanished = (outcome.kind == OutcomeKind::step_collapse || gave_up(r)) && slip_vanishes();
  rows_.end_segment(!vanished && !direction_vanishes(r.events, mode->of.events) &&
                    !(outcome.ok() && goes_on_slipping(to)));
  if (vanished) {
    outcome = {};
    bodies_.excluded.assign(bodies_.contacts.size(), {});
    return true;
  }
  if (holds_others || (bodies_.at.t > from.t && may_be_stiff(r, to))) {
    outcome = {};
    nothing_has_changed();
    return true;
  }
  if (!outcome.ok()) return false;
  const bool changed = note(r.events, mode->of.events, Rational(bodies_.at.t - from.t).get_d());
  return (changed || to < end_) && every_event_known && bodies_.at.t < end_;
}

bool ModeSegments::direction_vanishes(const std::vector<EventReport>& events,
                                      const std::map<std::string, ModeEvent>& known) const {
  return std::any_of(events.begin(), events.end(), [&](const EventReport& e) {
    const auto at = known.find(e.name);
    return at != known.end() && at->second.change == ModeChange::sticks &&
           bodies_.contacts[at->second.contact].slip.size() > 1;
  });
}

bool ModeSegments::goes_on_slipping(const Rational& to) const {
  return bodies_.at.t == to && to < end_ &&
         std::any_of(
             bodies_.modes.begin(), bodies_.modes.end(),
             [](const ContactMode& m) { return m.touch == Touch::slips && m.begins; });
}

bool ModeSegments::note(const std::vector<EventReport>& events, const std::map<std::string, ModeEvent>& known,
                        double length) {
  // Forces that are round-off at the start of the segment have grown beyond their slack within this time.
  constexpr long double kRoundOff = 1e-6L;
  std::vector<TouchingBodies::Excluded> before = bodies_.earlier;
  for (std::size_t c = 0; c < before.size(); ++c) {
    before[c].touch = before[c].touch || bodies_.excluded[c].touch;
    before[c].stick = before[c].stick || bodies_.excluded[c].stick;
  }
  nothing_has_changed();
  if (length * std::max(bodies_.dynamics.speed(), 1.0L) < kRoundOff) bodies_.earlier = std::move(before);
  bool changed = false;
  for (const EventReport& e : events) {
    const auto at = known.find(e.name);
    if (at == known.end()) continue;
    changed = true;
    const auto [contact, change] = at->second;
    if (change == ModeChange::passes) bodies_.borders.reached(contact);
    if (change == ModeChange::hits) bodies_.near.reached(contact);
    if (change == ModeChange::turns) bodies_.turned[contact] = true;
    if (change == ModeChange::leaves) bodies_.excluded[contact].touch = true;
    if (change == ModeChange::slips) bodies_.excluded[contact].stick = true, slips_(contact);
    if (change == ModeChange::sticks) bodies_.excluded[contact].slips = true;
  }
  return changed;
}

void ModeSegments::nothing_has_changed() {
  bodies_.borders.segment_has_ended();
  bodies_.excluded.assign(bodies_.contacts.size(), {});
  bodies_.earlier.assign(bodies_.contacts.size(), {});
  bodies_.turned.assign(bodies_.contacts.size(), false);
}

ReadyMode* ModeSegments::begin(ModeEnds ends, Outcome& outcome) {
  ReadyMode* mode = nullptr;
  do {
    mode = &ready_.begin(bodies_.modes, bodies_.at, outcome, ends);
    if (!outcome.ok()) return nullptr;
  } while (bodies_.deeper(mode->own->state.q));
  return mode;
}

ReadyMode* ModeSegments::simulate_mode(const Rational& to, SimulationReport& report, Outcome& outcome) {
  ReadyMode* const mode = begin(ModeEnds::events, outcome);
  if (!mode) return nullptr;
  rows_.begin_segment(mode->of.stopped);
  SimulationOptions o = asked(to);
  o.from_zero = from_zero(*mode, bodies_);
  report = simulate_in(*mode->own, o, rows_, &mode->plans);
  outcome = report.outcome;
  return mode;
}

bool ModeSegments::last_until(const Rational& to, ContactState& at) {
  class NoRows final : public RowSink {
    void columns(const std::vector<RunColumn>&) override {}
    void row(const Row&) override {}
  } none;
  Outcome outcome;
  ReadyMode* const mode = to > end_ ? nullptr : begin(ModeEnds::events, outcome);
  if (!mode) return false;
  SegmentRows last(none, bodies_.contacts);
  last.begin_segment();
  SimulationOptions o = asked(to);
  o.at = {to};
  o.dense = nullptr;
  o.followed.clear();
  o.watches_floors = false;
  o.watches_ranges = false;
  o.from_zero = from_zero(*mode, bodies_);
  const SimulationReport r = simulate_in(*mode->own, o, last, &mode->plans);
  at = bodies_.at;
  last.last_state(at);
  return r.outcome.ok() && at.t == Rational(to.get_d()) &&
         std::none_of(r.events.begin(), r.events.end(),
                      [&](const EventReport& e) { return mode->of.events.count(e.name) > 0; });
}

SimulationOptions ModeSegments::asked(const Rational& to) const {
  SimulationOptions o = o_;
  o.most_steps -= std::min(o.most_steps, joined_.steps());
  o.state = {};
  o.to = to;
  o.every.reset();
  o.at_text.clear();
  o.at.clear();
  for (std::size_t k = rows_.due(); k < times_.size(); ++k)
    if (times_[k] <= to && (joined_.segments() == 0 ? times_[k] >= bodies_.at.t : times_[k] > bodies_.at.t))
      o.at.push_back(times_[k]);
  // The next segment begins with the last row.
  if (!o.at.empty() && o.at.back() < to) o.at.push_back(to);
  o.estimate = ErrorEstimate::never;
  o.conserved.clear();
  o.watches_floors = o_.watches_floors && has_supports_;
  o.watches_carriers = false;  // the note is about the start of the whole motion
  o.note = nullptr;
  if (o_.progress) o.progress = [this](double t, std::size_t steps) { o_.progress(t, joined_.steps() + steps); };
  o.state.t = bodies_.at.t;
  return o;
}

SimulationOptions ModeSegments::asked_of_stretch(const Rational& to, const Rational& tolerance) const {
  constexpr std::size_t kMostSteps = 3000;
  SimulationOptions o = asked(to);
  const std::vector<Rational> more = times_of_stretch(bodies_.at.t, to);
  if (o.at.empty() && joined_.segments() == 0) o.at.push_back(bodies_.at.t);
  o.at.insert(o.at.end(), more.begin(), more.end());
  std::sort(o.at.begin(), o.at.end());
  o.at.erase(std::unique(o.at.begin(), o.at.end()), o.at.end());
  o.method = stiff_method();
  o.dense = nullptr;
  o.followed.clear();
  o.tolerance = tolerance;
  o.most_steps = std::min(o.most_steps, kMostSteps);
  return o;
}

bool ModeSegments::by_bdf(const Rational& to) {
  const Rational least(1, 1'000'000'000'000), first = std::max(o_.tolerance, least), most = 1000 * first;
  if (o_.method != Method::automatic || looks_for_events_ || std::exchange(events_near_, false) || bodies_.at.t == to)
    return false;
  const std::optional<long double> time = stiff_for(bodies_, Rational(to - bodies_.at.t).get_d());
  if (!time) return false;
  Rational end = std::min(to, Rational(bodies_.at.t.get_d() + static_cast<double>(*time)));
  bool whole = true;
  for (Rational tolerance = first; tolerance <= most;) {
    Outcome outcome;
    ReadyMode* mode = begin(ModeEnds::conditions, outcome);
    if (!mode) return false;
    StretchRows stretch(mode->of.conditions);
    SimulationReport r = simulate_in(*mode->own, asked_of_stretch(end, tolerance), stretch);
    if (o_.cancelled && o_.cancelled()) return false;
    if (r.outcome.ok() && stretch.held()) {
      std::erase_if(r.monitors, [](const WatchedReport& m) { return m.name[0] == kCondition; });
      joined_.by_bdf(bodies_.at.t.get_d(), r);
      rows_.begin_segment(mode->of.stopped);
      stretch.pass_to(rows_);
      events_near_ = !whole;
      return true;
    }
    if (r.outcome.kind == OutcomeKind::interrupted && stretch.held()) {
      // The round-off of the velocities turns the direction of a slow slip by more than the tolerance.
      tolerance *= 10;
      continue;
    }
    const std::optional<double> until = stretch.held_until();
    if (!until || !(Rational(*until) > bodies_.at.t) || !(Rational(*until) < end)) return false;
    end = Rational(*until);
    whole = false;
  }
  return false;
}

bool ModeSegments::may_be_stiff(const SimulationReport& r, const Rational& to) {
  constexpr int kMostRetries = 20;
  return gave_up(r) && stiff_for(bodies_, Rational(to - bodies_.at.t).get_d()) && retries_++ < kMostRetries;
}

bool ModeSegments::may_hold_others(const SimulationReport& r) const {
  return r.outcome.kind == OutcomeKind::singular && shares_friction(bodies_.modes);
}

bool ModeSegments::gave_up(const SimulationReport& r) const {
  return r.outcome.kind == OutcomeKind::interrupted && joined_.steps() < o_.most_steps &&
         !(o_.cancelled && o_.cancelled());
}

bool ModeSegments::slip_vanishes() {
  constexpr long double kVanished = 1e-8L;
  bodies_.dynamics.go(bodies_.at);
  bool any = false;
  if (std::exchange(vanished_, bodies_.at.t) == bodies_.at.t) return false;
  for (std::size_t c = 0; c < bodies_.contacts.size(); ++c) {
    const ContactRows& rows = bodies_.dynamics.accelerations().contacts[c];
    if (bodies_.modes[c].touch != Touch::slips || !rows.rough || rows.tangential.size() < 2) continue;
    const ContactDynamics::Place& place = bodies_.dynamics.place(c);
    if (std::hypot(place.slip[0], place.slip[1]) > kVanished * place.slip_reach) continue;
    bodies_.set_slip(c, {}, 0);
    joined_.event(bodies_.contacts[c].name + "." + word(bodies_.contacts[c], ModeChange::sticks), bodies_.at.t.get_d());
    any = true;
  }
  return any;
}

}  // namespace anholon
