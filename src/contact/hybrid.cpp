#include "contact/hybrid.h"

#include <algorithm>
#include <chrono>
#include <cmath>

#include "contact/accumulation.h"
#include "contact/contact_dynamics.h"
#include "contact/impact.h"
#include "contact/joined_report.h"
#include "contact/refused_options.h"
#include "contact/round_off.h"
#include "contact/segment_rows.h"
#include "contact/switched_motion.h"
#include "numeric/number.h"

namespace anholon {

namespace {

class HybridMotion {
 public:
  HybridMotion(Workspace& s, const std::vector<Contact>& contacts, const SimulationOptions& o, RowSink& sink)
      : s_(s), contacts_(contacts), o_(o), dynamics_(s, contacts), near_(contacts, dynamics_, at_),
        rows_(sink, contacts), joined_(*s.model), accumulation_(contacts.size()) {
    at_.t = o.state.t ? *o.state.t : Rational(s.state.t);
    at_.q = s.state.q, at_.qd = s.state.qd, at_.states = s.state.states;
    end_ = o.to && (o.at.empty() || *o.to > o.at.back()) ? *o.to : o.at.back();
    if (end_ < at_.t) throw Failure({}, "a motion with contacts goes forwards only", "an end after the start");
    times_ = o.at;
    if (o.every)
      for (Rational t = at_.t; t < end_; t += *o.every) times_.push_back(t);
    if (!times_.empty() && times_.back() != end_) times_.push_back(end_);
    rows_.only_at(times_);
  }

  SimulationReport go() {
    excluded_.assign(contacts_.size(), {});
    held_.assign(contacts_.size(), 0);
    // A parameter that is varied may give a coefficient any value.
    if (const std::vector<Diagnostic> wrong = wrong_coefficients(contacts_, *s_.model); !wrong.empty())
      return joined_.report({OutcomeKind::inconsistent, wrong[0].message, wrong[0].hint}, at_.t.get_d(), 0);
    Outcome outcome = not_inside(" at the start", "start at a position where the gap is zero or positive");
    constexpr std::size_t kMostSegments = 100'000;
    for (std::size_t k = 0; outcome.ok() && at_.t < end_; ++k) {
      if (k == kMostSegments)
        outcome = {OutcomeKind::interrupted, "more than 100000 changes of the contacts" + when(),
                   "end the motion earlier"};
      else
        outcome = choose();
      if (outcome.ok() && !segment(end_, outcome)) break;
      if (outcome.ok() && !hold(outcome)) break;
      if (outcome.ok()) outcome = not_inside(when(), kPassed);
    }
    if (outcome.ok()) outcome = not_inside(when(), kPassed);
    return joined_.report(std::move(outcome), at_.t.get_d(), rows_.rows());
  }

 private:
  // A slip velocity with two components ends at kRest and begins at kSeed of the velocities: at zero it has no direction.
  static constexpr long double kRest = 1e-12L, kSeed = 1e-10L;
  // The jump that stops a velocity leaves this part of what the velocity has been.
  static constexpr long double kLeftOver = 1e-16L;
  // Impacts at one instant; others follow after a segment.
  static constexpr std::size_t kMostImpacts = 16;
  static constexpr const char* kPassed =
      "the contact is deeper than the round-off of its event: take a smaller --tolerance, or end the motion before";
  // What the event at which the last segment ended excludes.
  struct Excluded {
    bool touch = false, stick = false, slips = false;
  };
  std::string event_name(std::size_t c, ModeChange change) const {
    return contacts_[c].name + "." + word(contacts_[c], change);
  }
  std::string when() const { return " at t = " + number_text(at_.t.get_d(), 12); }

