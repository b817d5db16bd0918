#include "expr/expr.h"

#include <algorithm>

#include "base/assert.h"
#include "base/diagnostic.h"
#include "base/stop.h"

namespace anholon {

namespace {

// Numbers with more machine words than the first limit cost more than one unit of work; numbers with more than the
// second are refused.
constexpr std::size_t kShortNumber = 16, kLongestNumber = 8'000;

}  // namespace

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
  g->nodes_.assign(nodes_, nodes);
  g->terms_.assign(terms_, terms);
  g->rationals_.assign(rationals_, rationals_.size());
  g->rational_index_ = rational_index_;
  g->step_functions_ = step_functions_;
  if (whole) {
    g->index_ = index_;
    g->rates_ = rates_;
  } else {
    g->index_ = index_.before(static_cast<NodeId>(nodes));
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
  if (frozen_) return;  // nothing is constructed, and many threads may search the graph
  work_ += work;
  if (work_ > most_work_)
    throw Failure(Span{}, "the expressions grow out of all proportion",
                  "fewer derivatives or powers, or fewer definitions within definitions");
}

std::uint32_t Graph::rational_index(const Rational& r) {
  if (one_ != 0 && r == 1) return nodes_[one_].index;  // the most frequent number
  // Arithmetic with long numbers and their text take time that grows with their square.
  if (!r.fits_long()) {
    const std::size_t limbs = r.limbs();
    if (limbs > kLongestNumber)
      throw Failure(Span{}, "a number of more than " + std::to_string(kLongestNumber * 19) + " digits");
    if (limbs > kShortNumber) spend(limbs * limbs / kShortNumber);
  }
  const std::uint64_t hash = mixed(r.hash(), 0);
  const std::uint32_t known = rational_index_.find(hash, [&](std::uint32_t k) { return rationals_[k] == r; });
  if (known != HashIndex::kNone) return known;
  ANHOLON_ASSERT(!frozen_);
  const auto index = static_cast<std::uint32_t>(rationals_.size());
  rational_index_.insert(hash, index);
  rationals_.push_back(r);
  return index;
}

NodeId Graph::intern(Node node, std::span<const Term> operands, std::span<const Term> view) {
  look_for_stop();
  std::uint64_t h = mixed(static_cast<std::uint64_t>(node.kind), node.index);
  h = mixed(h, node.order);
  for (const Term& t : operands) h = mixed(mixed(h, t.weight), t.node);
  const NodeId known = index_.find(h, [&](NodeId id) {
    const Node& other = nodes_[id];
    return other.kind == node.kind && other.index == node.index && other.order == node.order &&
           std::ranges::equal(operands, terms(id),
                              [](const Term& a, const Term& b) { return a.weight == b.weight && a.node == b.node; });
  });
  if (known != HashIndex::kNone) return known;
  ANHOLON_ASSERT(!frozen_);
  node.first = node.view_first = static_cast<std::uint32_t>(terms_.append(operands));
  node.count = node.view_count = static_cast<std::uint32_t>(operands.size());
  if (!view.empty()) {
    node.view_first = static_cast<std::uint32_t>(terms_.append(view));
    node.view_count = static_cast<std::uint32_t>(view.size());
  }
  const NodeId id = static_cast<NodeId>(nodes_.size());
  ANHOLON_ASSERT(id < 0xffffffffU);
  nodes_.push_back(node);
  index_.insert(h, id);
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
  // Reading the marks in order takes less time than sorting, unless they are few and far between.
  constexpr std::size_t kFar = 64;
  const NodeId last = *std::max_element(found.begin(), found.end());
  if (last / kFar > found.size()) {
    std::sort(found.begin(), found.end());
    return found;
  }
  found.clear();
  for (NodeId id = 0; id <= last; ++id)
    if (seen[id]) found.push_back(id);
  return found;
}

}  // namespace anholon
