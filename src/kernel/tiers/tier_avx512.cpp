// AVX-512, eight lanes.
#include "kernel/tiers/pairs_run.h"
#include "kernel/tiers/sweep.h"

namespace anholon {

static std::unique_ptr<Arithmetic> make(const KernelTables& tables, double* arena, int lanes) {
  if (lanes == 8) return std::make_unique<Sweep<8>>(tables, arena);

  return std::make_unique<Sweep<1>>(tables, arena);
}

const Tier tier_avx512{"avx512", 8, make, Sines<1>::at, Sines<8>::at};

void run_pairs_avx512(const PairProgram& program, double* numbers, const std::function<void(std::uint32_t)>& other) {
  PairRun<8>::run(program, numbers, other);
}

}  // namespace anholon
