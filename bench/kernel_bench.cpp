// One Taylor expansion of the systems of the speed table, by every backend: the interpreted tape, the kernel's tables with one lane and with
// all, machine code. For lanes the time is of all of them. And what machine code costs: made anew, and found on disk.
#include <benchmark/benchmark.h>

#include <filesystem>
#include <map>

#include <unistd.h>

#include "base/read_file.h"
#include "kernel/kernel.h"
#include "run/simulate.h"

namespace {

using namespace anholon;

constexpr int kStages = 20;

struct Subject {
  explicit Subject(const std::string& name) {
    SourceText source{std::string(ANHOLON_SOURCE_DIR) + "/bench/models/" + name + ".toml", {}};
    if (!read_file(source.name, source.text)) std::abort();
    Diagnostics diagnostics;
    const auto model = std::make_shared<const Model>(*read_model(source, diagnostics));
    Start<long double> start;
    if (!make_scenario(model, *find_formulation("routh"), {}, scenario).ok() || !initial_state(scenario, {}, start).ok()) std::abort();
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

// Derived once, however often the clock starts anew.
const Subject& subject(const std::string& name) {
  static std::map<std::string, Subject> all;
  return all.try_emplace(name, name).first->second;
}

void interpreted(benchmark::State& clock, const std::string& name) {
  const Subject& s = subject(name);
  Expansion<double> expansion(*s.stepping, {s.parameters.begin(), s.parameters.end()}, kStages);
  for (auto _ : clock) {
    expansion.load(s.t, s.state, s.leading);
    if (!expansion.prepare().ok() || !expansion.solve().ok() || !expansion.extend().ok()) clock.SkipWithError("no expansion");
  }
}

void expand(benchmark::State& clock, const Subject& s, const std::shared_ptr<const KernelPlan>& plan, int lanes) {
  Kernel kernel(plan, lanes);
  for (int lane = 0; lane < lanes; ++lane) kernel.set_parameters(lane, s.parameters);
  for (auto _ : clock) {
    for (int lane = 0; lane < lanes; ++lane) kernel.load(lane, s.t, s.state, s.leading);
    kernel.expand();
    benchmark::DoNotOptimize(kernel.coefficient(0, kStages));
  }
}

void tables(benchmark::State& clock, const std::string& name) { expand(clock, subject(name), subject(name).plan(), 1); }

void lanes(benchmark::State& clock, const std::string& name) { expand(clock, subject(name), subject(name).plan(), tiers().back().lanes); }

void compiled(benchmark::State& clock, const std::string& name) {
  const auto plan = subject(name).plan();
  if (const std::string why = plan->compile({}); !why.empty()) return clock.SkipWithError(why.c_str());
  expand(clock, subject(name), plan, 1);
}

void compile(benchmark::State& clock, const std::string& name, bool kept) {
  const std::filesystem::path folder = std::filesystem::temp_directory_path() / ("anholon-kernel-bench-" + std::to_string(getpid()));
  const std::string cache = kept ? folder.string() : std::string();
  if (const std::string why = subject(name).plan()->compile(cache); !why.empty()) return clock.SkipWithError(why.c_str());
  for (auto _ : clock) {
    clock.PauseTiming();
    const auto plan = subject(name).plan();
    clock.ResumeTiming();
    plan->compile(cache);
  }
  std::filesystem::remove_all(folder);
}

const bool registered = [] {
  for (const char* model : {"sleigh", "disc", "trailers", "chain"}) {
    const auto add = [model](const char* backend, auto* function) {
      return benchmark::RegisterBenchmark((std::string("kernel/") + model + "/" + backend).c_str(), [=](benchmark::State& s) { function(s, model); });
    };
    add("interpreted", interpreted)->Unit(benchmark::kMicrosecond);
    add("tables", tables)->Unit(benchmark::kMicrosecond);
    add("lanes", lanes)->Unit(benchmark::kMicrosecond);
    add("compiled", compiled)->Unit(benchmark::kMicrosecond);
    add("make", +[](benchmark::State& s, const std::string& name) { compile(s, name, false); })->Unit(benchmark::kMillisecond);
    add("find", +[](benchmark::State& s, const std::string& name) { compile(s, name, true); })->Unit(benchmark::kMillisecond);
  }
  return true;
}();

}  // namespace