  // An outcome if a gap is negative.
  Outcome not_inside(const std::string& where, const std::string& hint) {
    dynamics_.go(at_);
    for (std::size_t c = 0; c < contacts_.size(); ++c)
      if (dynamics_.place(c).gap < 0 && !near_.negligible(c))
        return {OutcomeKind::inconsistent,
                "the gap of contact '" + contacts_[c].name + "' is " +
                    number_text(static_cast<double>(dynamics_.place(c).gap), 6) + where + ", and a gap is not negative",
                hint};
    return {};
  }
  // Impacts where a closed gap shrinks, then the modes by the accelerations.
  Outcome choose() {
    dynamics_.go(at_);
    for (std::size_t k = 0; shrinks() && k < kMostImpacts; ++k)
      if (Outcome o = impact(); !o.ok()) return o;
    land();
    ContactProblem p = with_touching();
    for (std::size_t c = 0; c < contacts_.size(); ++c)
      if (excluded_[c].stick && contacts_[c].slip.size() == 2) against_friction(p, c);
    const std::vector<ContactSolution> list = consistent_modes(p);
    if (list.size() != 1) return undecided(list.size());
    modes_ = list[0].modes;
    for (std::size_t c = 0; c < contacts_.size(); ++c)
      if (excluded_[c].slips && modes_[c].touch == Touch::slips)
        joined_.rename(event_name(c, ModeChange::sticks), event_name(c, ModeChange::reverses));
    if (const auto open = of_modes(p, ContactModes(contacts_.size()))) {
      before_ = 0;
      for (const long double a : open->x) before_ = std::max(before_, std::abs(a));
    }
    come_to_rest();
    long double force = 0;
    for (const long double b : p.b) force = std::max(force, std::abs(b));
    for (std::size_t c = 0; c < contacts_.size(); ++c) {
      modes_[c].rest = kRest * dynamics_.place(c).slip_scale;
      modes_[c].depth = RoundOff::kPlace / 2 * near_.place_size(c) + std::max(0.0L, -dynamics_.place(c).gap);
      modes_[c].slack = kRest * (force > 0 ? force : 1);
      if (contacts_[c].under) modes_[c].slack *= p.contacts[c].friction;
      if (contacts_[c].slip.size() < 2 || modes_[c].free) continue;
      const bool begins = modes_[c].touch == Touch::slips && contacts_[c].rough() && !p.contacts[c].moves;
      if (begins) set_slip(c, modes_[c].direction, first_slip(c, list[0].x));
    }
    // The velocities at the end of a segment have the round-off of those before, which may be much larger.
    dynamics_.go(at_);
    stop(modes_);
    drop_left_over();
    return {};
  }

  // What the jump leaves of velocities that it stops. Those that a constraint joins, as the norm of a quaternion does, are
  // dropped together: a part of them would contradict the constraint.
  void drop_left_over() {
    for (std::size_t a = 0; a < at_.qd.size(); ++a)
      if (std::abs(at_.qd[a]) <= kLeftOver * dynamics_.most(a)) at_.qd[a] = 0;
    for (const std::vector<long double>& row : dynamics_.accelerations().Phi) {
      long double now = 0, most = 0;
      for (std::size_t a = 0; a < row.size(); ++a)
        if (row[a] != 0)
          now = std::max<long double>(now, std::abs(at_.qd[a])), most = std::max(most, dynamics_.most(a));
      for (std::size_t a = 0; a < row.size(); ++a)
        if (row[a] != 0 && now <= RoundOff::kPlace * most) at_.qd[a] = 0;
    }
  }

  // The accelerations, in which each contact may do what its gap and the event at which the last segment ended allow.
  ContactProblem with_touching() const {
    ContactProblem p = dynamics_.accelerations();
    for (std::size_t c = 0; c < contacts_.size(); ++c) {
      ContactRows& rows = p.contacts[c];
      rows.may_touch = near_.closed(c) && near_.gap_rate(c) == 0 && !excluded_[c].touch;
      rows.may_stick = !excluded_[c].stick;
      if (excluded_[c].touch) rows.before = before_;
      rows.moves = rows.moves && !excluded_[c].slips;
      // A gap that is open, or opens, is not bounded by its acceleration.
      if (!near_.closed(c) || near_.gap_rate(c) > 0) rows.normal.assign(at_.q.size(), 0), rows.normal_rate = 0;
    }
    return p;
  }

