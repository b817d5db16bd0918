#include "run/second_opinion.h"

#include <chrono>

#include "run/scenario.h"

namespace anholon {

namespace {

std::vector<double> narrow(const std::vector<long double>& wide) {
  std::vector<double> out;
  for (long double x : wide) out.push_back(convert<double>(x));
  return out;
}

std::vector<long double> widen(const std::vector<double>& x) { return {x.begin(), x.end()}; }

}  // namespace

SecondMotion::SecondMotion(const Model& model, const Program& program, const SundialsSettings& settings, long double t, long double end,
                           const std::vector<long double>& state, const std::vector<long double>& leading)
    : model_(model), parameters_(parameter_values<double>(model)), settings_(settings), end_(convert<double>(end)) {
  report_.integrator = settings.integrator;
  report_.of = model.coordinates[0].name;
  report_.t = convert<double>(t);
  motion_ = std::make_unique<Sundials>(program, parameters_, settings_, report_.t, end_, narrow(state), narrow(leading), std::vector<double>{});
}

Outcome SecondMotion::advance(double t) {
  const auto start = std::chrono::steady_clock::now();
  Outcome o = changeover_.ok() ? motion_->advance(t) : changeover_;
  report_.seconds += std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  report_.steps = steps_before_ + motion_->steps();
  report_.evaluations = evaluations_before_ + motion_->evaluations();
  return o;
}

void SecondMotion::go_on_with(const Program& program, long double t) {
  changeover_ = advance(convert<double>(t));
  steps_before_ = report_.steps;
  evaluations_before_ = report_.evaluations;
  motion_ = std::make_unique<Sundials>(program, parameters_, settings_, motion_->time(), end_, std::vector<double>(motion_->state()),
                                       std::vector<double>(motion_->leading()), std::vector<double>(motion_->integrals()));
}

Outcome SecondMotion::at(long double t, Expansion<long double>& point) {
  if (Outcome o = advance(convert<double>(t)); !o.ok()) return o;
  std::vector<long double> taylor;
  for (std::size_t a = 0; a < model_.coordinates.size(); ++a) taylor.push_back(point.derivative(a, 0));
  const std::vector<long double> state = widen(motion_->state()), leading = widen(motion_->leading());
  point.load(t, state, leading);
  if (Outcome o = point.prepare(); !o.ok()) return o;
  // What a projection would have to correct is the drift; the state itself stays as it was integrated.
  if (Outcome o = point.project(); !o.ok()) return o;
  report_.drift = std::max(report_.drift, to_double(point.constraint_residual()));
  point.load(t, state, leading);
  point.evaluate();
  for (std::size_t a = 0; a < taylor.size(); ++a) {
    const double difference = to_double((abs(point.derivative(a, 0) - taylor[a])) / (1 + abs(taylor[a])));
    if (!(difference > report_.difference)) continue;
    report_.difference = difference;
    report_.of = model_.coordinates[a].name;
    report_.t = convert<double>(t);
  }
  return point.solve();
}

}  // namespace anholon
