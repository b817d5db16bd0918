// The interface of a kernel to an instruction set, and the parts that instruction sets share.
#pragma once
#include <array>
#include <memory>
#include <string>
#include <vector>

#include "kernel/plan/plan.h"
#include "program/sparse_lu.h"

namespace anholon {

inline constexpr int kMostRising = 12;

// A pivot whose size is judged: its place, and 1 / its value at the choice of pivots.
struct JudgedPivot {
  std::uint32_t at;
  double inverse;
};

// A state that violates its hidden constraints by at most this is not projected: it is not known more precisely.
inline constexpr double kQuiet = 8 * 0x1p-53;

// The reach of series is computed to four digits, in powers of two: log2(1 + u) = u (c_0 + c_1 u + …) from sqrt(1/2) to
// sqrt(2), 2^f from -1/2 to 1/2 (minimax). The reach is at most 2^kFarthest.
inline constexpr double kLog2e = 1.4426950408889634, kFarthest = 300 * kLog2e;
inline constexpr double kLog2[] = {1.4417624, -0.72490038, 0.51749214, -0.32964325};
inline constexpr double kExp2[] = {0.99992807, 0.69326099, 0.24261112, 0.05517167};
inline constexpr std::uint64_t kRootOfHalf = 0x3fe6a09e667f3bcdULL;  // bits of sqrt(1/2)
// This is 1.5 2^52: added to a small integer, it moves the integer to the last bits.
inline constexpr double kInteger = 6755399441055744.0;

// Places in the arena for the findings of an expansion, one number per lane.
struct Findings {
  std::uint32_t health = 0, determinant = 0;  // Pivots (pivots.h)
  // drift, weight, moved: of the projection; `moved` is 1 if it moves, or has moved, the state, otherwise 0
  std::uint32_t drift = 0, weight = 0, moved = 0;
  std::uint32_t reach = 0;    // the step that the series allow
  std::uint32_t unfit = 0;    // not 0: a highest coefficient is not finite
  std::uint32_t largest = 0;  // largest absolute value in the state after a step; NaN if it contains one
  // the difference of the leading derivatives from their first guess, relative to the derivatives below them
  std::uint32_t defect = 0;
  // the largest change, over a step, of the arguments of functions that may hide their variation, relative to the
  // largest change that hides nothing
  std::uint32_t hidden = 0;
};

// Machine code of a long plan is in pieces of at most this many steps of a stage; histories (sweep.h: convolution) are
// summed in loops over this many at once, and each has room for the sums of a block of orders and for as many of new
// coefficients.
inline constexpr std::size_t kStepsOfPiece = 200, kHistoriesAtOnce = 4;
inline constexpr std::uint32_t kSumsOfHistory = 2 * kBlock;

// The value of a step function: values[i] between knots i - 1 and i, of which there are `count`.
double looked_up(const double* knots, std::int64_t count, const double* values, double x);

// Tables that are not changed after their construction; the kernels of all threads share them.
struct KernelTables {
  const Plan* plan = nullptr;
  const SparseLu* elimination = nullptr;
  struct Knots {
    std::vector<double> at, values;
  };
  std::vector<Knots> knots;
  // Places in the arena.
  std::uint32_t lu = 0, reciprocal = 0, inverse = 0, rhs = 0, side = 0, solution = 0, refined = 0, entries = 0,
                step = 0, weights = 0, increments = 0;
  // The sums of the histories of a long plan, whose machine code is in pieces (jit/emit_pieces.cpp); 0 for other plans.
  std::uint32_t sums = 0;
  // States of motions: x_j^(k), k < d_j, as sums of two doubles, first all larger parts, then first guesses of
  // x_j^(d_j). Three places take turns: the start of the next expansion, of the present one, of the one before.
  // `projected`, without guesses: the present state after projection.
  std::array<std::uint32_t, 3> motions{};
  std::uint32_t projected = 0;
  // The part that a step is of the reach of its series (integrate/step_control.h), in powers of two.
  std::uint32_t margin = 0;
  std::uint32_t inverse_pivots = 0;  // `inverse` of the judged pivots
  Findings found;
  std::uint32_t size = 0;
  std::uint32_t state_size = 0;
  // The place of (k + i)! / i! h^i, the weight of coefficient k + i of a series, k + i >= 1, in the change of x^(k)
  // over a step h.
  std::uint32_t weight(int k, int i) const {
    return weights + static_cast<std::uint32_t>(k * (plan->stages + plan->largest_d + 1) + i);
  }
  std::uint32_t motion_size() const { return 2 * state_size + static_cast<std::uint32_t>(plan->x.size()); }
  std::vector<JudgedPivot> judged;
  bool refine = false;  // refines solutions by one step of iterative refinement
  bool keeps_entries() const { return refine || !elimination->own.empty(); }  // entries of the linearized tape
  std::vector<double> factorial, inverse_factorial;                           // k!, 1 / k!

