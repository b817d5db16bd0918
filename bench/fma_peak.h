// The fused multiply-adds per second of one core, in doubles and in vectors. Twelve independent chains of them hide the
// latency of one.
#pragma once
#include <algorithm>
#include <cstring>
#include <utility>
#include <vector>

#include "stopwatch.h"

struct Peak {
  const char* name;
  double gigaflops;
};

namespace fma_peak_detail {

// Runs `times` multiply-adds in each chain. The indices of the chains are compile-time constants: otherwise the
// compiler would keep the sums in memory, not in registers.
template <class V, std::size_t... chain>
[[gnu::always_inline]] inline void sweep(long times, double& result, std::index_sequence<chain...>) {
  V sum[sizeof...(chain)] = {};
  V factor{}, addend{};
  factor += 0.999999999;
  addend += 1e-9;
  for (long i = 0; i < times; ++i) ((sum[chain] = sum[chain] * factor + addend), ...);
  V total{};
  ((total += sum[chain]), ...);
  std::memcpy(&result, &total, sizeof result);  // the sum must be used, or the compiler would delete the chains
}

typedef double Four __attribute__((vector_size(32)));
typedef double Eight __attribute__((vector_size(64)));

#ifdef __x86_64__
[[gnu::target("fma"), gnu::optimize("fp-contract=fast"), gnu::noinline]] inline double one(long times) {
  double result;
  sweep<double>(times, result, std::make_index_sequence<12>());
  return result;
}
[[gnu::target("avx2,fma"), gnu::optimize("fp-contract=fast"), gnu::noinline]] inline double four(long times) {
  double result;
  sweep<Four>(times, result, std::make_index_sequence<12>());
  return result;
}
[[gnu::target("avx512f,prefer-vector-width=512"), gnu::optimize("fp-contract=fast"), gnu::noinline]] inline double
eight(long times) {
  double result;
  sweep<Eight>(times, result, std::make_index_sequence<12>());
  return result;
}
#endif

inline double gigaflops(double (*kernel)(long), int lanes) {
  constexpr long kTimes = 1'000'000;
  double best = 0;
  for (int repeat = 0; repeat < 20; ++repeat) {
    const Stopwatch watch;
    volatile double keep = kernel(kTimes);
    (void)keep;
    const double s = watch.seconds();
    best = std::max(best, 2.0 * 12 * lanes * static_cast<double>(kTimes) / s / 1e9);
  }
  return best;
}

}  // namespace fma_peak_detail

inline std::vector<Peak> fma_peaks() {
  using namespace fma_peak_detail;
  std::vector<Peak> peaks;
#ifdef __x86_64__
  if (__builtin_cpu_supports("fma")) peaks.push_back({"scalar", gigaflops(one, 1)});
  if (__builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma")) peaks.push_back({"avx2", gigaflops(four, 4)});
  if (__builtin_cpu_supports("avx512f")) peaks.push_back({"avx512", gigaflops(eight, 8)});
#endif
  return peaks;
}
