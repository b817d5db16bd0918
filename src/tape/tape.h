// A straight-line program for a list of expressions, and its interpreter over any number type.
//
// Slot i is the result of instruction i. A slot is a Taylor series; the interpreter computes the coefficients of all
// slots one stage at a time:
//
//   stage s computes for each slot the coefficient of order s + lead(slot)   (if that is >= 0).
//
// The lead of a root is given by the caller (the offset c_i of equation i: how often the equation is to be
// differentiated), the lead of any other slot is the largest among its users. With leads, the derivatives of a
// constraint are higher Taylor coefficients of the constraint itself; they need no symbolic differentiation.
//
// This interpreter is the reference implementation: slow, but simple. Faster kernels must agree with it.
#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "expr/diff.h"
#include "numeric/linear.h"

namespace anholon {

class Ball;

enum class Op : std::uint8_t {
  constant,  // rational `index`
  pi,
  input,      // input `index`
  parameter,  // parameter `index`
  linear,     // c0 + sum c_k * slot_k: terms [first, first + count) of `linear_terms`
  multiply,   // a * b
  scale,      // a * b with a constant in time
  square,     // a^2
  divide,     // a / b
  power,      // a^r, r = rational `index`, not a whole positive number
  function,   // elementary function `index` of a; b = slot of its derivative f'(a)
  arctan2,    // atan2(a, b); `first` and `second` = slots of the derivatives by a and b
  select,     // a if slot `first` >= 0, else b, in all orders, decided by the value at the point
  lookup,     // step function `index` of a: the value there; a constant of its series
  rate,       // the derivative of order `index` of a
};

struct Instruction {
  Op op;
  bool constant = false;  // does not vary with time: it has only the coefficient of order 0
  std::uint8_t lead = 0;
  std::uint32_t a = 0, b = 0;
  std::uint32_t index = 0;
  std::uint32_t first = 0, count = 0;
};

struct LinearTerm {
  std::uint32_t coefficient;  // rational index
  std::uint32_t slot;
};

// The symbol that an input slot represents: t, q_a^(k), lambda_r^(k), …
struct Input {
  NodeId symbol;
  std::uint32_t slot;
};

struct Tape {
  static constexpr NodeId kNoNode = 0xffffffffU;
  std::vector<Instruction> code;
  std::vector<LinearTerm> linear_terms;
  std::vector<Rational> rationals;
  std::vector<StepFunction> step_functions;
  std::vector<Input> inputs;
  std::vector<std::uint32_t> roots;  // slots of the expressions, in the order given
  std::vector<NodeId> nodes;         // the node whose value a slot has; kNoNode if the slot is a part of a product
  std::uint32_t main_end = 0;        // slots below this serve the first `main_roots` expressions
  int largest_lead = 0;
};

// Compiles the expressions. The first `leads.size()` of them are the main roots, with these leads; those that follow
// have lead 0 and do not influence the slots of the main part. REQUIRES: no frozen mass and no unknown given function
// occurs. `shared`: products of factors that vary in time are made of pairs that several of them have in common, and
// factors constant in time come last. There are fewer products, and their rounding differs.
//
// `rates`: the jets of coordinates from `rates_from` on denote these expressions and their derivatives, which the tape
// takes from the series of the expressions.
Tape compile(std::span<const Expr> es, std::span<const int> leads, bool shared = false,
             std::span<const Expr> rates = {}, std::uint32_t rates_from = 0);
Tape compile(std::span<const Expr> es);

// Returns the slots, without the inputs, whose coefficients of order 0 depend on one of these slots, in the order of
// the tape.
std::vector<std::uint32_t> dependents(const Tape& tape, const std::vector<std::uint32_t>& of);

// Returns the slots, ascending, from which the series of these slots are computed, including these slots and those of
// derivatives.
std::vector<std::uint32_t> precedents(const Tape& tape, const std::vector<std::uint32_t>& of);

// The number type of a tape: a floating-point type, or balls, which are never compared. In a machine of balls, the
// series of a slot encloses its Taylor coefficients for all inputs enclosed by the input series, if the slot is smooth
// on all of the balls; otherwise its coefficients are not finite.
template <class N>
concept Scalar = Number<N> || std::same_as<N, Ball>;

template <Scalar N>
class Machine {
 public:
  // Series of up to `orders` coefficients beyond the lead.
  Machine(const Tape& tape, std::size_t orders, const std::vector<N>& parameters);
  // Sets other values of the parameters; slots that are constant in time are computed anew.
  void set_parameters(const std::vector<N>& parameters);

