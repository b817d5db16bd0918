// What a kernel asks of an instruction set, and what the instruction sets share.
#pragma once
#include <array>
#include <memory>
#include <string>
#include <vector>

#include "kernel/plan.h"
#include "kernel/sparse_lu.h"

namespace anholon {

inline constexpr int kMostRising = 12;

// A pivot whose size says how far it still serves: where it lies, 1 / what it was.
struct JudgedPivot {
  std::uint32_t at;
  double inverse;
};

// A state this many round-offs off its hidden constraints is left alone: it is not known better.
inline constexpr double kQuiet = 8 * 0x1p-53;

// How far series reach is found to four digits, in powers of two: log2(1 + u) = u (c_0 + c_1 u + …) from sqrt(1/2) to
// sqrt(2), 2^f from -1/2 to 1/2 (minimax). Nothing is farther than 2^kFarthest.
inline constexpr double kLog2e = 1.4426950408889634, kFarthest = 300 * kLog2e;
inline constexpr double kLog2[] = {1.4417624, -0.72490038, 0.51749214, -0.32964325};
inline constexpr double kExp2[] = {0.99992807, 0.69326099, 0.24261112, 0.05517167};
inline constexpr std::uint64_t kRootOfHalf = 0x3fe6a09e667f3bcdULL;  // its bits
inline constexpr double kInteger = 6755399441055744.0;  // 1.5 2^52: a small integer added to it lies in its last bits

// Where in the arena an expansion leaves what it found, a number in every lane.
struct Findings {
  std::uint32_t health = 0, determinant = 0;       // Pivots (pivots.h)
  std::uint32_t drift = 0, weight = 0, moved = 0;  // of the projection; 0 or 1: where it moves the state, has moved it
  std::uint32_t reach = 0;                         // the step that the series allow
  std::uint32_t unfit = 0;                         // not 0: a highest coefficient is no number
  std::uint32_t largest = 0;  // of the state after a step, by absolute value; no number if one is none
  std::uint32_t defect = 0;   // by how much the leading derivatives differ from their first guess, in relation to the
                              // derivatives below them
  static constexpr std::uint32_t kCount = 9;
};

// Read only once made; shared by the kernels of all threads.
struct KernelTables {
  const Plan* plan = nullptr;
  const SparseLu* elimination = nullptr;
  struct Knots {
    std::vector<double> at, values;
  };
  std::vector<Knots> knots;
  // Where in the arena.
  std::uint32_t lu = 0, reciprocal = 0, inverse = 0, rhs = 0, side = 0, solution = 0, refined = 0, entries = 0,
                step = 0, weights = 0, increments = 0;
  // Of motions: x_j^(k), k < d_j, as sums of two doubles, first all the larger parts, and first guesses of x_j^(d_j).
  // There are three places: where the next expansion begins, the present one was begun, the one before; they take
  // turns. Without the guesses: where projection has put the present one.
  std::array<std::uint32_t, 3> motions{};
  std::uint32_t projected = 0;
  std::uint32_t margin =
      0;  // what a step is of the reach of its series (integrate/step_control.h), in powers of two
  std::uint32_t inverse_pivots = 0;  // `inverse` of those that are judged
  Findings found;
  std::uint32_t size = 0;
  std::uint32_t state_size = 0;
  // Of the series of x^(k), what their coefficients of order k + i = 1.. weigh in a change over a step h: (k + i)! / i!
  // h^i.
  std::uint32_t weight(int k, int i) const {
    return weights + static_cast<std::uint32_t>(k * (plan->stages + plan->largest_d + 1) + i);
  }
  std::uint32_t motion_size() const { return 2 * state_size + static_cast<std::uint32_t>(plan->x.size()); }
  std::vector<JudgedPivot> judged;
  bool refine = false;  // solutions, by one step of iterative refinement
  bool keeps_entries() const { return refine || !elimination->own.empty(); }  // of the linearized tape
  std::vector<double> factorial, inverse_factorial;                           // k!, 1 / k!

  // Whole numbers by which every expansion divides, and what it multiplies by instead (lanes.h: quotient): the
  // reciprocal as the sum of two doubles. Rounded to one, it would be wrong in the same way at every step, and the
  // errors of a motion would grow in proportion to its length.
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

  double lookup(std::uint32_t function, double x) const;
};

// One Taylor expansion in a number of lanes over one arena [slot][lane].
class Arithmetic {
 public:
  virtual ~Arithmetic() = default;
  // Values and known coefficients at the point: stages from..0; and the partial derivatives.
  virtual void values(int from) = 0;
  virtual void factor() = 0;
  // What pivots say, into the findings.
  virtual void judge() = 0;
  // The solution for the residuals at derivative order c_i - level.
  virtual void residual(int level) = 0;
  // How far the solution for a level moves the derivatives d_j - level, and whether that is more than round-off: in any
  // lane?
  virtual bool displaced(int level) = 0;
  // Moves them in the lanes where it is.
  virtual void correct(int level) = 0;
  // Puts the solution of a stage in.
  virtual void complete(int stage) = 0;
  // Stages 1.. and the quadratures.
  virtual void extend() = 0;
  // By what x_j^(k), k = 0..d_j, one after the other, change over `step`, into `increments`.
  virtual void advance() = 0;

  // Of motions: puts their states in where an expansion begins,
  virtual void begin(const double* from) = 0;
  // takes over what projection has moved of them,
  virtual void adopt(const double* from) = 0;
  // says how far the series reach and whether they are numbers,
  virtual void measure() = 0;
  // goes on by the increments,
  virtual void go_on(const double* base, double* to) = 0;
  // and says how far the leading derivatives, once solved for, are from their first guess.
  virtual void compare(const double* from) = 0;
};

// Functions of the C library, in one place for every tier; sines of angles that are very large, or on machines without
// fused multiplication.
double power_of(double x, double exponent);
double function_of(std::uint32_t function, double x);
void sine_and_cosine(double x, double& sine, double& cosine);

// Of angles in all lanes and what they are beyond their doubles (null: nothing).
using SinesOfLanes = void (*)(const double* angle, const double* beyond, double* sine, double* cosine);

// An instruction set this program was built for.
struct Tier {
  const char* name;
  int lanes;                                                                           // the most
  std::unique_ptr<Arithmetic> (*make)(const KernelTables&, double* arena, int lanes);  // lanes: 1 or the most
  SinesOfLanes sines_of_one, sines_of_all;
};
// Those that this machine has, the best last.
const std::vector<Tier>& tiers();
extern const Tier tier_plain, tier_avx2, tier_avx512;

}  // namespace anholon
