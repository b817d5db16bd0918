// The times inside the process, for each model: the derivation up to the stepping program, and one step for each number
// type.
#include <fstream>
#include <sstream>

#include <benchmark/benchmark.h>

#include "simulation/simulate.h"

namespace {

using namespace anholon;

class NoRows final : public RowSink {
 public:
  void columns(const std::vector<RunColumn>&) override {}
  void row(const Row&) override {}
};

std::shared_ptr<const Model> read(const std::string& path) {
  std::ifstream in(std::string(ANHOLON_SOURCE_DIR) + "/models/" + path);
  std::ostringstream text;
  text << in.rdbuf();
  Diagnostics diagnostics;
  auto model = read_model({path, text.str()}, diagnostics);
  return model ? std::make_shared<const Model>(std::move(*model)) : nullptr;
}

void derive(benchmark::State& state, const std::string& path) {
  for (auto _ : state) {
    Scenario s;
    make_scenario(read(path), *find_formulation("routh"), {}, s);
    benchmark::DoNotOptimize(program(s.system, s.structure).tape.code.size());
  }
}

void step(benchmark::State& state, const std::string& path, Precision precision) {
  Scenario s;
  make_scenario(read(path), *find_formulation("routh"), {}, s);
  SimulationOptions o;
  o.to = Rational(1000000);
  o.at = {Rational(1000000)};
  o.precision = precision;
  o.digits = precision == Precision::multi ? 30 : 16;
  const bool many = precision == Precision::quad || precision == Precision::multi;
  o.tolerance = Rational(1, many ? mpz_class("100000000000000000000000000000000") : mpz_class("1000000000000"));
  o.most_steps = many ? 20 : 2000;
  NoRows rows;
  std::size_t steps = 0;
  for (auto _ : state) steps += simulate(s, o, rows).steps;
  state.counters["per_step"] =
      benchmark::Counter(static_cast<double>(steps), benchmark::Counter::kIsRate | benchmark::Counter::kInvert);
}

const bool registered = [] {
  for (const char* model : {"zoo/chaplygin-sleigh.toml", "zoo/disc.toml", "zoo/rolling-coin.toml",
                            "zoo/snakeboard.toml", "zoo/car-three-trailers.toml", "papers/luo-zhao-example-2.toml"}) {
    benchmark::RegisterBenchmark((std::string("derive/") + model).c_str(), derive, model)
        ->Unit(benchmark::kMillisecond);
    for (const auto& [name, precision] : {std::pair{"double", Precision::real},
                                          {"long_double", Precision::long_real},
                                          {"quad", Precision::quad},
                                          {"30_digits", Precision::multi}})
      benchmark::RegisterBenchmark((std::string("step/") + name + "/" + model).c_str(), step, model, precision)
          ->Unit(benchmark::kMillisecond);
  }
  return true;
}();

}  // namespace
