// AVX2 and FMA, four lanes.
#include "kernel/tiers/pairs_run.h"
#include "kernel/tiers/sweep.h"

namespace anholon {

static std::unique_ptr<Arithmetic> make(const KernelTables& tables, double* arena, int lanes) {
  if (lanes == 4) return std::make_unique<Sweep<4>>(tables, arena);

  return std::make_unique<Sweep<1>>(tables, arena);
}

const Tier tier_avx2{"avx2", 4, make, Sines<1>::at, Sines<4>::at};

void run_pairs_avx2(const PairProgram& program, double* numbers, const std::function<void(std::uint32_t)>& other) {
  PairRun<4>::run(program, numbers, other);
}

}  // namespace anholon