  // Velocities within round-off of those that the motion had are zero, and so are coordinates: where the modes leave no
  // motion, the remainders would contradict each other.
  void come_to_rest() {
    constexpr long double kZero = 1e-13L, kNoPlace = 1e-16L;
    most_place_.resize(at_.q.size(), 0);
    for (std::size_t a = 0; a < at_.qd.size(); ++a) {
      if (std::abs(at_.qd[a]) <= kZero * dynamics_.most(a)) at_.qd[a] = 0;
      most_place_[a] = std::max<long double>(most_place_[a], std::abs(at_.q[a]));
      if (std::abs(at_.q[a]) <= kNoPlace * most_place_[a]) at_.q[a] = 0;
    }
  }

  Outcome undecided(std::size_t modes) const {
    std::string names;
    for (std::size_t c = 0; c < contacts_.size(); ++c) {
      if (!near_.closed(c) || contacts_[c].under) continue;
      names += (names.empty() ? "'" : ", '") + contacts_[c].name + "'";
      if (modes == 0 && dynamics_.loses_rank(c)) return rank_lost(contacts_[c].name, when());
    }
    return painleve(modes, names + " ", when());
  }

  // Whether a closed gap shrinks.
  bool shrinks() const {
    bool any = false;
    for (std::size_t c = 0; c < contacts_.size(); ++c) any = any || (near_.closed(c) && near_.gap_rate(c) < 0);
    return any;
  }

  // Impacts within round-off of one instant for which no mode is consistent follow each other: the least gap comes first.
  void first_alone(std::vector<bool>& touches) const {
    std::size_t first = contacts_.size();
    for (std::size_t c = 0; c < contacts_.size(); ++c)
      if (touches[c] && near_.gap_rate(c) < 0 &&
          (first == contacts_.size() || dynamics_.place(c).gap < dynamics_.place(first).gap))
        first = c;
    for (std::size_t c = 0; c < contacts_.size(); ++c)
      touches[c] = touches[c] && (c == first || near_.gap_rate(c) == 0);
  }

  Outcome impact() {
    const std::size_t n = at_.q.size();
    std::vector<bool> touches;
    for (std::size_t c = 0; c < contacts_.size(); ++c) touches.push_back(near_.closed(c) && near_.gap_rate(c) <= 0);
    std::vector<std::vector<long double>> list = impact_jumps(dynamics_, contacts_, touches);
    if (list.size() != 1) {
      first_alone(touches);
      list = impact_jumps(dynamics_, contacts_, touches);
    }
    if (list.size() != 1) return undecided(list.size());
    std::vector<long double> before(at_.qd.begin(), at_.qd.end()), after = before;
    for (std::size_t a = 0; a < n; ++a) after[a] += list[0][a];
    constexpr long double kGrows = 1e-12L;
    // Formulas that hold t move a wall, which may give energy.
    if (!walls_move(contacts_) && dynamics_.energy(after) > dynamics_.energy(before) * (1 + kGrows))
      return {OutcomeKind::inconsistent, "the impact would raise the energy" + when(),
              contacts_[0].law == ImpactLaw::newton
                  ? "Newton's law with friction does so in this direction: impact = \"poisson\" in the contacts"
                  : "take a smaller restitution"};
    std::vector<EventReport::Change> changes;
    for (std::size_t a = 0; a < n; ++a) {
      const auto v = static_cast<double>(after[a]);
      if (v != at_.qd[a]) changes.push_back({s_.model->coordinates[a].name + "'", {at_.qd[a], ""}, {v, ""}});
      at_.qd[a] = v;
    }
    joined_.set(at_.t.get_d(), changes);
    for (std::size_t c = 0; c < contacts_.size(); ++c) {
      if (touches[c] && near_.gap_rate(c) != 0 && !contacts_[c].under) accumulation_.impact(c, at_.t.get_d());
      excluded_[c] = {};
    }
    dynamics_.go(at_);
    land();
    return {};
  }