  // Whole numbers that are divisors in every expansion, with the numbers by which it multiplies instead (lanes.h:
  // quotient): the reciprocal as the sum of two doubles. Rounded to one double, it would have the same error at every
  // step, and the errors of a motion would grow in proportion to its length.
  struct Divisors {
    std::vector<double> number, reciprocal, beyond;
    void add(long double n);
  };
  Divisors order;    // k
  Divisors rising_;  // (s + m)! / s!, m up to kMostRising; a double holds it for m up to 8
  std::size_t orders = 0;
  std::size_t rising_at(int m, int s) const {
    return static_cast<std::size_t>(m) * orders + static_cast<std::size_t>(s);
  }
  double rising(int m, int s) const { return rising_.number[rising_at(m, s)]; }

  double lookup(std::uint32_t function, double x) const {
    const Knots& f = knots[function];
    return looked_up(f.at.data(), static_cast<std::int64_t>(f.at.size()), f.values.data(), x);
  }
};

// One Taylor expansion in a number of lanes over one arena [slot][lane].
class Arithmetic {
 public:
  virtual ~Arithmetic() = default;
  // Computes values and known coefficients at the point, stages from..0, and the partial derivatives.
  virtual void values(int from) = 0;
  virtual void factor() = 0;
  // Computes health and determinant of the pivots.
  virtual void judge() = 0;
  // Solves for the residuals at derivative order c_i - level.
  virtual void residual(int level) = 0;
  // Computes the displacement of the derivatives d_j - level by the solution for a level; returns whether it exceeds
  // round-off in any lane.
  virtual bool displaced(int level) = 0;
  // Applies the displacement in the lanes where it exceeds round-off.
  virtual void correct(int level) = 0;
  // Stores the solution of a stage.
  virtual void complete(int stage) = 0;
  // Computes stages 1.. and the quadratures.
  virtual void extend() = 0;
  // Computes the values of the quadratures at the point.
  virtual void quadratures() = 0;
  // Computes the changes of x_j^(k), k = 0..d_j, one after the other, over `step`, into `increments`.
  virtual void advance() = 0;

  // Loads the states of motions at the start of an expansion.
  virtual void begin(const double* from) = 0;
  // Stores the projected states.
  virtual void adopt(const double* from) = 0;
  // Computes the reach of the series and whether they are finite.
  virtual void measure() = 0;
  // Computes the largest change, over `step`, of the arguments of functions that may hide their variation.
  virtual void look_for_hidden() = 0;
  // Adds the increments to the states.
  virtual void go_on(const double* base, double* to) = 0;
  // Computes the difference of the leading derivatives, once solved for, from their first guess.
  virtual void compare(const double* from) = 0;
};

// Functions of the C library, common to all tiers; the sines are for very large angles, and for machines without fused
// multiplication.
double power_of(double x, double exponent);
double function_of(std::uint32_t function, double x);
void sine_and_cosine(double x, double& sine, double& cosine);

// Sine and cosine of angles in all lanes; `beyond`: the part of the angle beyond its double, or nullptr.
using SinesOfLanes = void (*)(const double* angle, const double* beyond, double* sine, double* cosine);

// An instruction set for which this program was built.
struct Tier {
  const char* name;
  int lanes;                                                                           // the maximal number
  std::unique_ptr<Arithmetic> (*make)(const KernelTables&, double* arena, int lanes);  // lanes: 1 or the maximal number
  SinesOfLanes sines_of_one, sines_of_all;
};
// The tiers that this machine supports, the fastest last.
const std::vector<Tier>& tiers();
// The fastest tier that computes so many lanes. REQUIRES: there is one.
const Tier& tier_of(int lanes);
// The most lanes of a tier whose machine code is translated at first (code.h); if that is one lane, the most of all
// tiers.
int lanes_at_first();
extern const Tier tier_plain, tier_avx2, tier_avx512;

}  // namespace anholon
