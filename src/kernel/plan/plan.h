// The stepping program laid out for speed: the computation of one Taylor expansion in doubles, step by step, over one
// arena of numbers.
//
// A plan is made once per program and holds no numbers of a motion, so any number of kernels (one trajectory, or one in
// each SIMD lane) and threads share it. Against the tape (tape/tape.h), which stays the reference:
//   - sums of sums are one sum, factors constant in time are its coefficients, a sine and its cosine are one step;
//   - only slots that a convolution needs store their series; all others are one number per stage;
//   - terms that are zero in a sweep because the unknowns of the stage are not known yet are omitted beyond stage 0;
//   - J is never formed: the linearized tape itself, one row for every slot that depends on the unknowns, is eliminated by a sparse
//     LU (program/sparse_lu.h). For a chain that is the O(n) recursion of articulated bodies, found by the order of elimination.
#pragma once
#include <cstdint>
#include <optional>
#include <vector>

#include "program/program.h"

namespace anholon {

// Orders are computed in blocks of this size (sweep.h: convolution).
inline constexpr int kBlock = 4;

// A value in the arena; for a series, the coefficient of order p is at `at` + p.
struct Place {
  std::uint32_t at = 0;
  bool series = false;
};

enum class Act : std::uint8_t {
  input,   // x^(k): a = series of x, index = k
  linear,  // sum of coefficient * value
  // the part of a linear sum beyond its double; `index`: the first of the terms with the parts of the values beyond
  // their doubles
  beyond,
  multiply,     // a * b
  square,       // a^2
  divide,       // a / b; c: 1 / b_0
  square_root,  // sqrt(a)
  power,  // a^value; b: 1 / a_0, c, d = weighted series of a and of itself, e: its derivative value * a_0^value / a_0
  sine_cosine,  // out = sin a, c = cos a; b = weighted series of a; d: the part of a beyond its double, if known
  function,     // elementary function `index` of a; b = its derivative, c = weighted series of a
  arctan2,      // atan2(a, b); c, d = derivatives by a and b; e, f = weighted series of a and b
  weigh,        // order * a
  select,       // a if c_0 >= 0, else b
  lookup,       // step function `index` of a
};

struct Step {
  Act act = Act::linear;
  std::uint8_t lead = 0;
  bool a_constant = false, b_constant = false;  // only the coefficient of order 0 is not zero
  bool a_unknown = false, b_unknown = false;    // the newest coefficient is an unknown of the stage, zero in the sweep
  bool b_later = false;                         // the newest coefficient of b is known later than that of a
  Place out, a, b, c, d, e, f;
  std::uint32_t first = 0, count = 0;  // terms
  std::uint32_t constants = 0;         // terms after those, constant in time
  std::uint32_t index = 0;
  double value = 0;
};

struct PlanTerm {
  std::uint32_t coefficient;  // in the arena
  Place x;
};

// A constant of the arena: rational * product of slots of the tape that are constant in time.
struct Coefficient {
  static constexpr std::uint32_t kReciprocal = 0x80000000U;  // in a slot: the product is divided by it
  Rational rational{1};
  std::vector<std::uint32_t> slots;
  bool one() const { return slots.empty() && rational.is_one(); }
  bool minus_one() const { return slots.empty() && rational.is_minus_one(); }
};

// A partial derivative that is no coefficient of a series: computed once per expansion.
struct Partial {
  enum class Kind : std::uint8_t { twice, half_reciprocal, quotient, chosen, not_chosen } kind;
  std::uint32_t out, a, b;  // twice a; 1/(2a); a b; a >= 0; a < 0
};

// An entry of the linearized tape: `sign` * arena[`from`] in `row` and `column`. Unknowns come first, then the slots
// that depend on them.
struct Entry {
  std::uint32_t row, column, from;
  double sign;
};

// Coefficients that become known when a stage is solved.
struct Completion {
  Place out;
  std::uint8_t lead;
  std::uint32_t column;
  bool fresh;  // out is zero before the stage (beyond stage 0)
};

// The state is stored with more digits than a double has, which the sine of an angle of many turns needs: `at` gets the
// part of entry `index` of the state (x_j^(k), k < d_j, one after the other) beyond its double.
struct Beyond {
  std::uint32_t at, index;
};

// A function of one argument that may be nearly constant far from its variation. (A sine is not one: its series show
// its variation.)
struct Hiding {
  std::optional<Function> function;  // nullopt: a power, or a quotient
  double exponent = 0;               // of the power; of a quotient: the power of the argument by which it divides
  bool quotient = false;
  // True if the series of the argument have to reach over a step. An argument made of such functions may vary where its
  // series do not show it; each of these functions is looked at itself.
  bool needs_reach = true;

