#include <algorithm>
#include <map>
#include <set>
#include <unordered_map>

#include "base/assert.h"
#include "base/hash_index.h"
#include "tape/large_numbers.h"
#include "tape/leads.h"
#include "tape/tape.h"

namespace anholon {

namespace {

class Compiler {
 public:
  Compiler(Graph& g, bool shared, std::span<const Expr> rates, std::uint32_t rates_from)
      : g_(g), shared_(shared), rates_(rates), rates_from_(rates_from) {}

  Tape run(std::span<const Expr> es, std::span<const int> leads) {
    const auto part = [&](std::span<const Expr> roots) {
      Column all(roots.begin(), roots.end());
      all.insert(all.end(), rates_.begin(), rates_.end());
      // The derivative of a function needs a slot of its own, and may contain more functions.
      for (std::size_t before = 0; before != all.size();) {
        before = all.size();
        Column derivatives;
        for (NodeId id : reachable(all)) {
          if (!expanded_.insert({id, true}).second) continue;
          const Node n = g_.node(id);
          if (n.kind == Kind::function) {
            derivatives.push_back(
                derivative(static_cast<Function>(n.index), Expr{&g_, g_.terms(id)[0].node}, Expr{&g_, id}));
            derivative_[id] = {derivatives.back(), Expr{}};
          } else if (n.kind == Kind::atan2) {
            const Expr y{&g_, g_.terms(id)[0].node}, x{&g_, g_.terms(id)[1].node}, r2 = x * x + y * y;
            derivatives.push_back(x / r2);
            derivatives.push_back(-(y / r2));
            derivative_[id] = {derivatives[derivatives.size() - 2], derivatives.back()};
          }
        }
        all.insert(all.end(), derivatives.begin(), derivatives.end());
      }
      if (shared_) share(all);
      const std::vector<NodeId> nodes = reachable(all);
      large_.merge(large_sums(g_, nodes));
      for (NodeId id : nodes) emit(id);
      for (Expr e : all) plain(e.id);  // derivatives of functions are also used before the end of the part
    };
    part(es.first(leads.size()));
    std::vector<std::uint32_t> roots;
    // Each root has an alias of its own, so that its lead is exactly the given one.
    for (Expr e : es.first(leads.size())) roots.push_back(alias(e.id));
    tape_.main_end = static_cast<std::uint32_t>(tape_.code.size());
    part(es.subspan(leads.size()));
    for (Expr e : es.subspan(leads.size())) roots.push_back(plain(e.id));
    tape_.roots = roots;
    tape_.nodes.assign(tape_.code.size(), Tape::kNoNode);
    for (const auto& [id, slot] : slot_) tape_.nodes[slot] = std::min(tape_.nodes[slot], id);
    for (const auto& [slot, id] : pending_derivatives_) {
      Instruction& in = tape_.code[slot];
      const auto& [first, second] = derivative_.at(id);
      if (in.op == Op::function)
        in.index = g_.node(id).index, in.b = plain(first.id);
      else
        in.first = plain(first.id), in.count = plain(second.id);
    }
    spread_leads(tape_, leads);
    return std::move(tape_);
  }

 private:
  std::uint32_t rational(const Rational& r) {
    const std::uint64_t hash = r.hash();
    const std::uint32_t known = rational_.find(hash, [&](std::uint32_t k) { return tape_.rationals[k] == r; });
    if (known != HashIndex::kNone) return known;
    const auto index = static_cast<std::uint32_t>(tape_.rationals.size());
    rational_.insert(hash, index);
    tape_.rationals.push_back(r);
    return index;
  }

  std::uint32_t push(Instruction in) {
    tape_.code.push_back(in);
    return static_cast<std::uint32_t>(tape_.code.size() - 1);
  }
  bool constant(std::uint32_t slot) const { return tape_.code[slot].constant; }

  std::uint32_t alias(NodeId id) {
    Instruction in{Op::linear};
    in.first = static_cast<std::uint32_t>(tape_.linear_terms.size());
    in.count = 1;
    in.constant = constant(slot_.at(id));
    tape_.linear_terms.push_back({rational(times_power_of_two(1, unit(id))), slot_.at(id)});
    return push(in);
  }

