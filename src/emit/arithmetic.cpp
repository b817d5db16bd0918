#include "emit/arithmetic.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <map>
#include <optional>
#include <unordered_map>

#include "base/assert.h"
#include "tape/operands.h"

namespace anholon::emit {

namespace {

using Kind = Arithmetic::Kind;
using Node = Arithmetic::Node;
using Term = Arithmetic::Term;
using Value = Arithmetic::Value;
using Id = std::uint32_t;

constexpr std::uint32_t kNone = Arithmetic::kNone;
constexpr long kLargestPower = 4;  // whole powers up to this exponent are products
// The most factors of a product into which the products among its factors are merged.
constexpr std::size_t kMostFactors = 12;
constexpr std::size_t kMostPairs = 20'000;  // the most pairs for which products search common pairs

// Builds the nodes of a tape. Parameters have numbers, so expressions that do not depend on t and x are numbers.
class Builder {
 public:
  Builder(const Tape& tape, std::unordered_map<NodeId, std::string> names) : tape_(tape), names_(std::move(names)) {
    out_.step_functions = tape.step_functions;
  }

  Arithmetic run() {
    const std::size_t size = tape_.code.size();
    count_uses();
    Machine<double> numbers(tape_, 0, {});
    if (size > 0) numbers.evaluate();
    values_.resize(size);
    std::vector<bool> varies(size, false);
    std::unordered_map<std::uint32_t, std::string> inputs;
    for (const Input& in : tape_.inputs) inputs[in.slot] = names_.at(in.symbol);
    for (std::uint32_t s = 0; s < size; ++s) {
      if (!needed_[s]) continue;
      const Instruction& in = tape_.code[s];
      varies[s] = in.op == Op::input;
      for (const std::uint32_t k : operands(s)) varies[s] = varies[s] || varies[k];
      if (varies[s])
        values_[s] = in.op == Op::input ? whole(intern({Kind::input, inputs.at(s)})) : of_slot(s);
      else if (!exact(s))
        values_[s] = number(numbers.series(s)[0]);
    }
    for (const std::uint32_t root : tape_.roots) out_.roots.push_back(values_[root]);
    for (Id i = 0; i < out_.nodes.size(); ++i)
      if (out_.nodes[i].kind == Kind::sum) factor_out(i);
    leave_out_sums_of_one_term();
    fold_into_sums();
    share_pairs();
    return std::move(out_);
  }

 private:
  std::vector<std::uint32_t> operands(std::uint32_t s) const {
    std::vector<std::uint32_t> out;
    for_each_operand(tape_, tape_.code[s], [&](std::uint32_t k) { out.push_back(k); });
    return out;
  }

  void count_uses() {
    needed_.assign(tape_.code.size(), false);
    uses_.assign(tape_.code.size(), 0);
    for (const std::uint32_t root : tape_.roots) needed_[root] = true, ++uses_[root];
    for (std::size_t s = tape_.code.size(); s-- > 0;)
      if (needed_[s])
        for (const std::uint32_t k : operands(static_cast<std::uint32_t>(s))) needed_[k] = true, ++uses_[k];
  }

  // Computes a number exactly if its operands are rational and the result is rational.
  bool exact(std::uint32_t s) {
    const Instruction& in = tape_.code[s];
    if (in.op == Op::constant) {
      values_[s] = {tape_.rationals[in.index], kNone};
      return true;
    }
    for (const std::uint32_t k : operands(s))
      if (values_[k].node != kNone) return false;
    if (in.op == Op::divide && values_[in.b].coefficient == 0) return false;
    if (in.op != Op::linear && in.op != Op::multiply && in.op != Op::scale && in.op != Op::square &&
        in.op != Op::divide)
      return false;
    values_[s] = of_slot(s);
    return true;
  }

  Value number(double x) {
    if (std::isfinite(x)) return {Rational(x), kNone};
    return whole(intern({Kind::number, std::isnan(x) ? "nan" : x > 0 ? "inf" : "-inf"}));
  }

