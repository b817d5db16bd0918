// The stepping program: the computation of one Taylor expansion of the motion, order by order.
//
// At stage k >= 1 the coefficients of order k + d_j of every unknown enter all equations (at order k + c_i) linearly
// and with the same matrix, the system Jacobian J. A stage is therefore one sweep over the tape with these coefficients
// zero, one back-substitution, and one pass that adds the effect of the coefficients to the slots that depend on them
// (the tainted ones). One LU serves all stages.
#pragma once
#include <memory>

#include "structure/structure.h"
#include "tape/tape.h"

namespace anholon {

struct ProgramInput {
  enum class Kind : std::uint8_t { time, variable, other } kind = Kind::other;
  std::uint32_t slot = 0;
  std::size_t variable = 0;
  int order = 0;         // order of the derivative
  bool leading = false;  // order + lead == d: the unknown of each stage
};

struct TaintedSlot {
  std::uint32_t slot;
  std::uint32_t row;  // its row in the tangent matrix
  bool a, b;          // which operands are tainted (for a linear slot: see its terms)
};

class Linearized;

struct Program {
  const System* system = nullptr;
  std::vector<int> c, d;
  Tape tape;
  std::vector<ProgramInput> inputs;
  std::vector<TaintedSlot> tainted;        // ascending, without the leading inputs
  std::vector<std::uint32_t> tangent_row;  // slot -> row, or kUntainted
  std::size_t tangent_rows = 0;
  std::size_t quadratures = 0;                     // roots after the equations
  std::vector<std::vector<std::uint32_t>> scales;  // the unknowns that are measured against one size (system/system.h)
  bool nonlinear = false;                          // leading derivatives enter nonlinearly: J depends on them
  // Leading derivatives other than rates of the model's states enter nonlinearly.
  bool several_solutions = false;
  std::shared_ptr<const Linearized> linearized;  // set for programs with many unknowns

  static constexpr std::uint32_t kUntainted = 0xffffffffU;
  std::size_t unknowns() const { return d.size(); }
};

// Makes the program. `quadratures`: expressions whose Taylor series follow from the solution (powers to integrate,
// energies to monitor). `shared`: the option of the tape (tape/tape.h).
Program program(const System& system, const Structure& structure, std::span<const Expr> quadratures = {},
                bool shared = false);

// Returns the places of the entries of J (program/linearized.h), which the program does not hold yet.
std::shared_ptr<const Linearized> linearized(const Program& program);

// Counts for tests and `--show program`.
struct ProgramSize {
  std::size_t slots, products, linear, functions, tainted;
};
ProgramSize size(const Program& program);
std::string print(const Program& program);

}  // namespace anholon