  // Returns k if the slot of a node holds its value divided by 2^k.
  long unit(NodeId id) const {
    const auto it = unit_.find(id);
    return it == unit_.end() ? 0 : it->second;
  }

  // Returns the slot that holds the value of a node itself.
  std::uint32_t plain(NodeId id) {
    if (unit(id) == 0) return slot_.at(id);
    const auto [it, fresh] = plain_.try_emplace(id, 0);
    if (fresh) it->second = alias(id);
    return it->second;
  }

  std::uint32_t one() {
    if (!one_) {
      Instruction in{Op::constant, true};
      in.index = rational(1);
      one_ = push(in);
    }
    return *one_;
  }

  std::uint32_t times(std::uint32_t a, std::uint32_t b) {
    Instruction in{a == b ? Op::square : Op::multiply};
    in.constant = constant(a) && constant(b);
    in.a = a;
    in.b = b;
    if (!in.constant && constant(b)) std::swap(in.a, in.b);
    if (!in.constant && constant(in.a)) in.op = Op::scale;
    return push(in);
  }

  std::uint32_t whole_power(std::uint32_t x, unsigned long n) {
    const std::uint64_t key = (static_cast<std::uint64_t>(x) << 32) | n;
    if (n == 1) return x;
    if (const auto it = whole_power_.find(key); it != whole_power_.end()) return it->second;
    const std::uint32_t half = whole_power(x, n / 2);
    std::uint32_t r = times(half, half);
    if (n % 2) r = times(r, x);
    return whole_power_[key] = r;
  }

  // True if a node varies in time; the node need not have a slot.
  bool varies(NodeId id) {
    const auto [it, fresh] = varies_.try_emplace(id, false);
    if (!fresh) return it->second;
    const Kind kind = g_.node(id).kind;
    bool v = kind == Kind::time || kind == Kind::jet || kind == Kind::multiplier || kind == Kind::state;
    if (kind == Kind::sum) {
      for (const Term& t : g_.summands(id)) v = varies(t.node) || v;
    } else if (kind == Kind::product || kind == Kind::function || kind == Kind::atan2 || kind == Kind::select ||
               kind == Kind::lookup) {
      for (const Term& t : g_.terms(id)) v = varies(t.node) || v;
    }
    return varies_[id] = v;
  }

  // Chooses the pairs of factors that are multiplied first: always the pair that most products still have in common.
  void share(const Column& roots) {
    using Pair = std::pair<std::uint64_t, std::uint64_t>;
    constexpr std::size_t kMostProducts = 4000;
    constexpr long kMostRepeats = 4;
    std::vector<std::pair<NodeId, std::vector<std::uint64_t>>> products;
    for (NodeId id : reachable(roots)) {
      if (g_.node(id).kind != Kind::product || factors_.count(id)) continue;
      std::vector<std::uint64_t> list;
      for (const Term& t : g_.terms(id)) {
        const Rational& e = g_.rational(t.weight);
        if (!e.is_integer() || e <= 0 || e > kMostRepeats || !varies(t.node)) continue;
        list.insert(list.end(), static_cast<std::size_t>(e.to_long()), t.node);
      }
      if (list.size() > 1) products.push_back({id, std::move(list)});
    }
    // The number of products in which each pair occurs; it is counted anew for products from which a pair was taken.
    std::map<Pair, std::size_t> count;
    const auto tell = [&count](const std::vector<std::uint64_t>& list, bool more) {
      std::set<Pair> seen;
      for (std::size_t i = 0; i < list.size(); ++i)
        for (std::size_t j = i + 1; j < list.size(); ++j)
          if (const Pair pair{list[i], list[j]}; seen.insert(pair).second) more ? ++count[pair] : --count[pair];
    };
    if (products.size() <= kMostProducts) {
      for (auto& [id, list] : products) {
        std::sort(list.begin(), list.end());
        tell(list, true);
      }
      for (;;) {
        const auto best = std::max_element(count.begin(), count.end(),
                                           [](const auto& x, const auto& y) { return x.second < y.second; });
        if (best == count.end() || best->second < 2) break;
        const Pair pair = best->first;
        const std::uint64_t made = kPair + pairs_.size();
        pairs_.push_back(pair);
        for (auto& [id, list] : products) {
          bool changed = false;
          for (;;) {
            const auto first = std::find(list.begin(), list.end(), pair.first);
            if (first == list.end()) break;
            const auto second =
                std::find(pair.first == pair.second ? first + 1 : list.begin(), list.end(), pair.second);
            if (second == list.end()) break;
            const std::size_t i = static_cast<std::size_t>(first - list.begin()),
                              j = static_cast<std::size_t>(second - list.begin());
            if (!changed) tell(list, false);
            changed = true;
            list[i] = made;
            list.erase(list.begin() + static_cast<std::ptrdiff_t>(j));
          }
          if (!changed) continue;
          std::sort(list.begin(), list.end());
          tell(list, true);
        }
      }
    }
    for (auto& [id, list] : products) factors_[id] = std::move(list);
  }