  static Value whole(Id node) { return {1, node}; }

  Id intern(Node n) {
    std::string key = std::to_string(static_cast<int>(n.kind)) + " " + n.text + " " + n.number.get_str() + " " +
                      std::to_string(n.index);
    for (const Term& t : n.terms) key += " " + t.coefficient.get_str() + "*" + std::to_string(t.node);
    for (const Id id : n.of) key += " " + std::to_string(id);
    const auto [at, fresh] = known_.try_emplace(std::move(key), static_cast<Id>(out_.nodes.size()));
    if (fresh) out_.nodes.push_back(std::move(n));
    return at->second;
  }

  // Returns a value as an operand of a node that is neither a product nor a sum.
  Id node_of(const Value& v) {
    if (v.node == kNone) return intern({Kind::number, {}, v.coefficient});
    return v.coefficient == 1 ? v.node : intern({Kind::sum, {}, 0, {{v.coefficient, v.node}}});
  }

  Id product(std::vector<Id> factors) {
    if (factors.size() == 1) return factors[0];
    std::sort(factors.begin(), factors.end());
    return intern({Kind::product, {}, {}, {}, std::move(factors)});
  }

  Value multiplied(const Value& a, const Value& b, bool open_a, bool open_b) {
    Value out{a.coefficient * b.coefficient, kNone};
    if (out.coefficient == 0) return out;
    std::vector<Id> factors;
    const auto add = [&](Id node, bool open) {
      if (node == kNone) return;
      const std::vector<Id>& of = out_.nodes[node].of;
      if (open && out_.nodes[node].kind == Kind::product && factors.size() + of.size() <= kMostFactors)
        factors.insert(factors.end(), of.begin(), of.end());
      else
        factors.push_back(node);
    };
    add(a.node, open_a);
    add(b.node, open_b);
    if (!factors.empty()) out.node = product(std::move(factors));
    return out;
  }

  Value reciprocal(const Value& v) {
    if (v.node == kNone && v.coefficient == 0) return whole(intern({Kind::reciprocal, {}, {}, {}, {node_of(v)}}));
    Value out{1 / v.coefficient, v.node};
    if (v.node == kNone) return out;
    const Node& n = out_.nodes[v.node];
    out.node = n.kind == Kind::reciprocal ? n.of[0] : intern({Kind::reciprocal, {}, {}, {}, {v.node}});
    return out;
  }

  // Returns the sum up to a factor: the coefficient size that occurs most often becomes 1.
  Value sum(const Rational& constant, const std::vector<Term>& terms) {
    std::vector<Term> merged;
    for (const Term& t : terms) {
      const auto same = std::find_if(merged.begin(), merged.end(), [&](const Term& m) { return m.node == t.node; });
      if (same == merged.end())
        merged.push_back(t);
      else
        same->coefficient += t.coefficient;
    }
    std::erase_if(merged, [](const Term& t) { return t.coefficient == 0; });
    if (merged.empty()) return {constant, kNone};
    if (merged.size() == 1 && constant == 0) return {merged[0].coefficient, merged[0].node};
    std::sort(merged.begin(), merged.end(), [](const Term& a, const Term& b) { return a.node < b.node; });
    std::map<Rational, std::size_t> sizes;
    for (const Term& t : merged) ++sizes[abs(t.coefficient)];
    Rational scale = abs(merged[0].coefficient);
    for (const auto& [size, count] : sizes)
      if (count > sizes[scale]) scale = size;
    if (merged[0].coefficient < 0) scale = -scale;
    for (Term& t : merged) t.coefficient /= scale;
    return {scale, intern({Kind::sum, {}, constant / scale, std::move(merged)})};
  }

