// Measures one model for the speed table (bench/speed.py): makes the model ready, then answers the commands on the
// standard input, which integrate it to the end of its [simulate]. Each answer is a line of JSON.
//
//   speed_bench MODEL [--set NAME=VALUE]... [--form NAME]     answers with the times of making ready
//   start                          positions and velocities at the start, coordinate by coordinate, in 36 digits
//   exact DIGITS                   positions and velocities at the end, right in so many digits
//   run TOLERANCE SECONDS [STEPS]  as many motions as fit the time, at least one; STEPS: the most steps of each
//   lanes NAME                     neighbours, one for each lane of a kernel, which begin with a shifted coordinate
//                                  NAME: their starts, and the ends of their motions in long double
//   batch TOLERANCE SECONDS NAME   all neighbours side by side in one kernel, as often as fits the time
//
//   speed_bench --peak             the speed of the core in GF/s, without a model
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <deque>
#include <fstream>
#include <iostream>
#include <map>
#include <sstream>

#include "base/json.h"
#include "base/read_file.h"
#include "fma_peak.h"
#include "integrate/lanes/ordinary_steps.h"
#include "integrate/stretch.h"
#include "kernel/arithmetic.h"
#include "motion/form_choice.h"
#include "motion/representation.h"
#include "simulation/simulate.h"
#include "stopwatch.h"

