// The time of one motion by Taylor's series and by SUNDIALS, inside one process: the same program of the same model,
// with the same start and end, without rows. The error compares the coordinates and velocities at the end with a motion
// in 30 digits.
#include <cmath>
#include <map>

#include <benchmark/benchmark.h>

#include "integrate/step_control.h"
#include "integrate/stretch.h"
#include "kernel/kernel.h"
#include "simulation/simulate.h"
#include "support/models.h"

namespace {

using namespace anholon;

struct Task {
  explicit Task(const std::string& model) {
    const Outcome o = make_scenario(test::shipped(model), *find_formulation("routh"), {}, scenario);
    if (!o.ok()) throw std::runtime_error(model + ": " + o.message);
    stepping = std::make_unique<Program>(program(scenario.system, scenario.structure));
    end = *scenario.model->simulate.to;
    const PrecisionScope precision(40);
    Start<Multi> start;
    if (!initial_state(scenario, {}, start).ok()) throw std::runtime_error(model + ": no start");
    const std::vector<Multi> parameters = parameter_values<Multi>(*scenario.model);
    Stepper<Multi> taylor(*stepping, parameters, parameters, {-30 * std::log(10.0), 0, 50'000'000, {}});
    if (!taylor.start(start.t, start.state, start.leading).ok()) throw std::runtime_error(model + ": no start");
    const Multi last = from_rational<Multi>(end);
    while (!(taylor.time() == last))
      if (const Outcome o2 = taylor.step(last); !o2.ok()) throw std::runtime_error(model + ": " + o2.message);
    Expansion<Multi> point(*stepping, parameters, 1);
    if (!taylor.at(last, point).ok()) throw std::runtime_error(model + ": no end");
    std::vector<Multi> state;
    point.state(state);
    for (const Multi& x : state) exact.push_back(to_double(x));
  }
  template <class State>
  double error(const State& state) const {
    double worst = 0;
    for (std::size_t j = 0; j < scenario.system.coordinates; ++j)
      for (int k = 0, at = offset(j); k < stepping->d[j]; ++k, ++at) {
        const double x = exact[static_cast<std::size_t>(at)];
        worst =
            std::max(worst, std::abs(static_cast<double>(state[static_cast<std::size_t>(at)]) - x) / (1 + std::abs(x)));
      }
    return worst;
  }
  int offset(std::size_t j) const {
    int at = 0;
    for (std::size_t i = 0; i < j; ++i) at += stepping->d[i];
    return at;
  }

  Scenario scenario;
  std::unique_ptr<Program> stepping;
  Rational end;
  std::vector<double> exact;
};

const Task& task(const std::string& model) {
  static std::map<std::string, std::unique_ptr<Task>> all;
  std::unique_ptr<Task>& t = all[model];
  if (!t) t = std::make_unique<Task>(model);
  return *t;
}

void count(benchmark::State& state, double error, std::size_t steps) {
  state.counters["error"] = error;
  state.counters["steps"] = static_cast<double>(steps);
}

// The kernel of these equations with machine code, or nullptr if they have none.
std::shared_ptr<const KernelPlan> kernel(const Task& t, const Start<long double>& start, double tolerance) {
  auto plan = KernelPlan::make(std::make_shared<const Program>(*t.stepping), taylor_order(std::log(tolerance)) - 1,
                               parameter_values<long double>(*t.scenario.model), static_cast<double>(start.t),
                               {start.state.begin(), start.state.end()}, Company::alone);
  if (plan) plan->compile({});
  return plan;
}

void by_taylor(benchmark::State& state, const std::string& model, double tolerance) {
  const Task& t = task(model);
  Start<long double> start;
  initial_state(t.scenario, {}, start);
  const std::vector<double> parameters = parameter_values<double>(*t.scenario.model);
  const std::vector<long double> wide = parameter_values<long double>(*t.scenario.model);
  const long double end = from_rational<long double>(t.end);
  const auto plan = kernel(t, start, tolerance);
  for (auto _ : state) {
    Stepper<double> taylor(*t.stepping, parameters, wide, {std::log(tolerance), 0, 50'000'000, {}});
    if (plan) taylor.accelerate(plan);
    Outcome o = taylor.start(start.t, start.state, start.leading);
    for (Stretch<long double> stretch{64}; o.ok() && taylor.time() != end; stretch.restart())
      o = taylor.steps(end, stretch);
    Expansion<long double> point(*t.stepping, wide, 1);
    if (o.ok()) o = taylor.at(end, point);
    if (!o.ok()) return state.SkipWithError(o.message.c_str());
    std::vector<long double> last;
    point.state(last);
    count(state, t.error(last), taylor.steps());
  }
}

void by_sundials(benchmark::State& state, const std::string& model, double tolerance, Method integrator) {
  const Task& t = task(model);
  Start<double> start;
  initial_state(t.scenario, {}, start);
  const std::vector<double> parameters = parameter_values<double>(*t.scenario.model);
  for (auto _ : state) {
    Sundials other(*t.stepping, parameters, {integrator, tolerance, 50'000'000, {}}, start.t, t.end.get_d(),
                   start.state, start.leading, {});
    if (const Outcome o = other.advance(t.end.get_d()); !o.ok()) return state.SkipWithError(o.message.c_str());
    count(state, t.error(other.state()), other.steps());
  }
}

const bool registered = [] {
  for (const std::string model :
       {"zoo/chaplygin-sleigh", "zoo/disc", "zoo/snakeboard", "zoo/car-three-trailers", "zoo/double-pendulum-cartesian",
        "zoo/fourbar", "zoo/constant-acceleration", "papers/luo-zhao-example-2"})
    for (int digits = 3; digits <= 14; ++digits) {
      const double tolerance = std::pow(10.0, -digits);
      const auto title = [&](const std::string& how) {
        return "opinion/" + how + "/1e-" + std::to_string(digits) + "/" + model;
      };
      benchmark::RegisterBenchmark(title("taylor").c_str(), by_taylor, model, tolerance)->Unit(benchmark::kMicrosecond);
      for (const Method k : {Method::cvode, Method::ida})
        benchmark::RegisterBenchmark(title(name(k)).c_str(), by_sundials, model, tolerance, k)
            ->Unit(benchmark::kMicrosecond);
    }
  return true;
}();

}  // namespace