  // True if a power is a product of the number of factors in its exponent.
  static bool is_repeated(const Rational& exponent) { return exponent.is_integer() && abs(exponent) <= 1000; }

  // True if the power of a value in units of 2^k has a unit that is a whole power of two.
  static bool keeps_unit(const Rational& exponent) {
    return abs(exponent) <= 1000 && (exponent * Rational(kUnits)).is_integer();
  }

  std::uint32_t factor_slot(std::uint64_t f) {
    if (f < kPair) return slot_.at(static_cast<NodeId>(f));
    const std::uint64_t k = f - kPair;
    if (pair_slot_.size() < pairs_.size()) pair_slot_.resize(pairs_.size());
    if (!pair_slot_[k]) {
      const std::uint32_t a = factor_slot(pairs_[k].first), b = factor_slot(pairs_[k].second);
      pair_slot_[k] = times(a, b);
    }
    return *pair_slot_[k];
  }

  std::uint32_t shared_product(NodeId id) {
    std::vector<std::uint32_t> varying, constants, below;
    const auto shared = factors_.find(id);
    if (shared != factors_.end())
      for (std::uint64_t f : shared->second) varying.push_back(factor_slot(f));
    for (const Term& t : g_.terms(id)) {
      const Rational& e = g_.rational(t.weight);
      const std::uint32_t x = slot_.at(t.node);
      const bool whole = is_repeated(e);
      if (shared != factors_.end() && whole && e > 0 && e <= 4 && !constant(x)) continue;
      if (whole) {
        const std::uint32_t p = whole_power(x, static_cast<unsigned long>(std::labs(e.to_long())));
        (constant(x) && e > 0 ? constants : e > 0 ? varying : below).push_back(p);
      } else {
        Instruction in{Op::power};
        in.constant = constant(x);
        in.a = keeps_unit(e) ? x : plain(t.node);
        in.index = rational(e);
        (in.constant ? constants : varying).push_back(push(in));
      }
    }
    const auto fold = [&](const std::vector<std::uint32_t>& list) {
      std::uint32_t r = list[0];
      for (std::size_t i = 1; i < list.size(); ++i) r = times(r, list[i]);
      return r;
    };
    const auto quotient = [&](std::uint32_t above, const std::vector<std::uint32_t>& list) {
      if (list.empty()) return above;
      Instruction in{Op::divide};
      in.a = above;
      in.b = fold(list);
      in.constant = constant(in.a) && constant(in.b);
      return push(in);
    };
    std::vector<std::uint32_t> constant_below;
    for (std::size_t i = 0; i < below.size();) {
      if (constant(below[i]))
        constant_below.push_back(below[i]), below.erase(below.begin() + static_cast<std::ptrdiff_t>(i));
      else
        ++i;
    }
    std::optional<std::uint32_t> front;
    if (!constants.empty() || !constant_below.empty())
      front = quotient(constants.empty() ? one() : fold(constants), constant_below);
    if (varying.empty() && below.empty()) return *front;
    if (varying.empty()) return quotient(front ? *front : one(), below);
    const std::uint32_t r = quotient(fold(varying), below);
    return front ? times(*front, r) : r;
  }