  // A gap comes to rest if its impacts add up to a limit less than kLeft away, or if it is pressed together and would
  // rise, with its velocity after the impact, by round-off of its place only. Gaps that come to rest do so together, as
  // the impacts of each set the others in motion; and so does a slip that friction ends within round-off of the place.
  void land() {
    constexpr double kLeft = 1e-7;
    const double t = at_.t.get_d();
    ContactModes stops(contacts_.size());
    bool any = false;
    for (std::size_t c = 0; c < contacts_.size(); ++c) {
      if (!near_.closed(c) || contacts_[c].under) continue;
      const std::optional<double> limit = accumulation_.limit(c);
      const bool rests = near_.gap_rate(c) != 0 && ((limit && *limit - t < kLeft) || near_.hardly_rises(c));
      if (rests || near_.gap_rate(c) == 0) stops[c].touch = Touch::slips;
      if (!rests) continue;
      any = true;
      joined_.event(contacts_[c].name + ".rests", limit ? std::max(*limit, t) : t);
      accumulation_.forget(c);
    }
    if (!any) return;
    stop(stops);
    for (std::size_t c = 0; c < contacts_.size(); ++c)
      if (stops[c].touch != Touch::open && near_.hardly_slips(c)) stops[c].touch = Touch::sticks;
    stop(stops);
  }

  // The jump of least change after which what touches does not move along its normal, and what sticks does not slip. A
  // contact that the others stop already is left out.
  void stop(const ContactModes& modes) {
    const ContactProblem p = dynamics_.stop();
    ContactModes stopped(contacts_.size());
    std::optional<ContactSolution> jump;
    if (!p.beta.empty()) jump = of_modes(p, stopped);
    for (std::size_t c = 0; c < contacts_.size(); ++c) {
      for (const Touch touch : {Touch::sticks, Touch::slips}) {
        if (touch > modes[c].touch) continue;
        stopped[c].touch = touch;
        if (auto further = of_modes(p, stopped)) {
          jump = std::move(further);
          break;
        }
        stopped[c].touch = Touch::open;
      }
    }
    if (jump) add_to_velocities(jump->x);
    dynamics_.go(at_);
  }

  void add_to_velocities(const std::vector<long double>& jump) {
    for (std::size_t a = 0; a < at_.qd.size(); ++a) at_.qd[a] = static_cast<double>(at_.qd[a] + jump[a]);
  }

  // The slip velocity from which a slip with two components is followed. After held_ it has grown with the acceleration,
  // which is zero where the slip begins.
  long double first_slip(std::size_t c, const std::vector<long double>& accelerations) const {
    const long double seed = kSeed * std::max(dynamics_.speed(), 1.0L);
    return held_[c] > 0 ? std::max(seed, dynamics_.slip_acceleration(c, accelerations) * held_[c] / 2) : seed;
  }

  // Where a slip with two components begins without acceleration, its velocity grows by the square of the time, and as long
  // as it is small its direction is stiff. The contact is held for the time h in which the velocity reaches kHeld of its
  // terms; the error is of the order of h^3 (theory: contact). Returns false if the motion ends meanwhile.
  bool hold(Outcome& outcome) {
    constexpr long double kHeld = 1e-7L, kTrial = 1e-6L, kMost = 3e-2L;
    std::fill(held_.begin(), held_.end(), 0);
    std::size_t c = 0;
    while (c < contacts_.size() && !begins_at_rest(c)) ++c;
    if (c == contacts_.size()) return true;
    const long double pace = 1 / std::max(dynamics_.speed(), 1.0L), trial = kTrial * pace;
    if (!hold_for(c, trial, outcome)) return outcome.ok();
    dynamics_.go(at_);
    ContactProblem p = with_touching();
    against_friction(p, c);
    const std::vector<ContactSolution> list = consistent_modes(p);
    if (list.size() != 1 || list[0].modes[c].touch != Touch::slips) return true;
    held_[c] = trial;
    const long double rate = dynamics_.slip_acceleration(c, list[0].x) / trial, scale = dynamics_.place(c).slip_scale;
    // A contact that never moved has terms of unknown size.
    const long double h = std::min(std::sqrt(2 * kHeld * (scale > 0 ? scale : 1) / rate), kMost * pace);
    if (!(h > 2 * trial)) return true;
    if (!hold_for(c, h - trial, outcome)) return outcome.ok();
    held_[c] = h;
    if (holds_again(c)) excluded_[c].stick = false;
    return true;
  }