  Value linear(const Instruction& in) {
    Rational constant = 0;
    std::vector<Term> terms;
    for (std::uint32_t k = in.first; k < in.first + in.count; ++k) {
      const std::uint32_t slot = tape_.linear_terms[k].slot;
      const Value& v = values_[slot];
      const Rational c = tape_.rationals[tape_.linear_terms[k].coefficient] * v.coefficient;
      if (v.node == kNone) {
        constant += c;
      } else if (const Node& n = out_.nodes[v.node]; n.kind == Kind::sum && uses_[slot] == 1) {
        constant += c * n.number;
        for (const Term& t : n.terms) terms.push_back({c * t.coefficient, t.node});
      } else {
        terms.push_back({c, v.node});
      }
    }
    return sum(constant, terms);
  }

  Value power(const Value& v, const Rational& exponent) {
    if (exponent.is_integer() && abs(exponent) <= kLargestPower) {
      Value out{1, kNone};
      for (long k = std::abs(exponent.to_long()); k > 0; --k) out = multiplied(out, v, true, false);
      return exponent < 0 ? reciprocal(out) : out;
    }
    if (exponent < 0) return reciprocal(whole(intern({Kind::power, {}, -exponent, {}, {node_of(v)}})));
    return whole(intern({Kind::power, {}, exponent, {}, {node_of(v)}}));
  }

  // Returns exp(c*log(x)) as x^c.
  std::optional<Value> power_of_logarithm(const Value& v) {
    if (v.node == kNone) return std::nullopt;
    const Node& n = out_.nodes[v.node];
    if (n.kind != Kind::function || static_cast<Function>(n.index) != Function::log) return std::nullopt;
    return power(whole(n.of[0]), v.coefficient);
  }

  Value of_slot(std::uint32_t s) {
    const Instruction& in = tape_.code[s];
    switch (in.op) {
    case Op::linear:
      return linear(in);
    case Op::multiply:
    case Op::scale:
      return multiplied(values_[in.a], values_[in.b], uses_[in.a] == 1, uses_[in.b] == 1);
    case Op::square:
      return multiplied(values_[in.a], values_[in.a], false, false);
    case Op::divide:
      return multiplied(values_[in.a], reciprocal(values_[in.b]), uses_[in.a] == 1, false);
    case Op::power:
      return power(values_[in.a], tape_.rationals[in.index]);
    case Op::function:
      if (static_cast<Function>(in.index) == Function::exp)
        if (const auto power = power_of_logarithm(values_[in.a])) return *power;
      return whole(intern({Kind::function, {}, {}, {}, {node_of(values_[in.a])}, in.index}));
    case Op::arctan2:
      return whole(intern({Kind::arctan2, {}, {}, {}, {node_of(values_[in.a]), node_of(values_[in.b])}}));
    case Op::select:
      return whole(intern(
          {Kind::select, {}, {}, {}, {node_of(values_[in.first]), node_of(values_[in.a]), node_of(values_[in.b])}}));
    case Op::lookup:
      return whole(intern({Kind::lookup, {}, {}, {}, {node_of(values_[in.a])}, in.index}));
    case Op::constant:
    case Op::pi:
    case Op::input:
    case Op::parameter:
    case Op::rate:
      break;
    }
    ANHOLON_ASSERT(!"an operation that a formula does not have");
    return {};
  }