  // A function hides nothing if its argument changes by less than this; for powers and quotients, relative to the
  // argument.
  double hides_beyond() const { return quotient ? 1 - near_zero : 0.5; }
  // An argument this small, relative to its value at the start, makes a wall, a peak or a pole of a quotient.
  double near_zero = 0;
};
// A slot that may hide its variation, and the slot of its argument.
struct HidingSlot {
  std::uint32_t slot, argument;
  Hiding function;
};
// Returns the function, power or quotient of a slot if it may hide its variation. The argument of a quotient is the
// base of the power by which it divides.
std::optional<HidingSlot> may_hide(const Tape& tape, std::uint32_t slot);

struct Plan {
  int stages = 0;
  std::uint32_t stride = 0;
  std::uint32_t arena = 0;  // size of the arena

  std::vector<Coefficient> coefficients;  // arena [0, size)
  std::vector<Step> point, stage, after;  // stages up to 0; beyond; quadratures
  std::vector<PlanTerm> terms;
  std::vector<Partial> partials;
  std::vector<Step> weigh_again;  // weighted series of the series that depend on the unknowns of the stage
  std::vector<Entry> entries;
  std::vector<Completion> completions;
  std::vector<std::uint32_t> x;      // series of every unknown
  std::uint32_t time = 0;            // series of t
  std::vector<Place> roots;          // of the equations; the right side of row i belongs to root i
  std::vector<char> root_is_zero;    // beyond stage 0, before the unknowns of the stage are known
  std::vector<std::uint32_t> sides;  // roots in the order in which a stage computes them
  std::vector<Place> quadratures;
  std::vector<Beyond> beyond_double;  // of the angles of sines
  // Slots of the tape whose value decides which function holds: the radicand of a root of even power and the argument
  // of abs or sign, which may pass zero; the condition of a choice; the argument of a step function `index`, which may
  // pass a knot; the arguments of an angle atan2.
  struct Deciding {
    enum class Kind : std::uint8_t { radicand, sign, knots } kind;
    std::uint32_t slot, index;
    Place place;
  };
  std::vector<Deciding> deciding;
  struct HidingSeries {
    std::uint32_t slot;  // of the tape
    Hiding function;
    Place argument, value;
  };
  std::vector<HidingSeries> hiding;
  std::uint32_t rows = 0;  // of the linearized tape
  int largest_lead = 0, largest_d = 0;
  std::vector<int> c, d;
  std::vector<std::vector<std::uint32_t>> scales;  // of the program
  std::optional<Place> determinant;                // judged together with the pivots

  // For choices of representation: the number of multiplications and additions of one expansion (without the
  // elimination).
  double work() const;
};

// The rounding of numbers that no double represents: to the nearest double, or to the other one of the two doubles
// between which they lie. A property that motions with both roundings share does not come from rounding.
enum class Rounding : std::uint8_t { nearest, other };
// The values of the coefficients of a plan, for one set of parameters after the other.
class CoefficientValues {
 public:
  // REQUIRES: the plan and the program outlive the values.
  CoefficientValues(const Plan& plan, const Program& program, const std::vector<long double>& parameters);
  void set_parameters(const std::vector<long double>& parameters) { slots_.set_parameters(parameters); }
  // Each value is computed in long double and rounded once.
  std::vector<double> rounded(Rounding rounding = Rounding::nearest) const;

 private:
  const Plan* plan_;
  std::vector<long double> rationals_;  // of each coefficient
  Machine<long double> slots_;          // slots that are constant in time
};

}  // namespace anholon
