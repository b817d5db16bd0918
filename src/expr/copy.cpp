#include "expr/copy.h"

namespace anholon {

namespace {

class Copier {
 public:
  Copier(const Graph& from, Graph& to) : from_(from), to_(to) {}

  Expr operator[](NodeId id) const { return image_.at(id); }

  // REQUIRES: the operands have been added.
  void add(NodeId id) { image_[id] = made(id); }

 private:
  Expr made(NodeId id) {
    const Node& n = from_.node(id);
    const std::span<const Term> terms = from_.summands(id);
    const auto operand = [&](std::size_t k) { return image_.at(terms[k].node); };
    switch (n.kind) {
    case Kind::number:
      return to_.number(from_.value(id));
    case Kind::pi:
      return to_.pi();
    case Kind::time:
      return to_.time();
    case Kind::jet:
      return to_.jet(n.index, n.order);
    case Kind::parameter:
      return to_.parameter(n.index);
    case Kind::mass:
      return to_.mass(n.index);
    case Kind::multiplier:
      return to_.multiplier(n.index, n.order);
    case Kind::given:
      return to_.given(n.index, n.order);
    case Kind::quasi:
      return to_.quasi(n.index, n.order);
    case Kind::state:
      return to_.state(n.index, n.order);
    case Kind::control:
      return to_.control(n.index, n.order);
    case Kind::sum: {
      std::vector<std::pair<Rational, Expr>> parts;
      for (const Term& t : terms) parts.push_back({from_.rational(t.weight), image_.at(t.node)});
      return to_.sum(parts);
    }
    case Kind::product: {
      std::vector<std::pair<Expr, Rational>> parts;
      for (const Term& t : terms) parts.push_back({image_.at(t.node), from_.rational(t.weight)});
      return to_.product(parts);
    }
    case Kind::function:
      return to_.apply(static_cast<Function>(n.index), operand(0));
    case Kind::atan2:
      return to_.arctangent2(operand(0), operand(1));
    case Kind::select:
      return to_.select(operand(0), operand(1), operand(2));
    case Kind::lookup: {
      const auto [at, fresh] = step_functions_.try_emplace(n.index, 0);
      if (fresh) at->second = to_.add_step_function(from_.step_function(n.index));
      return to_.lookup(at->second, operand(0));
    }
    }
    return {};
  }

  const Graph& from_;
  Graph& to_;
  std::unordered_map<NodeId, Expr> image_;
  std::unordered_map<std::uint32_t, std::uint32_t> step_functions_;
};

}  // namespace

Column copied(std::span<const Expr> es, Graph& to) {
  if (es.empty()) return {};
  Copier copy(*es[0].graph, to);
  for (NodeId id : reachable(es)) copy.add(id);
  Column result;
  for (Expr e : es) result.push_back(copy[e.id]);
  return result;
}

}  // namespace anholon
