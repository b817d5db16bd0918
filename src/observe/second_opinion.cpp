#include "observe/second_opinion.h"

#include <chrono>

#include "numeric/told_time.h"

namespace anholon {

namespace {

// Converts the state and the leading derivatives of one program to those of another for the same unknowns. Returns
// false if that needs higher derivatives.
bool translate(const Program& from, const std::vector<double>& state, const std::vector<double>& leading,
               const Program& to, std::vector<long double>& to_state, std::vector<long double>& to_leading) {
  std::size_t offset = 0;
  for (std::size_t j = 0; j < to.unknowns(); ++j) {
    const int known = from.d[j];
    if (to.d[j] > known + 1) return false;
    const auto value = [&](int k) -> long double {
      return k < known ? state[offset + static_cast<std::size_t>(k)] : k == known ? leading[j] : 0;
    };
    for (int k = 0; k < to.d[j]; ++k) to_state.push_back(value(k));
    to_leading.push_back(value(to.d[j]));
    offset += static_cast<std::size_t>(known);
  }
  return true;
}

}  // namespace

SecondMotion::SecondMotion(Workspace& scenario, const StateChoice& choice, Expr power, const SundialsSettings& settings,
                           long double end)
    : model_(*scenario.model) {
  report_.integrator = settings.integrator;
  report_.of = model_.coordinates[0].name;
  report_.t = scenario.state.t;
  start_ = start(scenario, choice, power, settings, end);
}

Outcome SecondMotion::start(Workspace& scenario, const StateChoice& choice, Expr power,
                            const SundialsSettings& settings, long double end) {
  Workspace* s = &scenario;
  if (scenario.system.form->eliminates()) {
    Scenario routh;
    if (Outcome o = make_scenario(scenario.model, *find_formulation("routh"), choice, routh); !o.ok()) return o;
    routh_ = std::make_unique<Workspace>(routh);
    s = routh_.get();
    power = s->graph().own(power);
  }
  report_.form = s->system.form->name;
  Start<double> at;
  if (Outcome o = initial_state(*s, choice, at); !o.ok()) return o;
  program_ = std::make_unique<Program>(program(s->system, s->structure, {&power, 1}));
  motion_ = std::make_unique<Sundials>(*program_, parameter_values<double>(model_), settings, at.t,
                                       convert<double>(end), at.state, at.leading, std::vector<double>{});
  return {};
}

Outcome SecondMotion::at(long double t, const Expansion<long double>& taylor) {
  if (!start_.ok()) return start_;
  const auto begin = std::chrono::steady_clock::now();
  const Outcome there = motion_->advance(convert<double>(t));
  report_.seconds += std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  report_.steps = motion_->steps();
  report_.evaluations = motion_->evaluations();
  if (!there.ok()) return there;
  work_ = motion_->integrals().at(0);
  Outcome o = put(t, taylor);
  tell_time(o, convert<double>(t));
  return o;
}

Outcome SecondMotion::put(long double t, const Expansion<long double>& taylor) {
  std::vector<long double> state, leading;
  if (!translate(*program_, motion_->state(), motion_->leading(), taylor.program(), state, leading))
    return {OutcomeKind::inconsistent, "the form asks for derivatives that are no part of the second motion",
            "--form routh"};
  point_ = taylor;  // of the form that is written, with its present elimination
  point_->load(t, state, leading);
  if (Outcome o = point_->prepare(); !o.ok()) return o;
  point_->measure();
  if (Outcome o = point_->solve(); !o.ok()) return o;
  report_.drift = std::max(report_.drift, to_double(point_->constraint_residual()));
  for (std::size_t a = 0; a < model_.coordinates.size(); ++a) {
    const long double x = taylor.derivative(a, 0);
    const double difference = to_double(abs(point_->derivative(a, 0) - x) / (1 + abs(x)));
    if (!(difference > report_.difference)) continue;
    report_.difference = difference;
    report_.of = model_.coordinates[a].name;
    report_.t = convert<double>(t);
  }
  return taylor.stages() > 0 ? point_->extend() : Outcome{};
}

}  // namespace anholon