  // Takes out of the terms the factor that most of them share, as long as two share one.
  void factor_out(Id id) {
    const std::vector<std::size_t> uses = out_.uses();
    if (uses[id] == 0) return;
    for (;;) {
      // A product that also has other users is computed anyway.
      const auto factors = [&](const Term& t) {
        const Node& n = out_.nodes[t.node];
        std::vector<Id> out;
        if (n.kind == Kind::product && t.node < uses.size() && uses[t.node] == 1) out = n.of;
        if (out.empty()) out.push_back(t.node);
        out.erase(std::unique(out.begin(), out.end()), out.end());
        return out;
      };
      std::map<Id, std::size_t> count;
      for (const Term& t : out_.nodes[id].terms)
        for (const Id f : factors(t)) ++count[f];
      Id best = kNone;
      for (const auto& [f, times] : count)
        if (times >= 2 && (best == kNone || times > count[best])) best = f;
      if (best == kNone) return;
      std::vector<Term> others, inner;
      Rational constant = 0;
      for (const Term& t : std::vector<Term>(out_.nodes[id].terms)) {
        const std::vector<Id> all = factors(t);
        if (std::find(all.begin(), all.end(), best) == all.end()) {
          others.push_back(t);
        } else if (t.node == best) {
          constant += t.coefficient;
        } else {
          std::vector<Id> rest = out_.nodes[t.node].of;
          rest.erase(std::find(rest.begin(), rest.end(), best));
          inner.push_back({t.coefficient, product(std::move(rest))});
        }
      }
      const Value within = sum(constant, inner);
      const Value term = multiplied(within, whole(best), false, false);
      if (term.node != kNone) others.push_back({term.coefficient, term.node});
      out_.nodes[id].terms = std::move(others);
    }
  }

  // Removes sums of one term, which factor_out leaves.
  void leave_out_sums_of_one_term() {
    const auto resolve = [&](Rational coefficient, Id& node) {
      for (;;) {
        const Node& n = out_.nodes[node];
        if (n.kind != Kind::sum || n.terms.size() != 1 || n.number != 0) return coefficient;
        coefficient *= n.terms[0].coefficient;
        node = n.terms[0].node;
      }
    };
    for (Node& n : out_.nodes) {
      for (Term& t : n.terms) t.coefficient = resolve(t.coefficient, t.node);
      for (Id& operand : n.of)
        if (Id node = operand; resolve(1, node) == 1) operand = node;
      if (n.kind == Kind::product) std::sort(n.of.begin(), n.of.end());
    }
    for (Value& v : out_.roots)
      if (v.node != kNone) v.coefficient = resolve(v.coefficient, v.node);
  }

  // Moves the coefficient of a root into a sum that has no other user, if this does not increase the number of
  // coefficients.
  void fold_into_sums() {
    const std::vector<std::size_t> uses = out_.uses();
    const auto products = [](const Node& n, const Rational& factor) {
      return std::count_if(n.terms.begin(), n.terms.end(),
                           [&](const Term& t) { return abs(t.coefficient * factor) != 1; });
    };
    for (Value& v : out_.roots) {
      if (v.node == kNone || v.coefficient == 1 || uses[v.node] != 1) continue;
      Node& n = out_.nodes[v.node];
      if (n.kind != Kind::sum || products(n, v.coefficient) > products(n, 1) + (abs(v.coefficient) == 1 ? 0 : 1))
        continue;
      for (Term& t : n.terms) t.coefficient *= v.coefficient;
      n.number *= v.coefficient;
      v.coefficient = 1;
    }
  }

  // Makes the pair of factors that occurs most often a product of its own, as long as one occurs twice.
  void share_pairs() {
    const std::vector<std::size_t> uses = out_.uses();
    std::vector<Id> products;
    std::size_t pairs = 0;
    for (Id i = 0; i < uses.size(); ++i)
      if (uses[i] > 0 && out_.nodes[i].kind == Kind::product)
        products.push_back(i), pairs += out_.nodes[i].of.size() * out_.nodes[i].of.size();
    if (pairs > kMostPairs) return;
    for (;;) {
      std::map<std::pair<Id, Id>, std::size_t> count;
      for (const Id i : products) {
        const std::vector<Id>& f = out_.nodes[i].of;
        std::map<std::pair<Id, Id>, std::size_t> own;
        for (std::size_t a = 0; a < f.size(); ++a)
          for (std::size_t b = a + 1; b < f.size(); ++b) own[{f[a], f[b]}] = 1;
        for (const auto& [pair, once] : own) count[pair] += once;
      }
      std::pair<Id, Id> best{kNone, kNone};
      std::size_t most = 1;
      for (const auto& [pair, times] : count)
        if (times > most) best = pair, most = times;
      if (most < 2) return;
      // A product of exactly this pair serves the others.
      Id shared = kNone;
      for (const Id i : products)
        if (out_.nodes[i].of == std::vector<Id>{best.first, best.second}) shared = i;
      const bool there = shared != kNone;
      if (!there) {
        shared = static_cast<Id>(out_.nodes.size());
        out_.nodes.push_back({Kind::product, {}, {}, {}, {best.first, best.second}});
      }
      for (const Id i : products) {
        std::vector<Id>& f = out_.nodes[i].of;
        if (i == shared) continue;
        const auto first = std::find(f.begin(), f.end(), best.first);
        if (first == f.end()) continue;
        const auto second = std::find(first + 1, f.end(), best.second);
        if (second == f.end()) continue;
        f.erase(second);
        f.erase(std::find(f.begin(), f.end(), best.first));
        f.push_back(shared);
        std::sort(f.begin(), f.end());
      }
      if (!there) products.push_back(shared);
    }
  }