  // Whether the friction that is needed to hold a contact, which was too large, no longer is: a disc that rocks needs most
  // where it turns back.
  bool holds_again(std::size_t c) {
    dynamics_.go(at_);
    ContactProblem p = with_touching();
    p.contacts[c].may_stick = true;
    const std::vector<ContactSolution> list = consistent_modes(p);
    if (list.size() != 1 || list[0].modes[c].touch != Touch::sticks) return false;
    const auto& T = list[0].friction[c];
    return std::hypot(T[0], T[1]) < p.contacts[c].static_friction * list[0].normal[c];
  }

  // Whether the last segment ended with a slip of this contact that has two components and one coefficient of friction.
  bool begins_at_rest(std::size_t c) const {
    const ContactRows& rows = dynamics_.accelerations().contacts[c];
    return excluded_[c].stick && modes_[c].touch == Touch::sticks && contacts_[c].slip.size() == 2 &&
           rows.friction == rows.static_friction;
  }

  // Returns false if something else happens before.
  bool hold_for(std::size_t c, long double time, Outcome& outcome) {
    const Rational to(at_.t.get_d() + static_cast<double>(time));
    if (to >= end_) return false;
    modes_[c].held = true;
    stop(modes_);
    const bool goes_on = segment(to, outcome);
    modes_[c].held = false;
    excluded_[c].stick = true;
    return goes_on && outcome.ok() && at_.t >= to;
  }

  // A slip that begins where the friction that holds has become too large begins against this friction, which is that of
  // the mode before: resistance to rolling turns it.
  void against_friction(ContactProblem& p, std::size_t c) const {
    ContactModes modes = modes_;
    for (std::size_t o = 0; o < modes.size(); ++o)
      if (p.contacts[o].moves) modes[o].direction = p.contacts[o].direction;
    modes[c].touch = Touch::sticks;
    const auto held = of_modes(p, modes);
    const long double size = held ? std::hypot(held->friction[c][0], held->friction[c][1]) : 0;
    if (size > 0) p.contacts[c].direction = {-held->friction[c][0] / size, -held->friction[c][1] / size};
  }

  // The jump of least change that gives a contact the slip velocity v along d.
  void set_slip(std::size_t c, const std::array<long double, 2>& d, long double v) {
    ContactProblem p = dynamics_.impact(std::vector<bool>(contacts_.size(), false));
    ContactModes modes(contacts_.size());
    modes[c].touch = Touch::sticks;
    p.contacts[c] = dynamics_.accelerations().contacts[c];
    p.contacts[c].normal_rate = 0;
    for (std::size_t a = 0; a < 2; ++a) p.contacts[c].tangential_rate[a] = dynamics_.place(c).slip[a] - v * d[a];
    const auto jump = of_modes(p, modes);
    if (!jump) return;
    add_to_velocities(jump->x);
  }

  // A slip velocity with two components that vanishes on a curved line has no Taylor series there, and the steps become
  // short without end. Returns whether that is how the segment ended; the contact then sticks.
  bool slip_vanishes() {
    constexpr long double kVanished = 1e-8L;
    dynamics_.go(at_);
    bool any = false;
    for (std::size_t c = 0; c < contacts_.size(); ++c) {
      const ContactRows& rows = dynamics_.accelerations().contacts[c];
      if (modes_[c].touch != Touch::slips || !rows.rough || rows.tangential.size() < 2) continue;
      const auto& slip = dynamics_.place(c).slip;
      long double size = 0;
      for (const std::vector<long double>& t : rows.tangential)
        for (std::size_t a = 0; a < at_.qd.size(); ++a) size = std::max(size, std::abs(t[a] * dynamics_.most(a)));
      if (std::hypot(slip[0], slip[1]) > kVanished * size) continue;
      set_slip(c, {}, 0);
      joined_.event(event_name(c, ModeChange::sticks), at_.t.get_d());
      any = true;
    }
    return any;
  }

  // The places at which a segment begins close the gaps of what touches, which may push an open gap below the depth at which
  // it hits. Returns whether that is so; the depth is then that of the gap.
  bool deeper(const std::vector<double>& q) {
    ContactState begin = at_;
    begin.q = q;
    dynamics_.go(begin);
    bool any = false;
    for (std::size_t c = 0; c < contacts_.size(); ++c) {
      const long double gap = dynamics_.place(c).gap;
      if (modes_[c].touch != Touch::open || gap > -modes_[c].depth || !near_.closed(c)) continue;
      modes_[c].depth = RoundOff::kPlace / 2 * near_.place_size(c) - gap;
      any = true;
    }
    dynamics_.go(at_);
    return any;
  }