  N* series(std::uint32_t slot) { return &data_[slot * stride_]; }
  const N* series(std::uint32_t slot) const { return &data_[slot * stride_]; }
  const N& value(std::size_t root) const { return series(tape_->roots[root])[0]; }

  // Computes stage s of slots [from, to); inputs must be set by the caller.
  void sweep(int stage, std::uint32_t from, std::uint32_t to);
  // Computes stage s of these slots alone, in this order.
  void sweep(int stage, const std::vector<std::uint32_t>& slots);
  // Computes values only: all slots at order 0.
  void evaluate() { sweep(0, 0, static_cast<std::uint32_t>(tape_->code.size())); }
  // Computes the values of these slots alone, in this order.
  void evaluate(const std::vector<std::uint32_t>& slots) {
    for (const std::uint32_t s : slots) step(tape_->code[s], s, 0);
  }

  // The derivatives d slot / d operand at order 0, for the operands of an instruction.
  struct Partials {
    N a, b;
  };
  Partials partials(std::uint32_t slot) const;
  // Returns the sum of the absolute values of a slot's terms, at order 0.
  N magnitude(std::uint32_t slot) const;
  // Computes for every slot at order 0 the size of the numbers that it is made of: of a sum, the sum of the absolute
  // values of its terms, which a product and a quotient take on in proportion. The round-off of this size bounds a slot
  // that should vanish.
  void made_of(std::vector<N>& sizes) const;
  // Returns the sum of the absolute values of the terms of a main root, in its Taylor coefficient of this order.
  N terms(std::size_t root, std::size_t order) const;
  const N& rational(std::uint32_t index) const { return rationals_[index]; }
  // Returns the knots around a slot with a step function: the one below and the one above; nullptr if there is none.
  std::pair<const N*, const N*> knots_around(std::uint32_t slot) const;
  const Tape& tape() const { return *tape_; }

 private:
  void step_of_stage(std::uint32_t slot, int stage);
  void step(const Instruction& in, std::uint32_t slot, std::size_t p);
  // These return the coefficient of order p of a slot; `w` is its series, known below p.
  N sum(const Instruction& in, std::size_t p) const;
  N quotient(const Instruction& in, const N* w, std::size_t p) const;
  N power(const Instruction& in, const N* w, std::size_t p) const;
  N function(const Instruction& in, std::size_t p) const;
  N arctan2(const Instruction& in, std::size_t p) const;
  N chosen(const Instruction& in, std::size_t p) const;
  N looked_up(const Instruction& in, std::size_t p) const;
  N rate(const Instruction& in, std::size_t p) const;

  const Tape* tape_;
  std::size_t stride_;
  std::vector<N> data_;
  std::vector<N> rationals_;
  std::vector<int> halves_;  // for each rational: twice its value if as an exponent it is a root; else 0
  struct Steps {
    std::vector<N> knots, values;
  };
  std::vector<Steps> steps_;
};

extern template class Machine<double>;
extern template class Machine<long double>;
extern template class Machine<Quad>;
extern template class Machine<Multi>;

// Returns the values of parameters in any number type, or as enclosures.
template <Scalar N>
std::vector<N> evaluate_parameters(Graph& graph, std::span<const Expr> values);

}  // namespace anholon
