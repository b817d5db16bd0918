// The interned expression graph.
//
// An Expr is a handle (graph, id). Equal expressions built in any order have the same id, so
// equality is comparison of ids, and every common subexpression exists once:
//   sums      c0 + c1 x1 + c2 x2 + …   exact rational coefficients, flattened, sorted by id
//   products  x1^r1 x2^r2 …            exact rational exponents, flattened, sorted by id
//   f(x)                               one of elementary.def; atan2(y, x)
//   (s >= 0 ? a : b), step functions   continue as another function at a point (a kink)
//   leaves    number, pi, and symbols  t, q_a^(k), parameters, frozen masses mu_i, lambda_r^(k), u_a^(k), z_i^(k)
//
// Invariants
//   (1) Operands of a node have smaller ids: a loop over ascending ids is a topological order, so
//       nothing here recurses and a deep formula cannot overflow the stack.
//   (2) Ids depend only on the order of construction, never on addresses or hash seeds.
//   (3) A sum of many terms remembers the partial sum it was built from ("the chain": position
//       of link i = position of link i-1 + …). Its flat terms decide equality; `summands` shows the
//       short way to compute it, so sweeps over a chain of n links cost O(n), not O(n^2).
//   (4) Nodes, terms, numbers and step functions never move: a reference or a span that the graph gives is valid as long
//       as the graph, also while it grows.
//
// Thread safety: many threads may read a graph while none builds in it. No thread can build in a frozen graph, so any
// number of threads may use it; code that has to build does so in a clone.
#pragma once
#include <compare>
#include <cstdint>
#include <deque>
#include <initializer_list>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "base/hash_index.h"
#include "base/stable_list.h"
#include "numeric/rational.h"

namespace anholon {

enum class Kind : std::uint8_t {
  number,  // rational
  pi,
  time,        // t
  jet,         // q_index^(order)
  parameter,   // p_index
  mass,        // frozen mass symbol mu_index: a constant for every differentiation
  multiplier,  // lambda_index^(order)
  given,       // an unknown given function of time f_index^(order)
  quasi,       // a quasi-velocity u_index^(order)
  sum,
  product,
  function,  // elementary function `index` of one operand
  atan2,     // two operands (y, x)
  state,     // a state z_index^(order) that the user declared, with a rate of its own
  control,   // an input u_index^(order): known only when the system is made
  select,    // three operands (s, a, b): a where s >= 0, else b
  lookup,    // step function `index` of one operand
};

// A function that is constant between its knots: values[k] if k knots are at or below the argument. Tables are
// polynomials between knots, whose coefficients are such functions.
struct StepFunction {
  std::string name;
  std::vector<Rational> knots, values;  // ascending; values.size() = knots.size() + 1
  // For a coefficient of a table: its power of the argument (-1: the point from which the polynomial is measured), and
  // how many derivatives of the table are continuous (-1: the table itself jumps).
  int power = 0, smooth = 100;
  friend bool operator==(const StepFunction& a, const StepFunction& b) = default;
};

enum class Function : std::uint8_t {
#define ROW(name, ...) name,
#include "expr/elementary.def"
#undef ROW
};

struct FunctionInfo {
  const char* name;
  const char* latex;
  const char *c, *numpy;  // names in exported programs
  const char* undefined;  // where the function is undefined, in words; empty if it is defined everywhere
  bool hides;             // may be almost constant where its series is known, and vary farther away
};
const FunctionInfo& info(Function f);
std::span<const FunctionInfo> elementary_functions();
// Returns the index of the function of that name, or -1.
int find_function(const std::string& name);

using NodeId = std::uint32_t;
class Graph;

struct Expr {
  Graph* graph = nullptr;
  NodeId id = 0;
  friend bool operator==(const Expr& a, const Expr& b) { return a.id == b.id; }
};

// One operand of a sum (weight = coefficient) or product (weight = exponent).
struct Term {
  std::uint32_t weight;  // index into the graph's table of rationals
  NodeId node;
};

struct Node {
  Kind kind;
  std::uint8_t order = 0;                        // derivative order of a symbol
  std::uint32_t index = 0;                       // symbol, function or rational index
  std::uint32_t first = 0, count = 0;            // flat terms
  std::uint32_t view_first = 0, view_count = 0;  // terms by the chain (sums)
};

// Exact exponent p/q written as {p, q} or as an integer.
struct Exponent {
  Rational value;
  Exponent(int p) : value(p) {}
  Exponent(int p, int q) : value(p, q) {}
  Exponent(Rational r) : value(std::move(r)) {}
};

class Graph {
 public:
  Graph();
  Graph(const Graph&) = delete;
  Graph& operator=(const Graph&) = delete;

  // Leaves.
  Expr number(const Rational& r);
  Expr zero() { return {this, zero_}; }
  Expr one() { return {this, one_}; }
  Expr pi() { return leaf(Kind::pi, 0, 0); }
  Expr time() { return leaf(Kind::time, 0, 0); }
  Expr jet(std::uint32_t coordinate, std::uint32_t order);
  Expr parameter(std::uint32_t index) { return leaf(Kind::parameter, index, 0); }
  Expr mass(std::uint32_t index) { return leaf(Kind::mass, index, 0); }
  Expr multiplier(std::uint32_t constraint, std::uint32_t order);
  Expr given(std::uint32_t function, std::uint32_t order);
  Expr quasi(std::uint32_t index, std::uint32_t order);
  Expr state(std::uint32_t index, std::uint32_t order) { return leaf(Kind::state, index, order); }
  Expr control(std::uint32_t index, std::uint32_t order) { return leaf(Kind::control, index, order); }

