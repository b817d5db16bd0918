// The time of one Taylor expansion, for systems of several shapes and by every backend: the interpreted tape, the
// kernel's tables in every tier of this machine with one lane and with all lanes, and machine code. With several lanes
// it is the time of all of them. Also the cost of machine code: compiled anew, and found on disk.
#include <filesystem>
#include <map>
#include <set>

#include <benchmark/benchmark.h>
#include <unistd.h>

#include "base/read_file.h"
#include "kernel/kernel.h"
#include "simulation/simulate.h"

namespace {

using namespace anholon;

constexpr int kStages = 20;

struct Shape {
  const char *model, *count;  // of links or trailers
  std::string name() const { return std::string(model) + (*count ? "-" : "") + count; }
};
// A single knife edge; a rolling body; trailers with a constraint each; chains without constraints whose links are all
// coupled.
constexpr Shape kShapes[] = {{"sleigh", ""},     {"disc", ""},   {"trailers", "3"},
                             {"trailers", "10"}, {"chain", "4"}, {"chain", "16"}};

struct Subject {
  explicit Subject(const Shape& shape) {
    SourceText source{std::string(ANHOLON_SOURCE_DIR) + "/bench/models/" + shape.model + ".toml", {}};
    if (!read_file(source.name, source.text)) std::abort();
    Diagnostics diagnostics;
    const auto model = std::make_shared<const Model>(
        *read_model(source, diagnostics, *shape.count ? Overrides{{"n", shape.count}} : Overrides{}));
    Start<long double> start;
    if (!make_scenario(model, *find_formulation("routh"), {}, scenario).ok() ||
        !initial_state(scenario, {}, start).ok())
      std::abort();
    stepping = std::make_shared<const Program>(program(scenario.system, scenario.structure));
    parameters = parameter_values<long double>(*model);
    t = static_cast<double>(start.t);
    state.assign(start.state.begin(), start.state.end());
    leading.assign(start.leading.begin(), start.leading.end());
  }
  std::shared_ptr<const KernelPlan> plan() const { return KernelPlan::make(stepping, kStages, parameters, t, state); }

  Scenario scenario;
  std::shared_ptr<const Program> stepping;
  std::vector<long double> parameters;
  std::vector<double> state, leading;
  double t = 0;
};

// Returns the system of this shape, which is derived only once for all its measurements.
const Subject& subject(const Shape& shape) {
  static std::map<std::string, Subject> all;
  return all.try_emplace(shape.name(), shape).first->second;
}

void interpreted(benchmark::State& clock, const Shape& shape) {
  const Subject& s = subject(shape);
  Expansion<double> expansion(*s.stepping, {s.parameters.begin(), s.parameters.end()}, kStages);
  for (auto _ : clock) {
    expansion.load(s.t, s.state, s.leading);
    if (!expansion.prepare().ok() || !expansion.solve().ok() || !expansion.extend().ok())
      clock.SkipWithError("no expansion");
  }
}

void expand(benchmark::State& clock, const Subject& s, const std::shared_ptr<const KernelPlan>& plan, int lanes,
            const Tier* tier) {
  Kernel kernel(plan, lanes, tier);
  for (int lane = 0; lane < lanes; ++lane) kernel.set_parameters(lane, s.parameters);
  for (auto _ : clock) {
    for (int lane = 0; lane < lanes; ++lane) kernel.load(lane, s.t, s.state, s.leading);
    kernel.expand();
    benchmark::DoNotOptimize(kernel.coefficient(0, kStages));
  }
}

void compiled(benchmark::State& clock, const Shape& shape) {
  const auto plan = subject(shape).plan();
  if (const std::string why = plan->compile({}); !why.empty()) return clock.SkipWithError(why.c_str());
  expand(clock, subject(shape), plan, 1, nullptr);
}

void compile(benchmark::State& clock, const Shape& shape, bool kept) {
  const std::filesystem::path folder =
      std::filesystem::temp_directory_path() / ("anholon-kernel-bench-" + std::to_string(getpid()));
  const std::string cache = kept ? folder.string() : std::string();
  if (const std::string why = subject(shape).plan()->compile(cache); !why.empty())
    return clock.SkipWithError(why.c_str());
  for (auto _ : clock) {
    clock.PauseTiming();
    const auto plan = subject(shape).plan();
    clock.ResumeTiming();
    plan->compile(cache);
  }
  std::filesystem::remove_all(folder);
}

const bool registered = [] {
  for (const Shape& shape : kShapes) {
    const auto add = [&shape](const std::string& backend, auto function) {
      return benchmark::RegisterBenchmark(("kernel/" + shape.name() + "/" + backend).c_str(),
                                          [=](benchmark::State& s) { function(s, shape); });
    };
    add("interpreted", interpreted)->Unit(benchmark::kMicrosecond);
    for (const Tier& tier : tiers())
      for (int lanes : std::set<int>{1, tier.lanes})
        add(std::string(tier.name) + "/" + std::to_string(lanes), [&tier, lanes](benchmark::State& s, const Shape& of) {
          expand(s, subject(of), subject(of).plan(), lanes, &tier);
        })->Unit(benchmark::kMicrosecond);
    add("compiled", compiled)->Unit(benchmark::kMicrosecond);
    add("make", [](benchmark::State& s, const Shape& of) { compile(s, of, false); })->Unit(benchmark::kMillisecond);
    add("find", [](benchmark::State& s, const Shape& of) { compile(s, of, true); })->Unit(benchmark::kMillisecond);
  }
  return true;
}();

}  // namespace