  const Tape& tape_;
  std::unordered_map<NodeId, std::string> names_;
  std::vector<bool> needed_;
  std::vector<std::size_t> uses_;
  std::vector<Value> values_;
  std::unordered_map<std::string, Id> known_;
  Arithmetic out_;
};

}  // namespace

std::vector<std::uint32_t> Arithmetic::operands(std::uint32_t node) const {
  std::vector<std::uint32_t> out = nodes[node].of;
  for (const Term& t : nodes[node].terms) out.push_back(t.node);
  return out;
}

std::vector<std::uint32_t> Arithmetic::order() const {
  enum class Mark : std::uint8_t { none, open, done };
  std::vector<Mark> mark(nodes.size(), Mark::none);
  std::vector<std::uint32_t> out, stack;
  for (const Value& root : roots) {
    if (root.node != kNone) stack.push_back(root.node);
    while (!stack.empty()) {
      const std::uint32_t at = stack.back();
      if (mark[at] != Mark::none) {
        stack.pop_back();
        if (mark[at] == Mark::open) out.push_back(at);
        mark[at] = Mark::done;
        continue;
      }
      mark[at] = Mark::open;
      for (const std::uint32_t k : operands(at))
        if (mark[k] == Mark::none) stack.push_back(k);
    }
  }
  return out;
}

std::vector<std::size_t> Arithmetic::uses() const {
  std::vector<std::size_t> out(nodes.size(), 0);
  for (const Value& root : roots)
    if (root.node != kNone) ++out[root.node];
  for (const std::uint32_t i : order())
    for (const std::uint32_t k : operands(i)) ++out[k];
  return out;
}

std::vector<bool> Arithmetic::divisors() const {
  const std::vector<std::size_t> used = uses();
  std::vector<bool> out(nodes.size(), false);
  for (std::uint32_t i = 0; i < nodes.size(); ++i)
    if (used[i] > 0 && nodes[i].kind == Kind::product)
      for (const std::uint32_t f : nodes[i].of) out[f] = nodes[f].kind == Kind::reciprocal && used[f] == 1;
  return out;
}

Arithmetic arithmetic(const RateFormulas& f, const Column& es) {
  if (es.empty()) return {};
  // Substitutes the numbers of the parameters.
  std::unordered_map<NodeId, Expr> values;
  for (std::size_t i = 0; i < f.p.size(); ++i) values[f.p.symbols[i].id] = f.exact_parameters[i];
  const Column numbers = substitute(es, [&](NodeId id) {
    const auto value = values.find(id);
    return value == values.end() ? Expr{} : value->second;
  });
  std::unordered_map<NodeId, std::string> names{{f.model->graph->time().id, "t"}};
  for (std::size_t i = 0; i < f.x.size(); ++i) names[f.x.symbols[i].id] = "x" + std::to_string(i);
  const Tape tape = compile(numbers, std::vector<int>(numbers.size(), 0), true);
  return Builder(tape, std::move(names)).run();
}

}  // namespace anholon::emit