  // Whether the segment ended because its end lies too many of its short steps ahead.
  bool gave_up(const SimulationReport& r) const {
    return r.outcome.kind == OutcomeKind::interrupted && r.steps < o_.most_steps && !(o_.cancelled && o_.cancelled());
  }

  // Follows the motion in the present modes to their end; returns false if it ends there.
  bool segment(const Rational& to, Outcome& outcome) {
    ModeModel mode;
    Scenario scenario;
    do {
      mode = mode_model(*s_.model, contacts_, modes_, at_);
      scenario = {};
      outcome = make_scenario(mode.model, *s_.system.form, {}, scenario);
      if (!outcome.ok()) return false;
    } while (deeper(scenario.state.q));
    Workspace own(scenario);
    SimulationOptions o = o_;
    o.state = {};
    o.to = to;
    o.every.reset();
    o.at_text.clear();
    o.at.clear();
    for (std::size_t k = rows_.due(); k < times_.size(); ++k)
      if (times_[k] <= to && (joined_.segments() == 0 ? times_[k] >= at_.t : times_[k] > at_.t))
        o.at.push_back(times_[k]);
    o.estimate = ErrorEstimate::never;
    o.conserved.clear();
    o.note = nullptr;
    o.state.t = at_.t;
    rows_.begin_segment(mode.stopped);
    const SimulationReport r = simulate_in(own, o, rows_);
    outcome = r.outcome;
    const ContactState from = at_;
    rows_.last_state(at_);
    dynamics_.pass(from, at_);
    const bool every_event_known = joined_.add(r, mode.events);
    if ((outcome.kind == OutcomeKind::step_collapse || gave_up(r)) && slip_vanishes()) {
      outcome = {};
      excluded_.assign(contacts_.size(), {});
      return true;
    }
    if (!outcome.ok()) return false;
    for (Excluded& e : excluded_) e = {};
    bool changed = false;
    for (const EventReport& e : r.events) {
      const auto known = mode.events.find(e.name);
      if (known == mode.events.end()) continue;
      changed = true;
      if (known->second.change == ModeChange::leaves) excluded_[known->second.contact].touch = true;
      if (known->second.change == ModeChange::slips) excluded_[known->second.contact].stick = true;
      if (known->second.change == ModeChange::sticks) excluded_[known->second.contact].slips = true;
    }
    return (changed || to < end_) && every_event_known && at_.t < end_;
  }

  Workspace& s_;
  const std::vector<Contact>& contacts_;
  const SimulationOptions& o_;
  ContactDynamics dynamics_;
  ContactState at_;
  RoundOff near_;
  SegmentRows rows_;
  JoinedReport joined_;
  Rational end_;
  std::vector<Rational> times_;
  ContactModes modes_;
  std::vector<Excluded> excluded_;
  long double before_ = 0;         // the largest acceleration without contacts where the last mode began
  std::vector<long double> held_;  // the time for which a contact that begins to slip was held
  Accumulation accumulation_;
  std::vector<long double> most_place_;  // the largest value of each coordinate at a change of mode
};

}  // namespace

SimulationReport simulate_with_contacts(Workspace& s, const std::vector<Contact>& contacts,
                                        const SimulationOptions& options, RowSink& sink) {
  const auto held = static_cast<std::size_t>(
      std::count_if(contacts.begin(), contacts.end(), [](const Contact& c) { return c.held.has_value(); }));
  if (held > 0 && held < contacts.size())
    throw Failure({}, "a motion knows contacts or constraints with 'active', and the model has both",
                  "a contact that an event switches: let its gap hold the mode");
  refuse_options(options, s, held > 0);
  const auto start = std::chrono::steady_clock::now();
  SimulationReport r =
      held > 0 ? simulate_with_switches(s, contacts, options, sink) : HybridMotion(s, contacts, options, sink).go();
  r.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return r;
}

}  // namespace anholon