namespace {

using namespace anholon;
struct Failed {
  std::string why;
};

void must(const Outcome& o) {
  if (!o.ok()) throw Failed{std::string(name(o.kind)) + ": " + o.message};
}

struct Request {
  std::string model, form = "auto";
  Overrides set;
};

struct Ready {
  Scenario scenario;
  std::unique_ptr<Program> stepping;
  // By tolerance, and for one motion alone or for lanes.
  std::map<std::pair<double, Company>, std::shared_ptr<const KernelPlan>> plans;
  double read = 0, scenario_made = 0, program_made = 0;  // seconds
  double plan_made = 0, compiled = 0;                    // of the last of the plans
};

std::unique_ptr<Ready> make_ready(const Request& request) {
  auto r = std::make_unique<Ready>();
  Stopwatch watch;
  const auto lap = [&watch] {
    const double s = watch.seconds();
    watch = {};
    return s;
  };
  SourceText source{request.model, {}};
  if (std::string why; !read_file(request.model, source.text, &why)) throw Failed{request.model + ": " + why};
  Diagnostics diagnostics;
  std::optional<Model> m = read_model(source, diagnostics, request.set);
  if (!m) throw Failed{diagnostics.print(source)};
  auto model = std::make_shared<const Model>(std::move(*m));
  r->read = lap();
  const Formulation* form = request.form == "auto" ? choose_form(model, {}).form : find_formulation(request.form);
  if (!form) throw Failed{"no form " + request.form};
  must(make_scenario(model, *form, {}, r->scenario));
  r->scenario_made = lap();
  r->stepping = std::make_unique<Program>(program(r->scenario.system, r->scenario.structure));
  r->program_made = lap();
  if (!model->simulate.to) throw Failed{"the model has no [simulate] to"};
  return r;
}

template <Number N>
std::vector<N> positions_and_velocities(const Ready& ready, const Expansion<N>& point) {
  std::vector<N> values;
  for (std::size_t j = 0; j < ready.scenario.system.coordinates; ++j)
    for (int k = 0; k < 2; ++k) values.push_back(point.derivative(j, k));
  return values;
}

// Makes or finds the kernel plan of a motion that is long enough to pay for the most expensive writing and for machine
// code.
const std::shared_ptr<const KernelPlan>& plan_of(Ready& r, double tolerance, const Start<long double>& start,
                                                 Company company = Company::alone) {
  auto& plan = r.plans[{tolerance, company}];
  if (plan) return plan;
  Stopwatch watch;
  const std::vector<long double> parameters = parameter_values<long double>(*r.scenario.model);
  const std::vector<double> state(start.state.begin(), start.state.end());
  const double t = static_cast<double>(start.t);
  const auto derived = KernelPlan::make(std::make_shared<const Program>(*r.stepping),
                                        taylor_order(std::log(tolerance)) - 1, parameters, t, state, company);
  if (!derived) return plan;
  plan = cheapest(representations({derived, r.scenario.structure, {}, parameters, t, state, r.scenario.mechanics.get()},
                                  WritingEffort::very_long_motion))
             .plan;
  r.plan_made = watch.seconds();
  watch = {};
  if (const std::string why = plan->compile({}); !why.empty()) std::cerr << why << "\n";
  r.compiled = watch.seconds();
  return plan;
}

// Makes and drives a stepper. The motion in a form without multipliers fails where its elimination ends: only
// motion/motion chooses another elimination on the way.
template <Number N>
struct Trajectory {
  using W = Wider<N>;
  Trajectory(const Ready& ready_, const StepSettings& settings)
      : ready(&ready_), wide(parameter_values<W>(*ready_.scenario.model)),
        stepper(*ready_.stepping, parameter_values<N>(*ready_.scenario.model), wide, settings) {}
  void go(const Start<W>& start, const W& end, std::size_t most_steps) {
    must(stepper.start(start.t, start.state, start.leading));
    // Stretches of as many steps as `simulate` asks for at once.
    for (Stretch<W> stretch; !(stepper.time() == end) && stepper.steps() < most_steps;) {
      stretch.restart();
      stretch.most = std::min<std::size_t>(64, most_steps - stepper.steps());
      must(stepper.steps(end, stretch));
    }
  }
  std::vector<W> last() const {
    Expansion<W> point(*ready->stepping, wide, 1);
    must(stepper.at(stepper.time(), point));
    return positions_and_velocities<W>(*ready, point);
  }
  const Ready* ready;
  std::vector<W> wide;
  Stepper<N> stepper;
};

constexpr std::size_t kMostSteps = 50'000'000;

template <class Values>
void write_values(JsonWriter& json, const Values& values, int digits = 0) {
  for (const auto& x : values) json.string(number_text(x, digits));
}
template <class Values>
void write_state(JsonWriter& json, const Values& values, int digits = 0) {
  json.key("state").open_array();
  write_values(json, values, digits);
  json.close();
}

void write(JsonWriter& json, const char* key, double x) { json.key(key).number(number_text(x)); }

// Returns the peak memory of the process in MiB.
double megabytes() {
  std::ifstream status("/proc/self/status");
  for (std::string word; status >> word;)
    if (word == "VmHWM:" && status >> word) return std::stod(word) / 1024;
  return 0;
}

void answer_ready(const Ready& r, JsonWriter& json) {
  const ProgramSize n = size(*r.stepping);
  write(json, "read", r.read);
  write(json, "scenario", r.scenario_made);
  write(json, "program", r.program_made);
  write(json, "megabytes", megabytes());
  write(json, "end", r.scenario.model->simulate.to->get_d());
  json.key("unknowns").integer(static_cast<long long>(r.stepping->unknowns()));
  json.key("coordinates").integer(static_cast<long long>(r.scenario.system.coordinates));
  json.key("form").string(r.scenario.system.form->name);
  json.key("slots").integer(static_cast<long long>(n.slots));
  json.key("products").integer(static_cast<long long>(n.products));
  json.key("linear").integer(static_cast<long long>(n.linear));
  json.key("functions").integer(static_cast<long long>(n.functions));
}

void answer_start(const Ready& r, JsonWriter& json) {
  const PrecisionScope precision(40);
  Start<Multi> start;
  must(initial_state(r.scenario, {}, start));
  Trajectory<Multi> motion(r, {-30 * std::log(10.0), 0, kMostSteps, {}});
  must(motion.stepper.start(start.t, start.state, start.leading));
  write_state(json, positions_and_velocities<Multi>(r, motion.stepper.point()), 36);
}

void answer_exact(const Ready& r, int digits, JsonWriter& json) {
  const PrecisionScope precision(digits + 10);
  const Stopwatch watch;
  Start<Multi> start;
  must(initial_state(r.scenario, {}, start));
  Trajectory<Multi> motion(r, {-digits * std::log(10.0), 0, kMostSteps, {}});
  motion.go(start, from_rational<Multi>(*r.scenario.model->simulate.to), kMostSteps);
  write_state(json, motion.last(), digits);
  write(json, "seconds", watch.seconds());
}

void answer_run(Ready& r, double tolerance, double seconds, std::size_t most_steps, JsonWriter& json) {
  using W = Wider<double>;
  Start<W> start;
  must(initial_state(r.scenario, {}, start));
  const W end = from_rational<W>(*r.scenario.model->simulate.to);
  const auto plan = plan_of(r, tolerance, start);
  std::vector<double> times;
  const auto motion =
      std::make_unique<Trajectory<double>>(r, StepSettings{std::log(tolerance), 0, kMostSteps, {}, true, false});
  motion->stepper.accelerate(plan);
  for (const Stopwatch all; times.empty() || all.wall_seconds() < seconds;) {
    const Stopwatch watch;
    motion->go(start, end, most_steps);
    times.push_back(watch.seconds());
  }
  write(json, "us", 1e6 * median(times));
  write(json, "plan", r.plan_made);
  write(json, "compile", r.compiled);
  if (plan) write(json, "work", plan->work());
  json.key("by_kernel").integer(static_cast<long long>(motion->stepper.expansions_by_kernel()));
  json.key("runs").integer(static_cast<long long>(times.size()));
  json.key("steps").integer(static_cast<long long>(motion->stepper.steps()));
  json.key("order").integer(motion->stepper.order());
  write(json, "megabytes", megabytes());
  write_state(json, motion->last());
}

// Returns the starts of motions in which one coordinate begins 1/64 further from lane to lane. The other initial data
// of the file stay, and the constraints are satisfied.
template <class W>
std::vector<Start<W>> neighbours(const Ready& r, const std::string& name) {
  const Scenario& s = r.scenario;
  const auto& q = s.model->coordinates;
  const auto found = std::find_if(q.begin(), q.end(), [&](const Coordinate& c) { return c.name == name; });
  if (found == q.end()) throw Failed{"no coordinate " + name};
  const auto j = static_cast<std::size_t>(found - q.begin());
  const double* const from = s.state.value(s.system.symbol_node(j, 0));
  std::vector<Start<W>> starts(static_cast<std::size_t>(tiers().back().lanes));
  for (std::size_t lane = 0; lane < starts.size(); ++lane)
    must(initial_state(s, {{{0, j, Rational(*from) + Rational(static_cast<long>(lane), 64)}}, {}, {}, {}},
                       starts[lane]));
  return starts;
}

void answer_lanes(const Ready& r, const std::string& name, JsonWriter& json) {
  using N = long double;
  using W = Wider<N>;
  const auto starts = neighbours<W>(r, name);
  const W end = from_rational<W>(*r.scenario.model->simulate.to);
  Trajectory<N> motion(r, {-18 * std::log(10.0), 0, kMostSteps, {}});
  std::vector<W> last;
  json.key("starts").open_array();
  for (const Start<W>& start : starts) {
    must(motion.stepper.start(start.t, start.state, start.leading));
    json.open_array();
    write_values(json, positions_and_velocities<W>(r, motion.stepper.point()));
    json.close();
    motion.go(start, end, kMostSteps);
    for (const W& x : motion.last()) last.push_back(x);
  }
  json.close();
  write_state(json, last);
}

// Takes the motions in the lanes of one kernel to the end, as a sweep does: ordinary steps are made for all lanes at once.
// A motion that has arrived waits for the others. `last`: filled with where they have arrived, if given.
void go_side_by_side(Kernel& kernel, OrdinarySteps& ordinary, std::deque<Trajectory<double>>& motions,
                     const std::vector<Start<Wider<double>>>& starts, const Wider<double>& end,
                     std::vector<std::vector<Wider<double>>>* last = nullptr) {
  for (std::size_t i = 0; i < motions.size(); ++i)
    motions[i].stepper.place(starts[i].t, starts[i].state, starts[i].leading);
  const auto all = [&](const auto& part) {
    bool any = false;
    for (Trajectory<double>& m : motions)
      if (!(m.stepper.time() == end)) {
        if (!part(m.stepper)) must(m.stepper.trouble());
        any = true;
      }
    return any;
  };
  while (all([](Stepper<double>& s) { return s.begin_step(); })) {
    kernel.begin();
    std::vector<OrdinarySteps::Motion> walking;
    for (Trajectory<double>& m : motions)
      if (Stepper<double>& s = m.stepper; s.time() == end)
        walking.emplace_back();
      else
        walking.push_back({&s, end, end});
    bool aimed = ordinary.run(walking);
    if (!aimed) all([&](Stepper<double>& s) { return s.aim(end); });
    for (bool again = true; again; aimed = false) {
      if (!aimed) {
        kernel.advance();
        kernel.start_next();
      }
      again = false;
      all([&](Stepper<double>& s) {
        const EndOfStep there = s.look_at_end(end);
        again = again || there == EndOfStep::elsewhere;
        return there != EndOfStep::failed;
      });
    }
    all([](Stepper<double>& s) {
      const bool good = s.finish_step();
      if (s.arrived()) s.leave_kernel();
      return good;
    });
    if (!last) continue;
    last->resize(motions.size());
    for (std::size_t i = 0; i < motions.size(); ++i)
      if ((*last)[i].empty() && motions[i].stepper.time() == end) (*last)[i] = motions[i].last();
  }
}

void answer_batch(Ready& r, double tolerance, double seconds, const std::string& name, JsonWriter& json) {
  using W = Wider<double>;
  const auto starts = neighbours<W>(r, name);
  const W end = from_rational<W>(*r.scenario.model->simulate.to);
  const auto plan = plan_of(r, tolerance, starts[0], Company::in_lanes);
  if (!plan) throw Failed{"no kernel for this model"};
  const Stopwatch compiling;
  plan->compile({}, static_cast<int>(starts.size()));
  write(json, "compile", compiling.seconds());
  const auto kernel = std::make_shared<Kernel>(plan, static_cast<int>(starts.size()));
  const StepSettings settings{std::log(tolerance), 0, kMostSteps, {}, true, false};
  std::deque<Trajectory<double>> motions;
  for (int lane = 0; lane < kernel->lanes(); ++lane) {
    Trajectory<double>& m = motions.emplace_back(r, settings);
    kernel->set_parameters(lane, m.wide);
    m.stepper.accelerate(kernel, lane);
  }
  OrdinarySteps ordinary(kernel, settings);
  std::vector<double> times;
  for (const Stopwatch all; times.empty() || all.wall_seconds() < seconds;) {
    const Stopwatch watch;
    go_side_by_side(*kernel, ordinary, motions, starts, end);
    times.push_back(watch.seconds());
  }
  std::vector<std::vector<W>> arrived;
  go_side_by_side(*kernel, ordinary, motions, starts, end, &arrived);
  // Repeats the same motions, each alone.
  Trajectory<double> alone(r, settings);
  alone.stepper.accelerate(plan);
  std::vector<W> last;
  std::size_t steps = 0, by_kernel = 0;
  double apart = 0;
  for (std::size_t lane = 0; lane < motions.size(); ++lane) {
    alone.go(starts[lane], end, kMostSteps);
    const std::vector<W>& here = arrived[lane];
    const std::vector<W> there = alone.last();
    for (std::size_t i = 0; i < here.size(); ++i)
      apart = std::max(apart, to_double(abs(here[i] - there[i]) / (W(1) + abs(there[i]))));
    last.insert(last.end(), here.begin(), here.end());
    steps += motions[lane].stepper.steps();
    by_kernel += motions[lane].stepper.expansions_by_kernel();
  }
  const double lanes = kernel->lanes(), us = 1e6 * median(times);
  write(json, "us", us / lanes);  // this and the numbers of steps and expansions: of one trajectory
  write(json, "us_step", us / static_cast<double>(steps));
  write(json, "steps", static_cast<double>(steps) / lanes);
  write(json, "by_kernel", static_cast<double>(by_kernel) / lanes);
  write(json, "work", plan->work());
  write(json, "apart", apart);
  json.key("code").boolean(plan->code(kernel->lanes()) != nullptr);
  json.key("lanes").integer(kernel->lanes());
  json.key("runs").integer(static_cast<long long>(times.size()));
  json.key("order").integer(alone.stepper.order());
  write_state(json, last);
}

void print(JsonWriter& json) {
  json.close();
  std::string line = json.text();
  line.erase(std::remove(line.begin(), line.end(), '\n'), line.end());
  std::printf("%s\n", line.c_str());
  std::fflush(stdout);
}

void serve(Ready& ready, const std::string& line) {
  std::istringstream words(line);
  std::string command;
  words >> command;
  JsonWriter json;
  json.open_object();
  try {
    if (command == "start") {
      answer_start(ready, json);
    } else if (int digits = 0; command == "exact" && words >> digits) {
      answer_exact(ready, digits, json);
    } else if (double tolerance = 0, seconds = 0; command == "run" && words >> tolerance >> seconds) {
      std::size_t most_steps = kMostSteps;
      words >> most_steps;
      answer_run(ready, tolerance, seconds, words ? most_steps : kMostSteps, json);
    } else if (std::string name; command == "lanes" && words >> name) {
      answer_lanes(ready, name, json);
    } else if (command == "batch" && words >> tolerance >> seconds >> name) {
      answer_batch(ready, tolerance, seconds, name, json);
    } else {
      throw Failed{"unknown request: " + line};
    }
  } catch (const Failed& f) {
    json = {};
    json.open_object().key("failed").string(f.why);
  }
  print(json);
}

Request request_of(const std::vector<std::string>& words) {
  Request request;
  for (std::size_t i = 0; i < words.size(); ++i) {
    const bool more = i + 1 < words.size();
    if (words[i] == "--form" && more) {
      request.form = words[++i];
    } else if (words[i] == "--set" && more) {
      const std::string& s = words[++i];
      const std::size_t equals = std::min(s.find('='), s.size() - 1);
      request.set[s.substr(0, equals)] = s.substr(equals + 1);
    } else {
      request.model = words[i];
    }
  }
  return request;
}

void answer_peak() {
  JsonWriter json;
  json.open_object();
  for (const Peak& p : fma_peaks()) write(json, p.name, p.gigaflops);
  print(json);
}

}  // namespace

int main(int argc, char** argv) {
  const std::vector<std::string> words(argv + 1, argv + argc);
  if (words == std::vector<std::string>{"--peak"}) {
    answer_peak();
    return 0;
  }
  try {
    const std::unique_ptr<Ready> ready = make_ready(request_of(words));
    JsonWriter json;
    json.open_object();
    answer_ready(*ready, json);
    print(json);
    for (std::string line; std::getline(std::cin, line);) serve(*ready, line);
  } catch (const Failed& f) {
    std::fprintf(stderr, "speed_bench: %s\n", f.why.c_str());
    return 1;
  }
  return 0;
}
