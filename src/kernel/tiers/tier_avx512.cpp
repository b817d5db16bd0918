// AVX-512, eight lanes.
#include "kernel/tiers/sweep.h"

namespace anholon {

static std::unique_ptr<Arithmetic> make(const KernelTables& tables, double* arena, int lanes) {
  if (lanes == 8) return std::make_unique<Sweep<8>>(tables, arena);

  return std::make_unique<Sweep<1>>(tables, arena);
}

const Tier tier_avx512{"avx512", 8, make, Sines<1>::at, Sines<8>::at};

}  // namespace anholon