  std::uint32_t product(NodeId id) {
    long unit_of_product = 0;
    for (const Term& t : g_.terms(id))
      if (const long k = unit(t.node); k != 0 && keeps_unit(g_.rational(t.weight)))
        unit_of_product += (g_.rational(t.weight) * Rational(k)).to_long();
    if (unit_of_product != 0) unit_[id] = unit_of_product;
    if (shared_) return shared_product(id);
    std::vector<std::uint32_t> top, bottom;
    for (const Term& t : g_.terms(id)) {
      const Rational& e = g_.rational(t.weight);
      const std::uint32_t x = slot_.at(t.node);
      if (is_repeated(e)) {
        const long n = e.to_long();
        (n > 0 ? top : bottom).push_back(whole_power(x, static_cast<unsigned long>(std::labs(n))));
      } else {
        Instruction in{Op::power};
        in.constant = constant(x);
        in.a = keeps_unit(e) ? x : plain(t.node);
        in.index = rational(e);
        top.push_back(push(in));
      }
    }
    const auto fold = [&](std::vector<std::uint32_t>& list) {
      std::stable_partition(list.begin(), list.end(), [&](std::uint32_t s) { return constant(s); });
      std::uint32_t r = list[0];
      for (std::size_t i = 1; i < list.size(); ++i) r = times(r, list[i]);
      return r;
    };
    if (bottom.empty()) return fold(top);
    const std::uint32_t below = fold(bottom), above = top.empty() ? one() : fold(top);
    Instruction in{Op::divide};
    in.constant = constant(above) && constant(below);
    in.a = above;
    in.b = below;
    return push(in);
  }

  void emit(NodeId id) {
    if (!slot_.count(id)) slot_[id] = slot_of(id);
  }

  // Returns the slot of a node whose operands have slots.
  std::uint32_t slot_of(NodeId id) {
    const Node n = g_.node(id);
    switch (n.kind) {
    case Kind::number:
      return number(id);
    case Kind::pi:
      return constant_of(Op::pi, 0);
    case Kind::parameter:
      return constant_of(Op::parameter, n.index);
    case Kind::jet:
      if (n.index >= rates_from_ && n.index - rates_from_ < rates_.size())
        return rate(rates_[n.index - rates_from_], n.order);
      return input(id);
    case Kind::time:
    case Kind::multiplier:
    case Kind::state:
      return input(id);
    case Kind::mass:
    case Kind::given:
    case Kind::quasi:
    case Kind::control:
      ANHOLON_ASSERT(!"a frozen mass, an input or an unknown function in a tape");
      return 0;
    case Kind::sum:
      return sum(id);
    case Kind::product:
      return product(id);
    case Kind::function:
    case Kind::atan2:
      return function(id, n);
    case Kind::select:
      return select(id);
    case Kind::lookup:
      return lookup(id, n);
    }
    return 0;
  }

  std::uint32_t operand(NodeId id, std::size_t k) { return plain(g_.terms(id)[k].node); }

  // A number beyond 2^256, or below 2^-256, has a unit.
  std::uint32_t number(NodeId id) {
    const Rational& r = g_.value(id);
    const long k = r == 0 ? 0 : whole_units(binary_exponent(r));
    if (std::labs(k) <= kLargestExponent) return constant_of(Op::constant, rational(r));
    unit_[id] = k;
    return constant_of(Op::constant, rational(times_power_of_two(r, -k)));
  }

  // Units are powers of 2^12, so that roots of them are powers of two.
  static constexpr long kUnits = 12;
  static long whole_units(long exponent) { return exponent / kUnits * kUnits; }

  std::uint32_t constant_of(Op op, std::uint32_t index) {
    Instruction in{op, true};
    in.index = index;
    return push(in);
  }

  std::uint32_t input(NodeId id) {
    Instruction in{Op::input};
    in.index = static_cast<std::uint32_t>(tape_.inputs.size());
    const std::uint32_t slot = push(in);
    tape_.inputs.push_back({id, slot});
    return slot;
  }

  // Returns the slot of a derivative of an expression, which is compiled before.
  std::uint32_t rate(Expr of, std::uint32_t order) {
    for (NodeId below : reachable({&of, 1})) emit(below);
    if (order == 0) return plain(of.id);
    Instruction in{Op::rate};
    in.a = plain(of.id);
    in.index = order;
    return push(in);
  }

