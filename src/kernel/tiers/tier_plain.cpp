// Any machine, one lane.
#include "kernel/tiers/pairs_run.h"
#include "kernel/tiers/sweep.h"

namespace anholon {

static std::unique_ptr<Arithmetic> make(const KernelTables& tables, double* arena, int lanes) {

  (void)lanes;
  return std::make_unique<Sweep<1>>(tables, arena);
}

const Tier tier_plain{"plain", 1, make, Sines<1>::at, Sines<1>::at};

void run_pairs_plain(const PairProgram& program, double* numbers, const std::function<void(std::uint32_t)>& other) {
  PairRun<1>::run(program, numbers, other);
}

}  // namespace anholon