  // Canonical constructors.
  Expr sum(std::span<const std::pair<Rational, Expr>> terms);
  Expr product(std::span<const std::pair<Expr, Rational>> factors);
  Expr apply(Function f, Expr argument);
  Expr arctangent2(Expr y, Expr x);
  Expr select(Expr s, Expr a, Expr b);
  Expr lookup(std::uint32_t step_function, Expr argument);
  // Adds a step function unless an equal one exists, and returns its index.
  std::uint32_t add_step_function(StepFunction f);
  const StepFunction& step_function(std::uint32_t index) const { return step_functions_[index]; }

  // Returns the total derivative of a node, if it is known already: expressions that share parts (the links of a chain)
  // are differentiated once. Returns a handle with graph == nullptr if it is not known.
  Expr rate(NodeId id) { return id < rates_.size() && rates_[id] != kUnknown ? Expr{this, rates_[id]} : Expr{}; }
  void set_rate(NodeId id, NodeId rate);

  // After `freeze` the graph never changes: nodes, numbers, rates and step functions that it has are still found, and a
  // request for another one is a broken invariant.
  void freeze() { frozen_ = true; }
  bool frozen() const { return frozen_; }
  // Returns a graph with the same nodes under the same ids in which expressions can be built: new nodes get the ids
  // that they would get here. `nodes`: copies only the first so many nodes.
  std::unique_ptr<Graph> clone() const { return clone(nodes_.size()); }
  std::unique_ptr<Graph> clone(std::size_t nodes) const;
  // Returns the same expression in this graph. `e` belongs to this graph or to a graph of which this one is a clone,
  // directly or through other clones. REQUIRES: `e` is older than the clone.
  Expr own(Expr e);

  // Limits the work of construction: every operand of a sum or product costs one unit, long numbers cost more. After
  // `work` further units construction throws Failure, so a short formula that unfolds without end is refused in time.
  void allow(std::uint64_t work);
  std::uint64_t work() const { return work_; }

  // Reading.
  std::size_t size() const { return nodes_.size(); }
  const Node& node(NodeId id) const { return nodes_[id]; }
  std::span<const Term> terms(NodeId id) const { return terms_.part(nodes_[id].first, nodes_[id].count); }
  // Returns the terms of a sum by its chain, or the operands of any other node: use this for every sweep.
  std::span<const Term> summands(NodeId id) const { return terms_.part(nodes_[id].view_first, nodes_[id].view_count); }
  const Rational& rational(std::uint32_t index) const { return rationals_[index]; }
  const Rational& value(NodeId number) const { return rationals_[nodes_[number].index]; }
  bool is_number(NodeId id) const { return nodes_[id].kind == Kind::number; }

 private:
  static constexpr NodeId kUnknown = 0xffffffffU;

  // A graph of which this one is a clone. The identity outlives the graph, so no other graph is mistaken for it.
  using Identity = std::shared_ptr<const char>;
  struct Ancestor {
    Identity identity;
    std::size_t nodes;  // the number of nodes that are common to both
  };

  class Product;

  std::uint32_t rational_index(const Rational& r);
  void spend(std::uint64_t work);
  Expr leaf(Kind kind, std::uint32_t index, std::uint32_t order);
  NodeId intern(Node node, std::span<const Term> operands, std::span<const Term> view);
  Expr scaled(const Rational& factor, NodeId id);

  StableList<Node> nodes_;
  StableList<Term> terms_;
  StableList<Rational> rationals_;
  HashIndex index_, rational_index_;
  std::vector<NodeId> rates_;
  std::deque<StepFunction> step_functions_;
  std::uint64_t work_ = 0, most_work_ = ~std::uint64_t{0};
  NodeId zero_ = 0, one_ = 0;
  bool frozen_ = false;
  Identity identity_ = std::make_shared<const char>();
  std::vector<Ancestor> ancestors_;
};

bool is_zero(Expr e);  // the node 0 (structurally; see normal.h for the exact zero test)
bool is_number(Expr e);
const Rational& number_value(Expr e);

Expr operator+(Expr a, Expr b);
Expr operator-(Expr a, Expr b);
Expr operator-(Expr a);
Expr operator*(Expr a, Expr b);
Expr operator/(Expr a, Expr b);  // throws Failure if b is the node 0
Expr operator*(const Rational& c, Expr a);
Expr operator+(int c, Expr a);
Expr operator-(int c, Expr a);
Expr operator-(Expr a, int c);
inline Expr operator*(int c, Expr a) { return Rational(c) * a; }
Expr& operator+=(Expr& a, Expr b);
Expr pow(Expr base, const Exponent& exponent);  // throws Failure for 0^negative
inline Expr sqrt(Expr a) { return pow(a, {1, 2}); }
Expr sum(std::span<const Expr> terms);  // all at once

#define ROW(name, ...) Expr name(Expr u);
#include "expr/elementary.def"
#undef ROW
Expr atan2(Expr y, Expr x);
Expr select(Expr s, Expr a, Expr b);  // a where s >= 0, else b

// Returns all nodes on which `roots` depend, by the chains of sums, ascending (operands before users).
std::vector<NodeId> reachable(std::span<const Expr> roots);

}  // namespace anholon
