#include "expr/expr.h"

#include <algorithm>
#include <array>
#include <charconv>

#include "base/assert.h"
#include "base/diagnostic.h"

namespace anholon {

namespace {

enum class Parity : std::uint8_t { none, even, odd };

constexpr std::array kFunctions = {
#define ROW(name, derivative, parity, latex, domain) FunctionInfo{#name, latex, domain},
#include "expr/elementary.def"
#undef ROW
};

constexpr std::array kParity = {
#define ROW(name, derivative, parity, latex, domain) Parity::parity,
#include "expr/elementary.def"
#undef ROW
};

// A product of more factors than this is one factor of a larger product: what a deep chain of functions
// makes of its derivative stays linear in size. Products up to here are flat and so canonical.
constexpr std::uint32_t kOpenedFactors = 64;
// Likewise a sum of more terms is one term of a larger sum: the position of link i of a long chain.
constexpr std::uint32_t kOpenedTerms = 32;

// Numbers of more machine words than the first cost more than one unit of work; numbers of more than the second are
// refused.
constexpr std::size_t kShortNumber = 16, kLongestNumber = 8'000;

// A sum of more terms than this is computed through the partial sum it grew from.
constexpr std::size_t kShortWayFrom = 8;

std::uint64_t mix(std::uint64_t h, std::uint64_t v) {
  h ^= v + 0x9e3779b97f4a7c15ULL + (h << 6) + (h >> 2);
  h *= 0xff51afd7ed558ccdULL;
  return h ^ (h >> 33);
}

}  // namespace

const FunctionInfo& info(Function f) { return kFunctions[static_cast<std::size_t>(f)]; }

int find_function(const std::string& name) {
  for (std::size_t i = 0; i < kFunctions.size(); ++i)
    if (name == kFunctions[i].name) return static_cast<int>(i);
  return -1;
}

Graph::Graph() {
  zero_ = number(0).id;
  one_ = number(1).id;
}

std::unique_ptr<Graph> Graph::clone(std::size_t nodes) const {
  ANHOLON_ASSERT(nodes >= 2 && nodes <= nodes_.size());
  const auto known = [&](NodeId id) { return id < nodes; };
  auto g = std::make_unique<Graph>();
  const bool whole = nodes == nodes_.size();
  // Operands are stored in the order of the nodes.
  const Node& last = nodes_[nodes - 1];
  const std::size_t terms =
      whole ? terms_.size() : std::max(last.first + last.count, last.view_first + last.view_count);
  g->nodes_.assign(nodes_.begin(), nodes_.begin() + static_cast<std::ptrdiff_t>(nodes));
  g->terms_.assign(terms_.begin(), terms_.begin() + static_cast<std::ptrdiff_t>(terms));
  g->rationals_ = rationals_;
  g->rational_index_ = rational_index_;
  g->step_functions_ = step_functions_;
  if (whole) {
    g->index_ = index_;
    g->rates_ = rates_;
  } else {
    g->index_.clear();
    for (const auto& [hash, id] : index_)
      if (known(id)) g->index_.emplace(hash, id);
    g->rates_.assign(rates_.begin(), rates_.begin() + static_cast<std::ptrdiff_t>(std::min(nodes, rates_.size())));
    for (NodeId& rate : g->rates_)
      if (!known(rate)) rate = kUnknown;
  }
  g->work_ = work_;
  g->most_work_ = most_work_;
  g->ancestors_ = ancestors_;
  for (Ancestor& a : g->ancestors_) a.nodes = std::min(a.nodes, nodes);
  g->ancestors_.push_back({identity_, nodes});
  return g;
}

Expr Graph::own(Expr e) {
  if (e.graph == this) return e;
  ANHOLON_ASSERT(e.graph != nullptr);
  const auto from = std::find_if(ancestors_.begin(), ancestors_.end(),
                                 [&](const Ancestor& a) { return a.identity == e.graph->identity_; });
  ANHOLON_ASSERT(from != ancestors_.end() && e.id < from->nodes);
  return {this, e.id};
}

void Graph::set_rate(NodeId id, NodeId rate) {
  ANHOLON_ASSERT(!frozen_);
  if (rates_.size() <= id) rates_.resize(nodes_.size(), kUnknown);
  rates_[id] = rate;
}

void Graph::allow(std::uint64_t work) {
  ANHOLON_ASSERT(!frozen_);
  most_work_ = work_ + work;
}

void Graph::spend(std::uint64_t work) {
  if (frozen_) return;  // nothing is constructed, and many threads may look things up
  work_ += work;
  if (work_ > most_work_)
    throw Failure(Span{}, "the expressions grow out of all proportion",
                  "fewer derivatives or powers, or fewer definitions within definitions");
}

// Short numbers, most of them, without what GMP takes to write a number.
static std::string key(const Rational& r) {
  if (!r.get_num().fits_slong_p() || !r.get_den().fits_slong_p()) return r.get_str(62);
  std::array<char, 24> digits;
  const auto text = [&digits](long n) {
    return std::string_view(digits.data(), std::to_chars(digits.data(), digits.data() + digits.size(), n).ptr);
  };
  std::string key("#");  // no digit
  key += text(r.get_num().get_si());
  if (r.get_den() != 1) key += '/', key += text(r.get_den().get_si());
  return key;
}

std::uint32_t Graph::rational_index(const Rational& r) {
  if (one_ != 0 && r == 1) return nodes_[one_].index;  // most of them
  // Arithmetic with long numbers and their text take time that grows with their square.
  if (const std::size_t limbs = mpz_size(r.get_num_mpz_t()) + mpz_size(r.get_den_mpz_t()); limbs > kShortNumber) {
    if (limbs > kLongestNumber)
      throw Failure(Span{}, "a number of more than " + std::to_string(kLongestNumber * 19) + " digits");
    spend(limbs * limbs / kShortNumber);
  }
  if (frozen_) {
    const auto known = rational_index_.find(key(r));
    ANHOLON_ASSERT(known != rational_index_.end());
    return known->second;
  }
  const auto [it, fresh] = rational_index_.try_emplace(key(r), static_cast<std::uint32_t>(rationals_.size()));
  if (fresh) rationals_.push_back(r);
  return it->second;
}

NodeId Graph::intern(Node node, std::span<const Term> operands, std::span<const Term> view) {
  std::uint64_t h = mix(static_cast<std::uint64_t>(node.kind), node.index);
  h = mix(h, node.order);
  for (const Term& t : operands) h = mix(mix(h, t.weight), t.node);
  const auto [begin, end] = index_.equal_range(h);
  for (auto it = begin; it != end; ++it) {
    const Node& other = nodes_[it->second];
    if (other.kind != node.kind || other.index != node.index || other.order != node.order ||
        other.count != operands.size())
      continue;
    const std::span<const Term> theirs = terms(it->second);
    if (std::equal(operands.begin(), operands.end(), theirs.begin(),
                   [](const Term& a, const Term& b) { return a.weight == b.weight && a.node == b.node; }))
      return it->second;
  }
  ANHOLON_ASSERT(!frozen_);
  node.first = node.view_first = static_cast<std::uint32_t>(terms_.size());
  node.count = node.view_count = static_cast<std::uint32_t>(operands.size());
  terms_.insert(terms_.end(), operands.begin(), operands.end());
  if (!view.empty()) {
    node.view_first = static_cast<std::uint32_t>(terms_.size());
    node.view_count = static_cast<std::uint32_t>(view.size());
    terms_.insert(terms_.end(), view.begin(), view.end());
  }
  const NodeId id = static_cast<NodeId>(nodes_.size());
  ANHOLON_ASSERT(id < 0xffffffffU);
  nodes_.push_back(node);
  index_.emplace(h, id);
  return id;
}

Expr Graph::leaf(Kind kind, std::uint32_t index, std::uint32_t order) {
  ANHOLON_ASSERT(order < 256);
  return {this, intern(Node{kind, static_cast<std::uint8_t>(order), index}, {}, {})};
}

Expr Graph::number(const Rational& r) { return leaf(Kind::number, rational_index(r), 0); }
Expr Graph::jet(std::uint32_t c, std::uint32_t order) { return leaf(Kind::jet, c, order); }
Expr Graph::multiplier(std::uint32_t c, std::uint32_t order) { return leaf(Kind::multiplier, c, order); }
Expr Graph::given(std::uint32_t f, std::uint32_t order) { return leaf(Kind::given, f, order); }
Expr Graph::quasi(std::uint32_t u, std::uint32_t order) { return leaf(Kind::quasi, u, order); }

Expr Graph::sum(std::span<const std::pair<Rational, Expr>> operands) {
  struct Part {
    NodeId node;
    Rational coefficient;
  };
  spend(operands.size());
  std::vector<Part> parts;
  std::size_t most = 0;
  for (const auto& [factor, e] : operands) ANHOLON_ASSERT(e.graph == this);
  for (const auto& [factor, e] : operands)
    most += nodes_[e.id].kind == Kind::sum && nodes_[e.id].count <= kOpenedTerms ? nodes_[e.id].count : 1;
  parts.reserve(most);
  NodeId longest = zero_;  // the operand sum with most terms, candidate for the short way
  Rational longest_factor;
  for (const auto& [factor, e] : operands) {
    if (factor == 0) continue;
    const Node& n = nodes_[e.id];
    if (n.kind == Kind::number) {
      parts.push_back({one_, factor * value(e.id)});
    } else if (n.kind == Kind::sum && n.count > kOpenedTerms) {
      parts.push_back({e.id, factor});
    } else if (n.kind == Kind::sum) {
      spend(n.count);
      for (const Term& t : terms(e.id)) parts.push_back({t.node, factor * rational(t.weight)});
      if (n.count > 1 && (longest == zero_ || n.count > nodes_[longest].count)) longest = e.id, longest_factor = factor;
    } else {
      parts.push_back({e.id, factor});
    }
  }
  std::stable_sort(parts.begin(), parts.end(), [](const Part& a, const Part& b) { return a.node < b.node; });
  std::vector<Part> merged;
  merged.reserve(parts.size());
  for (Part& p : parts) {
    if (!merged.empty() && merged.back().node == p.node)
      merged.back().coefficient += p.coefficient;
    else
      merged.push_back(std::move(p));
  }
  std::erase_if(merged, [](const Part& p) { return p.coefficient == 0; });
  if (merged.empty()) return zero();
  if (merged.size() == 1) {
    if (merged[0].node == one_) return number(merged[0].coefficient);
    if (merged[0].coefficient == 1) return {this, merged[0].node};
  }
  std::vector<Term> flat;
  for (const Part& p : merged) flat.push_back({rational_index(p.coefficient), p.node});

  std::vector<Term> view;
  if (longest != zero_ && flat.size() > kShortWayFrom) {
    // The short way holds if the longest operand survives whole: flat = factor * longest + rest.
    view.push_back({rational_index(longest_factor), longest});
    std::size_t matched = 0;
    const std::span<const Term> inner = terms(longest);
    for (const Part& p : merged) {
      if (matched < inner.size() && inner[matched].node == p.node) {
        if (longest_factor * rational(inner[matched].weight) != p.coefficient) break;
        ++matched;
      } else {
        view.push_back({rational_index(p.coefficient), p.node});
      }
    }
    if (matched != inner.size() || view.size() >= flat.size()) view.clear();
  }
  return {this, intern(Node{Kind::sum}, flat, view)};
}

Expr Graph::scaled(const Rational& factor, NodeId id) {
  const std::pair<Rational, Expr> one_term[] = {{factor, Expr{this, id}}};
  return sum(one_term);
}

static Rational floor(const Rational& r) {
  mpz_class q;
  mpz_fdiv_q(q.get_mpz_t(), r.get_num_mpz_t(), r.get_den_mpz_t());
  return q;
}

// The rational content of a sum, with the sign that makes its first coefficient positive.
static Rational content(const Graph& g, NodeId id) {
  const std::span<const Term> terms = g.terms(id);
  const bool negative = g.rational(terms[0].weight) < 0;
  bool whole = true, unit = false;
  for (const Term& t : terms) {
    const Rational& c = g.rational(t.weight);
    whole = whole && c.get_den() == 1;
    unit = unit || mpz_cmpabs_ui(c.get_num_mpz_t(), 1) == 0;
  }
  if (whole && unit) return negative ? -1 : 1;
  mpz_class num = 0, den = 1;
  for (const Term& t : terms) {
    const Rational& c = g.rational(t.weight);
    num = gcd(num, c.get_num());
    den = lcm(den, c.get_den());
  }
  Rational r(num, den);
  r.canonicalize();
  return negative ? Rational(-r) : r;
}

Expr Graph::product(std::span<const std::pair<Expr, Rational>> operands) {
  struct Part {
    NodeId node;
    Rational exponent;
  };
  Rational coefficient = 1;
  std::vector<Part> parts;
  // Operands are opened one level at a time: c*x inside a product gives up c, a product its factors.
  std::vector<Part> pending;
  for (auto it = operands.rbegin(); it != operands.rend(); ++it) {
    ANHOLON_ASSERT(it->first.graph == this);
    pending.push_back({it->first.id, it->second});
  }
  while (!pending.empty()) {
    Part p = std::move(pending.back());
    pending.pop_back();
    if (p.exponent == 0) continue;
    const Node n = nodes_[p.node];
    spend(n.kind == Kind::sum ? 1 + n.count : 1);
    const bool integer = p.exponent.get_den() == 1;
    if (n.kind == Kind::number) {
      const Rational& v = value(p.node);
      if (v == 1) continue;
      if (v == 0) {
        if (p.exponent < 0) throw Failure(Span{}, "division by zero");
        return zero();
      }
      std::optional<Rational> power;
      if (integer && p.exponent.get_num().fits_slong_p()) {
        power = exact_power(v, p.exponent.get_num().get_si());
      } else if (p.exponent.get_den().fits_ulong_p() && p.exponent.get_num().fits_slong_p()) {
        if (auto root = exact_root(v, p.exponent.get_den().get_ui()))
          power = exact_power(*root, p.exponent.get_num().get_si());
      }
      if (power) {
        coefficient *= *power;
      } else if (const Rational whole = floor(p.exponent); !integer && whole != 0) {
        pending.push_back({p.node, whole});  // 2^(3/2) = 2 * 2^(1/2)
        parts.push_back({p.node, p.exponent - whole});
      } else {
        parts.push_back(std::move(p));
      }
    } else if (n.kind == Kind::sum) {
      // A positive content comes out of any power, a sign out of a whole one. A long sum stays as it is: what is scaled
      // by its content would be one term, which gives the factor back.
      const Rational c = n.count == 1             ? rational(terms_[n.first].weight)
                         : n.count > kOpenedTerms ? Rational(1)
                                                  : content(*this, p.node);
      const Rational out = integer ? c : Rational(abs(c));
      const bool whole_out = integer && exact_power(c, p.exponent.get_num().get_si());
      if (out != 1 && (whole_out || !integer)) {
        pending.push_back({number(out).id, p.exponent});
        pending.push_back({scaled(1 / out, p.node).id, p.exponent});
      } else if (const Rational whole = floor(p.exponent); c < 0 && !integer && whole != 0) {
        pending.push_back({p.node, whole});
        parts.push_back({p.node, p.exponent - whole});
      } else {
        parts.push_back(std::move(p));
      }
    } else if (n.kind == Kind::product && n.count <= kOpenedFactors && (integer || n.count == 1)) {
      // (x^r)^n = x^(rn) for integer n; (x^r)^s = x^(rs) only where x^r keeps the sign of x.
      const std::span<const Term> inner = terms(p.node);
      if (!integer && rational(inner[0].weight).get_den() == 1) {
        parts.push_back(std::move(p));
        continue;
      }
      std::vector<Part> opened;
      for (const Term& t : inner) opened.push_back({t.node, rational(t.weight) * p.exponent});
      for (Part& o : opened) pending.push_back(std::move(o));
    } else {
      parts.push_back(std::move(p));
    }
  }
  std::stable_sort(parts.begin(), parts.end(), [](const Part& a, const Part& b) { return a.node < b.node; });
  std::vector<Part> merged;
  bool joined = false;
  for (Part& p : parts) {
    if (!merged.empty() && merged.back().node == p.node) {
      merged.back().exponent += p.exponent;
      joined = true;
    } else {
      merged.push_back(std::move(p));
    }
  }
  std::erase_if(merged, [](const Part& p) { return p.exponent == 0; });
  // A number, negative sum or product whose exponents joined may open up: sqrt(2)*sqrt(2) = 2.
  const auto opens = [&](const Part& p) {
    const Node& n = nodes_[p.node];
    const bool integer = p.exponent.get_den() == 1, proper = p.exponent > 0 && p.exponent < 1;
    if (n.kind == Kind::number) return integer || !proper;
    if (n.kind == Kind::product) return integer && n.count <= kOpenedFactors;
    if (n.kind != Kind::sum) return false;
    const Rational c = n.count == 1 ? rational(terms_[n.first].weight) : content(*this, p.node);
    return c < 0 && (integer || !proper);
  };
  if (joined && std::any_of(merged.begin(), merged.end(), opens)) {
    std::vector<std::pair<Expr, Rational>> factors;
    for (const Part& p : merged) factors.push_back({Expr{this, p.node}, p.exponent});
    return scaled(coefficient, product(factors).id);
  }
  if (merged.empty()) return number(coefficient);
  NodeId id = merged[0].node;
  if (merged.size() > 1 || merged[0].exponent != 1) {
    std::vector<Term> flat;
    for (const Part& p : merged) flat.push_back({rational_index(p.exponent), p.node});
    id = intern(Node{Kind::product}, flat, {});
  }
  return coefficient == 1 ? Expr{this, id} : scaled(coefficient, id);
}

// True if the expression is written with a leading minus sign.
static bool negative(const Graph& g, NodeId id) {
  const Node& n = g.node(id);
  if (n.kind == Kind::number) return g.value(id) < 0;
  return n.kind == Kind::sum && g.rational(g.terms(id)[0].weight) < 0;
}

// The value at a rational argument, where it is rational.
static std::optional<Rational> exact_value(Function f, const Rational& x) {
  switch (f) {
  case Function::sin:
  case Function::tan:
  case Function::asin:
  case Function::atan:
  case Function::sinh:
  case Function::tanh:
  case Function::asinh:
  case Function::atanh:
    if (x == 0) return Rational(0);
    return std::nullopt;
  case Function::cos:
  case Function::cosh:
  case Function::exp:
    if (x == 0) return Rational(1);
    return std::nullopt;
  case Function::log:
  case Function::acos:
  case Function::acosh:
    if (x == 1) return Rational(0);
    return std::nullopt;
  case Function::abs:
    return Rational(::abs(x));
  case Function::sign:
    return Rational(sgn(x));
  }
  return std::nullopt;
}

// sin and cos at a rational multiple of pi with rational value.
static std::optional<Rational> value_at_pi(const Graph& g, Function f, NodeId x) {
  const Node& n = g.node(x);
  Rational turns;  // x = turns * pi
  if (n.kind == Kind::pi)
    turns = 1;
  else if (n.kind == Kind::sum && n.count == 1 && g.node(g.terms(x)[0].node).kind == Kind::pi)
    turns = g.rational(g.terms(x)[0].weight);
  else
    return std::nullopt;
  if (f != Function::sin && f != Function::cos) return std::nullopt;
  Rational sixths = turns * 6;
  if (sixths.get_den() != 1) return std::nullopt;
  mpz_class k = f == Function::cos ? mpz_class(sixths.get_num() + 3) : sixths.get_num();
  const unsigned long step = mpz_fdiv_ui(k.get_mpz_t(), 12);  // sin(step * pi/6)
  switch (step) {
  case 0:
  case 6:
    return Rational(0);
  case 1:
  case 5:
    return Rational(1, 2);
  case 3:
    return Rational(1);
  case 7:
  case 11:
    return Rational(-1, 2);
  case 9:
    return Rational(-1);
  default:
    return std::nullopt;
  }
}

Expr Graph::apply(Function f, Expr x) {
  if (is_number(x.id))
    if (auto v = exact_value(f, value(x.id))) return number(*v);
  if (auto v = value_at_pi(*this, f, x.id)) return number(*v);
  if (negative(*this, x.id)) {
    switch (kParity[static_cast<std::size_t>(f)]) {
    case Parity::even:
      return apply(f, -x);
    case Parity::odd:
      return -apply(f, -x);
    case Parity::none:
      break;
    }
  }
  const Term operand[] = {{0, x.id}};
  return {this, intern(Node{Kind::function, 0, static_cast<std::uint32_t>(f)}, operand, {})};
}

Expr Graph::arctangent2(Expr y, Expr x) {
  if (anholon::is_zero(y) && anholon::is_number(x) && number_value(x) > 0) return zero();
  const Term operands[] = {{0, y.id}, {0, x.id}};
  return {this, intern(Node{Kind::atan2}, operands, {})};
}

Expr Graph::select(Expr s, Expr a, Expr b) {
  if (a == b) return a;
  if (is_number(s.id)) return value(s.id) >= 0 ? a : b;
  const Term operands[] = {{0, s.id}, {0, a.id}, {0, b.id}};
  return {this, intern(Node{Kind::select}, operands, {})};
}

Expr Graph::lookup(std::uint32_t f, Expr x) {
  const StepFunction& table = step_functions_[f];
  if (std::all_of(table.values.begin(), table.values.end(), [&](const Rational& v) { return v == table.values[0]; }))
    return number(table.values[0]);
  if (is_number(x.id)) {
    const auto above = std::upper_bound(table.knots.begin(), table.knots.end(), value(x.id));
    return number(table.values[static_cast<std::size_t>(above - table.knots.begin())]);
  }
  const Term operand[] = {{0, x.id}};
  return {this, intern(Node{Kind::lookup, 0, f}, operand, {})};
}

std::uint32_t Graph::add_step_function(StepFunction f) {
  ANHOLON_ASSERT(f.values.size() == f.knots.size() + 1);
  const auto known = std::find(step_functions_.begin(), step_functions_.end(), f);
  if (known != step_functions_.end()) return static_cast<std::uint32_t>(known - step_functions_.begin());
  ANHOLON_ASSERT(!frozen_);
  step_functions_.push_back(std::move(f));
  return static_cast<std::uint32_t>(step_functions_.size() - 1);
}

bool is_zero(Expr e) { return e.graph->is_number(e.id) && e.graph->value(e.id) == 0; }
bool is_number(Expr e) { return e.graph->is_number(e.id); }
const Rational& number_value(Expr e) { return e.graph->value(e.id); }

static Expr linear(const Rational& ca, Expr a, const Rational& cb, Expr b) {
  const std::pair<Rational, Expr> terms[] = {{ca, a}, {cb, b}};
  return a.graph->sum(terms);
}

Expr operator+(Expr a, Expr b) { return linear(1, a, 1, b); }
Expr operator-(Expr a, Expr b) { return linear(1, a, -1, b); }
Expr operator-(Expr a) { return Rational(-1) * a; }
Expr operator*(const Rational& c, Expr a) {
  const std::pair<Rational, Expr> terms[] = {{c, a}};
  return a.graph->sum(terms);
}
Expr operator*(Expr a, Expr b) {
  const std::pair<Expr, Rational> factors[] = {{a, 1}, {b, 1}};
  return a.graph->product(factors);
}
Expr operator/(Expr a, Expr b) {
  const std::pair<Expr, Rational> factors[] = {{a, 1}, {b, -1}};
  return a.graph->product(factors);
}
Expr operator+(int c, Expr a) { return linear(c, a.graph->one(), 1, a); }
Expr operator-(int c, Expr a) { return linear(c, a.graph->one(), -1, a); }
Expr operator-(Expr a, int c) { return linear(1, a, -c, a.graph->one()); }
Expr& operator+=(Expr& a, Expr b) { return a = a + b; }

Expr pow(Expr base, const Exponent& exponent) {
  const std::pair<Expr, Rational> factors[] = {{base, exponent.value}};
  return base.graph->product(factors);
}

Expr sum(std::span<const Expr> terms) {
  ANHOLON_ASSERT(!terms.empty());
  std::vector<std::pair<Rational, Expr>> parts;
  for (Expr e : terms) parts.push_back({1, e});
  return terms[0].graph->sum(parts);
}

#define ROW(name, derivative, parity, latex, domain)                                                                   \
  Expr name(Expr u) { return u.graph->apply(Function::name, u); }
#include "expr/elementary.def"
#undef ROW

Expr select(Expr s, Expr a, Expr b) { return s.graph->select(s, a, b); }
Expr atan2(Expr y, Expr x) { return y.graph->arctangent2(y, x); }

std::vector<NodeId> reachable(std::span<const Expr> roots) {
  std::vector<NodeId> found;
  if (roots.empty()) return found;
  const Graph& g = *roots[0].graph;
  std::vector<bool> seen(g.size(), false);
  for (Expr e : roots)
    if (!seen[e.id]) seen[e.id] = true, found.push_back(e.id);
  for (std::size_t i = 0; i < found.size(); ++i)
    for (const Term& t : g.summands(found[i]))
      if (!seen[t.node]) seen[t.node] = true, found.push_back(t.node);
  std::sort(found.begin(), found.end());
  return found;
}

}  // namespace anholon