  std::uint32_t sum(NodeId id) {
    Instruction in{Op::linear, true};
    in.first = static_cast<std::uint32_t>(tape_.linear_terms.size());
    const auto weight = [&](const Term& t) {
      const Rational& w = g_.rational(t.weight);
      return unit(t.node) == 0 ? w : times_power_of_two(w, unit(t.node));
    };
    const bool has_units =
        std::any_of(g_.summands(id).begin(), g_.summands(id).end(), [&](const Term& t) { return unit(t.node) != 0; });
    long down = 0;
    if (const bool large = large_.contains(id); large || has_units) {
      for (const Term& t : g_.summands(id)) down = std::max(down, binary_exponent(weight(t)));
      down = large || down > kLargestExponent ? whole_units(down) : 0;
      if (down != 0) unit_[id] = down;
    }
    for (const Term& t : g_.summands(id)) {
      const std::uint32_t x = slot_.at(t.node);
      tape_.linear_terms.push_back({rational(down == 0 ? weight(t) : times_power_of_two(weight(t), -down)), x});
      in.constant = in.constant && constant(x);
      ++in.count;
    }
    return push(in);
  }

  // Returns the slot of a function; the slots of its derivatives follow later.
  std::uint32_t function(NodeId id, const Node& n) {
    Instruction in{n.kind == Kind::function ? Op::function : Op::arctan2};
    in.a = operand(id, 0);
    in.constant = constant(in.a);
    if (in.op == Op::function)
      in.index = n.index;
    else
      in.b = operand(id, 1), in.constant = in.constant && constant(in.b);
    const std::uint32_t slot = push(in);
    pending_derivatives_.push_back({slot, id});
    return slot;
  }

  std::uint32_t select(NodeId id) {
    Instruction in{Op::select};
    in.first = operand(id, 0);
    in.a = operand(id, 1);
    in.b = operand(id, 2);
    in.constant = constant(in.first) && constant(in.a) && constant(in.b);
    return push(in);
  }

  std::uint32_t lookup(NodeId id, const Node& n) {
    Instruction in{Op::lookup};
    in.a = operand(id, 0);
    in.constant = constant(in.a);
    const auto [it, fresh] =
        step_function_.try_emplace(n.index, static_cast<std::uint32_t>(tape_.step_functions.size()));
    if (fresh) tape_.step_functions.push_back(g_.step_function(n.index));
    in.index = it->second;
    return push(in);
  }

  static constexpr std::uint64_t kPair = 1ULL << 32;

  Graph& g_;
  bool shared_;
  std::span<const Expr> rates_;
  std::uint32_t rates_from_;
  std::unordered_map<NodeId, bool> varies_;
  std::unordered_map<NodeId, std::vector<std::uint64_t>> factors_;  // the factors of products: nodes, or pairs
  std::vector<std::pair<std::uint64_t, std::uint64_t>> pairs_;
  std::vector<std::optional<std::uint32_t>> pair_slot_;
  Tape tape_;
  std::unordered_map<NodeId, std::uint32_t> slot_;
  std::unordered_map<NodeId, bool> expanded_;
  std::unordered_map<NodeId, std::pair<Expr, Expr>> derivative_;
  std::vector<std::pair<std::uint32_t, NodeId>> pending_derivatives_;
  std::unordered_set<NodeId> large_;                 // sums that are computed in units of their own
  std::unordered_map<NodeId, long> unit_;            // for nodes whose slot holds the value divided by 2^unit
  std::unordered_map<NodeId, std::uint32_t> plain_;  // the slots of the values of these nodes
  HashIndex rational_;
  std::unordered_map<std::uint32_t, std::uint32_t> step_function_;
  std::unordered_map<std::uint64_t, std::uint32_t> whole_power_;
  std::optional<std::uint32_t> one_;
};

}  // namespace

Tape compile(std::span<const Expr> es, std::span<const int> leads, bool shared, std::span<const Expr> rates,
             std::uint32_t rates_from) {
  ANHOLON_ASSERT(!es.empty() && leads.size() <= es.size());
  return Compiler(*es[0].graph, shared, rates, rates_from).run(es, leads);
}

Tape compile(std::span<const Expr> es) {
  const std::vector<int> leads(es.size(), 0);
  return compile(es, leads);
}

}  // namespace anholon
