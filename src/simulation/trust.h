// The limits of trust in a computed motion: warnings, limits of events, masses that become negative.
#pragma once
#include "integrate/series/sign_change.h"
#include "motion/course.h"
#include "numeric/told_time.h"
#include "observe/angles.h"
#include "observe/report.h"
#include "observe/watch.h"
#include "simulation/near_singular.h"

namespace anholon {

// The first time in the last step at which a mass passes zero; the end of the step if none does.
template <class W>
struct MassLimit {
  W t{0};
  std::size_t mass = 0;  // the index of the mass in the model
};

// True if a mass may pass zero in a step.
template <Number N>
bool masses_vary(const Model& model, const Stepper<N>& stepper) {
  for (std::size_t i = 0; i < model.masses.size(); ++i)
    if (!model.masses[i].weight && !stepper.constant_quadrature(1 + i)) return true;
  return false;
}

// Returns the first point before the end of the last step at which a quadrature is negative by more than round-off,
// from the start of the step; nullopt if there is none.
template <Number N>
std::optional<Wider<N>> first_negative(const Stepper<N>& stepper, std::size_t quadrature) {
  using W = Wider<N>;
  constexpr int kNoise = 64;
  constexpr double kSurelyBefore = 1 - 0x1p-20;
  const N h = convert<N>(W(stepper.time() - stepper.before()));
  std::vector<N> c;
  N most(0), power(1);
  for (int k = 0; k < stepper.order(); ++k, power *= h) {
    c.push_back(stepper.quadrature_coefficient(quadrature, k));
    if (const N size = abs(N(c.back() * power)); size > most) most = size;
  }
  const auto found = first_below<N>(c.data(), stepper.order() - 1, h, N(unit_roundoff<N>() * N(kNoise) * most));
  return found && abs(*found) < abs(h) * N(kSurelyBefore) ? std::optional<W>(convert<W>(*found)) : std::nullopt;
}

template <Number N>
MassLimit<Wider<N>> masses_positive_until(const Model& model, const Course<N>& course) {
  using W = Wider<N>;
  if (!course.by_taylor()) return {course.time(), 0};  // Taylor's steps go to where a mass vanishes
  const Stepper<N>& stepper = course.taylor().stepper();
  const W whole = stepper.time() - stepper.before();
  W good = whole;
  std::size_t negative = 0;
  for (std::size_t i = 0; i < model.masses.size(); ++i) {
    if (model.masses[i].weight || stepper.constant_quadrature(1 + i)) continue;
    const std::optional<W> first = first_negative(stepper, 1 + i);
    if (first && abs(*first) < abs(good)) {
      good = *first;
      negative = i;
      continue;
    }
    if (!(stepper.quadrature(1 + i, good) < W(0))) continue;
    W low(0), high = good;
    for (int k = 0; k < 200 && !(low == high); ++k) {
      const W middle = low + (high - low) * W(0.5);
      if (middle == low || middle == high) break;
      (stepper.quadrature(1 + i, middle) < W(0) ? high : low) = middle;
    }
    good = low;
    negative = i;
  }
  return {good == whole ? stepper.time() : stepper.before() + good, negative};
}

inline Outcome negative_mass(const Model& model, std::size_t mass, double t) {
  return told({OutcomeKind::negative_mass,
               "the mass of '" + model.masses[mass].name + "' is negative from t = " + number_text(t, 12) + " on",
               "end the motion before, or let the mass end at zero flow"},
              t);
}

// Notes on events whose limit is passed at the start: such an event does not happen until its formula has come back.
template <Number N>
std::vector<std::string> passed_limits(const Model& model, const Motion<N>& motion) {
  // A limit at which the motion starts is not passed by round-off.
  constexpr double kPassed = 1e-12;
  std::vector<std::string> notes;
  for (std::size_t i = 0; i < model.events.size(); ++i) {
    const Event& e = model.events[i];
    const double value = e.direction * motion.at_start(i);
    if (!e.ends_step() || !(value > kPassed)) continue;
    notes.push_back("event '" + e.name + "' is past its limit at the start: its formula is " +
                    number_text(e.direction * value, 6) + ", and it happens where that passes zero " +
                    (e.direction > 0 ? "upwards" : "downwards") + "; until it has come back, nothing happens");
  }
  return notes;
}

// Warns of jumps that the equations do not contain: if a potential, a position, the observer or a constraint jumps, or
// its rate does, an impulse would be needed. Jumps show in integrals of the motion that change, and in constraints that
// are missed at the start of a step, with Taylor's method after a kink. Under another method, its own errors change
// integrals, too.
template <Number N>
std::vector<Warning> warnings_of_jumps(const Course<N>& course, const Watch<Wider<N>>& watch,
                                       const SimulationOptions& o, bool something_set) {
  constexpr double kLeast = 1e-6, kTolerances = 1e4;  // far above the errors of integration
  const double limit = std::max(kLeast, kTolerances * o.tolerance.get_d());
  const bool taylor = !course.report().differs_from_taylor();
  std::vector<Warning> list;
  const auto warn = [&](const std::string& what, const std::string& of) {
    const std::string jump = "if a formula in " + of +
                             " jumps on the way (sign, piecewise, a table), or its rate does, the impulse that this "
                             "needs is in no equation: take a smooth function, or let an event set what changes";
    list.push_back({what, taylor
                              ? jump + "; otherwise look at the digits to trust"
                              : "make the tolerance smaller: if the change becomes smaller with it, the tolerance is "
                                "too large for a motion of this length; otherwise, " +
                                    jump});
  };
  const std::size_t first = watch.tracks().size() - o.conserved.size();
  for (std::size_t i = 0; i < o.conserved.size() && !something_set; ++i)
    if (const double change = watch.tracks()[first + i].relative_change(); change > limit)
      warn("the integral '" + o.conserved[i].name + "' changes by " + number_text(change, 3) + " of its terms",
           "a potential, a position or the motion of the observer");
  if (const double missed = to_double(course.worst_constraint());
      missed > limit && (!taylor || course.taylor().stepper().kinks() > 0))
    warn("a constraint is missed by " + number_text(missed, 3) + " where a step begins", "a constraint");
  return list;
}

// True if a singular configuration ends the motion and is the one at which the equations are the least regular. The
// message of the outcome tells of it then, and nothing follows it. The steps become ever shorter on the way to it.
template <Number N>
bool ends_where_least_regular(const Course<N>& course, const Outcome& outcome) {
  using W = Wider<N>;
  constexpr int kRecentSteps = 8;  // as in motion/stop.cpp
  const W recent = abs(W(course.time() - course.before())) * W(kRecentSteps);
  return outcome.kind == OutcomeKind::singular && abs(W(course.smallest_sigma_time() - course.time())) <= recent;
}

// Warns if a motion passes near a singular configuration, if outputs that were declared conserved are not, and if
// angles come near their singularity.
template <Number N>
std::vector<Warning> warnings(const Workspace& s, const Course<N>& course, const Watch<Wider<N>>& watch,
                              const AngleWatch& angles, const Outcome& outcome) {
  constexpr double kNearSingular = 1e-3;
  const Model& model = *s.model;
  std::vector<Warning> list;
  if (course.smallest_sigma() < course.first_sigma() * N(kNearSingular) &&
      !ends_where_least_regular<N>(course, outcome)) {
    const std::size_t j = course.weakest_unknown(), n = s.system.coordinates;
    const bool is_multiplier = n <= j && j < s.system.mechanical();
    const unsigned order = is_multiplier ? 0 : static_cast<unsigned>(course.taylor().program().d[j]);
    const std::string what =
        is_multiplier ? "the constraint '" + s.system.equation_names[j] + "' nearly loses its hold"
                      : derivative_name(s.system.variable_names[j], order, Format::text) + " is hardly determined";
    list.push_back({std::string(kPassesNearSingular) +
                        " at t = " + number_text(to_double(course.smallest_sigma_time()), 6) + ": " + what,
                    "trust what follows less; write the constraint or the coordinates so that they are regular there"});
  }
  for (std::size_t i = 0; i < model.monitors.size(); ++i)
    if (const double change = watch.tracks()[i].relative_change();
        declared_conserved(model, model.monitors[i]) && !(change <= kConserved))
      list.push_back(not_conserved(model.monitors[i].name, change));
  for (std::size_t i = 0; i < angles.triples.size(); ++i)
    if (angles.least[i].value < kNearSingular)
      list.push_back(
          {"the angles " + angles.triples[i].angles +
               " come near their singularity at t = " + number_text(angles.least[i].t, 6),
           "describe the orientation of '" + angles.triples[i].body + "' by a quaternion: quat(e0, e1, e2, e3)"});
  return list;
}

}  // namespace anholon
