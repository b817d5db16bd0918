#include <algorithm>
#include <unordered_map>

#include "base/assert.h"
#include "tape/tape.h"

namespace anholon {

namespace {

class Compiler {
 public:
  explicit Compiler(Graph& g) : g_(g) {}

  Tape run(std::span<const Expr> es, std::span<const int> leads) {
    const auto part = [&](std::span<const Expr> roots) {
      Column all(roots.begin(), roots.end());
      // A function needs its derivative as a slot of its own; that may bring in more functions.
      for (std::size_t before = 0; before != all.size();) {
        before = all.size();
        Column derivatives;
        for (NodeId id : reachable(all)) {
          if (!expanded_.insert({id, true}).second) continue;
          const Node n = g_.node(id);
          if (n.kind == Kind::function) {
            derivatives.push_back(derivative(static_cast<Function>(n.index),
                                             Expr{&g_, g_.terms(id)[0].node}, Expr{&g_, id}));
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
      for (NodeId id : reachable(all)) emit(id);
    };
    part(es.first(leads.size()));
    std::vector<std::uint32_t> roots;
    // Each root has an alias of its own, so that its lead is exactly the one asked for.
    for (Expr e : es.first(leads.size())) roots.push_back(alias(e.id));
    tape_.main_end = static_cast<std::uint32_t>(tape_.code.size());
    part(es.subspan(leads.size()));
    for (Expr e : es.subspan(leads.size())) roots.push_back(slot_.at(e.id));
    tape_.roots = roots;
    for (const auto& [slot, id] : pending_derivatives_) {
      Instruction& in = tape_.code[slot];
      const auto& [first, second] = derivative_.at(id);
      if (in.op == Op::function) in.index = g_.node(id).index, in.b = slot_.at(first.id);
      else in.first = slot_.at(first.id), in.count = slot_.at(second.id);
    }
    spread_leads(leads);
    return std::move(tape_);
  }

 private:
  std::uint32_t rational(const Rational& r) {
    const auto [it, fresh] = rational_.try_emplace(r.get_str(62), static_cast<std::uint32_t>(tape_.rationals.size()));
    if (fresh) tape_.rationals.push_back(r);
    return it->second;
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
    tape_.linear_terms.push_back({rational(1), slot_.at(id)});
    return push(in);
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

  std::uint32_t product(NodeId id) {
    std::vector<std::uint32_t> top, bottom;
    for (const Term& t : g_.terms(id)) {
      const Rational& e = g_.rational(t.weight);
      const std::uint32_t x = slot_.at(t.node);
      if (e.get_den() == 1 && abs(e) <= 1000) {
        const long n = e.get_num().get_si();
        (n > 0 ? top : bottom).push_back(whole_power(x, static_cast<unsigned long>(std::labs(n))));
      } else {
        Instruction in{Op::power};
        in.constant = constant(x);
        in.a = x;
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
    if (slot_.count(id)) return;
    const Node n = g_.node(id);
    Instruction in{Op::constant};
    switch (n.kind) {
      case Kind::number:
        in.constant = true;
        in.index = rational(g_.value(id));
        break;
      case Kind::pi: in = {Op::pi, true}; break;
      case Kind::parameter:
        in = {Op::parameter, true};
        in.index = n.index;
        break;
      case Kind::time: case Kind::jet: case Kind::multiplier: case Kind::state: {
        in.op = Op::input;
        in.index = static_cast<std::uint32_t>(tape_.inputs.size());
        slot_[id] = push(in);
        tape_.inputs.push_back({id, slot_[id]});
        return;
      }
      case Kind::mass: case Kind::given: case Kind::quasi: case Kind::control:
        ANHOLON_ASSERT(!"a frozen mass, an input or an unknown function in a tape");
        return;
      case Kind::sum: {
        in.op = Op::linear;
        in.constant = true;
        in.first = static_cast<std::uint32_t>(tape_.linear_terms.size());
        for (const Term& t : g_.summands(id)) {
          const std::uint32_t x = slot_.at(t.node);
          tape_.linear_terms.push_back({rational(g_.rational(t.weight)), x});
          in.constant = in.constant && constant(x);
          ++in.count;
        }
        break;
      }
      case Kind::product:
        slot_[id] = product(id);
        return;
      case Kind::function:
        in.op = Op::function;
        in.a = slot_.at(g_.terms(id)[0].node);
        in.index = n.index;
        in.constant = constant(in.a);
        slot_[id] = push(in);
        pending_derivatives_.push_back({slot_[id], id});
        return;
      case Kind::atan2:
        in.op = Op::arctan2;
        in.a = slot_.at(g_.terms(id)[0].node);
        in.b = slot_.at(g_.terms(id)[1].node);
        in.constant = constant(in.a) && constant(in.b);
        slot_[id] = push(in);
        pending_derivatives_.push_back({slot_[id], id});
        return;
      case Kind::select:
        in.op = Op::select;
        in.first = slot_.at(g_.terms(id)[0].node);
        in.a = slot_.at(g_.terms(id)[1].node);
        in.b = slot_.at(g_.terms(id)[2].node);
        in.constant = constant(in.first) && constant(in.a) && constant(in.b);
        break;
      case Kind::lookup: {
        in.op = Op::lookup;
        in.a = slot_.at(g_.terms(id)[0].node);
        in.constant = constant(in.a);
        const auto [it, fresh] = step_function_.try_emplace(n.index, static_cast<std::uint32_t>(tape_.step_functions.size()));
        if (fresh) tape_.step_functions.push_back(g_.step_function(n.index));
        in.index = it->second;
        break;
      }
    }
    slot_[id] = push(in);
  }

  void spread_leads(std::span<const int> leads) {
    std::vector<Instruction>& code = tape_.code;
    for (std::size_t i = 0; i < leads.size(); ++i) {
      code[tape_.roots[i]].lead = static_cast<std::uint8_t>(leads[i]);
      tape_.largest_lead = std::max(tape_.largest_lead, leads[i]);
    }
    const auto raise = [&](std::uint32_t slot, std::uint8_t lead) {
      bool changed = code[slot].lead < lead;
      code[slot].lead = std::max(code[slot].lead, lead);
      return changed;
    };
    // Derivative slots may stand after the function that uses them: repeat until nothing changes.
    for (bool again = true; again;) {
      again = false;
      for (std::uint32_t s = tape_.main_end; s-- > 0;) {
        const Instruction in = code[s];
        switch (in.op) {
          case Op::constant: case Op::pi: case Op::input: case Op::parameter: break;
          case Op::linear:
            for (std::uint32_t k = in.first; k < in.first + in.count; ++k) raise(tape_.linear_terms[k].slot, in.lead);
            break;
          case Op::square: case Op::power: case Op::lookup: raise(in.a, in.lead); break;
          case Op::select:
            raise(in.a, in.lead), raise(in.b, in.lead), raise(in.first, in.lead);
            break;
          case Op::multiply: case Op::scale: case Op::divide:
            raise(in.a, in.lead), raise(in.b, in.lead);
            break;
          case Op::function:
            raise(in.a, in.lead);
            if (raise(in.b, in.lead)) again = true;
            break;
          case Op::arctan2:
            raise(in.a, in.lead), raise(in.b, in.lead);
            if (raise(in.first, in.lead)) again = true;
            if (raise(in.count, in.lead)) again = true;
            break;
        }
      }
    }
  }

  Graph& g_;
  Tape tape_;
  std::unordered_map<NodeId, std::uint32_t> slot_;
  std::unordered_map<NodeId, bool> expanded_;
  std::unordered_map<NodeId, std::pair<Expr, Expr>> derivative_;
  std::vector<std::pair<std::uint32_t, NodeId>> pending_derivatives_;
  std::unordered_map<std::string, std::uint32_t> rational_;
  std::unordered_map<std::uint32_t, std::uint32_t> step_function_;
  std::unordered_map<std::uint64_t, std::uint32_t> whole_power_;
  std::optional<std::uint32_t> one_;
};

}  // namespace

Tape compile(std::span<const Expr> es, std::span<const int> leads) {
  ANHOLON_ASSERT(!es.empty() && leads.size() <= es.size());
  return Compiler(*es[0].graph).run(es, leads);
}

Tape compile(std::span<const Expr> es) {
  const std::vector<int> leads(es.size(), 0);
  return compile(es, leads);
}

}  // namespace anholon
