// Routh's equations of the planar chain, stage by stage: reading, kinetic energy and forces, equations, expanding,
// printing. bench/peers/chain.py compares the whole with SymPy.
#include <benchmark/benchmark.h>

#include "expr/normal.h"
#include "formulation/formulation.h"
#include "modelfile/read.h"
#include "print/print.h"
#include "support/chain.h"

namespace {

using namespace anholon;

std::unique_ptr<Model> read(int n) {
  Diagnostics diagnostics;
  return std::make_unique<Model>(*read_model({"chain.toml", test::chain_text(n)}, diagnostics));
}

Column both_sides(const Mechanics& m) {
  const Equations e = find_formulation("routh")->equations(m, {});
  Column all = e.left;
  all.insert(all.end(), e.right.begin(), e.right.end());
  return all;
}

void expand(Column& c) {
  for (Expr& e : c)
    if (const std::optional<Expr> full = expanded(e)) e = *full;
}

enum Stage { reading, energy_and_forces, equations, expanding, printing, expanding_and_printing };

// The expression graph keeps what is built, so every stage starts from a model that is read anew while the clock
// stands.
void stage(benchmark::State& state, Stage timed) {
  for (auto _ : state) {
    state.PauseTiming();
    if (timed == reading) state.ResumeTiming();
    const auto model = read(static_cast<int>(state.range(0)));
    if (timed == reading) continue;
    if (timed == energy_and_forces) state.ResumeTiming();
    const Mechanics m = mechanics(*model);
    if (timed == energy_and_forces) continue;
    if (timed == equations) state.ResumeTiming();
    Column all = both_sides(m);
    if (timed == equations) {
      benchmark::DoNotOptimize(all.data());
      state.counters["nodes"] = static_cast<double>(reachable(all).size());
      continue;
    }
    if (timed != printing) state.ResumeTiming();
    if (timed != printing) expand(all);
    if (timed == printing) state.ResumeTiming();
    if (timed != expanding) benchmark::DoNotOptimize(print(all, model->names, Format::text).size());
  }
}

const bool registered = [] {
  for (const auto& [name, which] : {std::pair{"1_read", reading},
                                    {"2_energy_and_forces", energy_and_forces},
                                    {"3_equations", equations},
                                    {"4_expand", expanding},
                                    {"5_print", printing},
                                    {"6_expand_and_print", expanding_and_printing}})
    benchmark::RegisterBenchmark((std::string("chain/") + name).c_str(), stage, which)
        ->Arg(5)
        ->Arg(10)
        ->Arg(20)
        ->Arg(64)
        ->Unit(benchmark::kMillisecond);
  return true;
}();

}  // namespace
