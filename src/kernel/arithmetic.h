// What a kernel asks of an instruction set, and what the instruction sets share.
#pragma once
#include <memory>
#include <string>
#include <vector>

#include "kernel/sparse_lu.h"
#include "kernel/plan.h"

namespace anholon {

// Orders are computed in blocks of so many (sweep.h: convolution).
inline constexpr int kBlock = 4;
inline constexpr int kMostRising = 12;

// Read only once made; shared by the kernels of all threads.
struct KernelTables {
  const Plan* plan = nullptr;
  const SparseLu* elimination = nullptr;
  struct Knots {
    std::vector<double> at, values;
  };
  std::vector<Knots> knots;
  std::uint32_t lu = 0, reciprocal = 0, rhs = 0, side = 0, solution = 0, refined = 0, entries = 0, step = 0, increments = 0, size = 0;  // of the arena
  bool refine = false;  // solutions, by one step of iterative refinement
  std::vector<double> factorial, inverse_factorial, reciprocal_of, order;  // k!, 1 / k!, 1 / k, k

  // (s + m)! / s! and its reciprocal, m up to kMostRising.
  std::vector<double> rising_, falling_;
  std::size_t orders = 0;
  double rising(int m, int s) const { return rising_[static_cast<std::size_t>(m) * orders + static_cast<std::size_t>(s)]; }
  double falling(int m, int s) const { return falling_[static_cast<std::size_t>(m) * orders + static_cast<std::size_t>(s)]; }

  double lookup(std::uint32_t function, double x) const;
};

// One Taylor expansion in a number of lanes over one arena [slot][lane].
class Arithmetic {
 public:
  virtual ~Arithmetic() = default;
  // Values and known coefficients at the point: stages from..0; and the partial derivatives.
  virtual void values(int from) = 0;
  virtual void factor() = 0;
  // The solution for the residuals at derivative order c_i - level.
  virtual void residual(int level) = 0;
  // Adds weight[lane] * solution to the derivatives d_j - level.
  virtual void correct(int level, const double* weight) = 0;
  // Puts the solution of a stage in.
  virtual void complete(int stage) = 0;
  // Stages 1.. and the quadratures.
  virtual void extend() = 0;
  // By what x_j^(k), k = 0..d_j, one after the other, change over `step`, into `increments`.
  virtual void advance() = 0;
};

// Functions of the C library, in one place for every tier.
double power_of(double x, double exponent);
double function_of(std::uint32_t function, double x);
void sine_and_cosine(double x, double& sine, double& cosine);

// An instruction set this program was built for.
struct Tier {
  const char* name;
  int lanes;  // the most
  std::unique_ptr<Arithmetic> (*make)(const KernelTables&, double* arena, int lanes);  // lanes: 1 or the most
};
// Those that this machine has, the best last.
const std::vector<Tier>& tiers();
extern const Tier tier_plain, tier_avx2, tier_avx512;

}  // namespace anholon
