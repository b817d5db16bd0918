#include "proof/generalize.h"

#include <algorithm>
#include <cmath>

#include "base/stop.h"
#include "expr/diff.h"
#include "proof/scattered.h"
#include "tape/function_value.h"

namespace anholon {

namespace {

constexpr long double kVanishes = 1e-9L;       // relative to the largest intermediate term
constexpr std::size_t kShort = 12;             // nodes: a shorter subexpression is not replaced
constexpr std::size_t kMostWork = 40'000'000;  // node evaluations

// Returns the value of a free node, by its position.
long double generic(std::uint64_t position) {
  return 0.55L + 0.8L * unit_of(scattered_bits(position * 0x9e3779b97f4a7c15ULL + 12345));
}

// The nodes below e in order, with their operands as positions, and their values at one point.
class Values {
 public:
  explicit Values(Expr e)
      : g_(*e.graph), ids_(reachable({&e, 1})), value_(ids_.size()), scale_(ids_.size()), free_(ids_.size(), false),
        size_(ids_.size(), 1) {
    std::unordered_map<NodeId, std::size_t> position;
    for (std::size_t i = 0; i < ids_.size(); ++i) position.emplace(ids_[i], i);
    for (std::size_t i = 0; i < ids_.size(); ++i) {
      const Node& n = g_.node(ids_[i]);
      terms_.emplace_back();
      for (const Term& t : n.kind == Kind::sum ? g_.summands(ids_[i]) : g_.terms(ids_[i])) {
        terms_.back().push_back({position.at(t.node), from_rational<long double>(g_.rational(t.weight))});
        size_[i] = std::min(size_[i] + size_[position.at(t.node)], std::size_t{1} << 40);
      }
    }
    evaluate(0);
  }

  std::size_t count() const { return ids_.size(); }
  NodeId id(std::size_t i) const { return ids_[i]; }
  std::size_t size(std::size_t i) const { return size_[i]; }  // size as a tree
  void set_free(std::size_t i, bool free) { free_[i] = free; }
  bool vanishes() const { return std::abs(value_.back()) <= kVanishes * scale_.back(); }

  void evaluate(std::size_t from) {
    look_for_stop();
    for (std::size_t i = from; i < ids_.size(); ++i) {
      const Node& n = g_.node(ids_[i]);
      if (free_[i] || n.view_count == 0) {
        value_[i] = !free_[i] && n.kind == Kind::number ? from_rational<long double>(g_.value(ids_[i]))
                    : !free_[i] && n.kind == Kind::pi   ? pi<long double>()
                                                        : generic(i);
        scale_[i] = std::abs(value_[i]);
        continue;
      }
      long double v = 0, s = 0;
      switch (n.kind) {
      case Kind::sum:
        for (const auto& [k, weight] : terms_[i])
          v += weight * value_[k], s = std::max(s, std::abs(weight) * scale_[k]);
        break;
      case Kind::product:
        v = s = 1;
        for (const auto& [k, weight] : terms_[i]) {
          v *= weight == 1 ? value_[k] : std::pow(value_[k], weight);
          s *= weight == 1  ? scale_[k]
               : weight > 0 ? std::pow(scale_[k], weight)
                            : std::abs(std::pow(value_[k], weight));
        }
        break;
      case Kind::function:
        v = function_value(static_cast<Function>(n.index), value_[terms_[i][0].first]), s = std::abs(v);
        break;
      case Kind::atan2:
        v = std::atan2(value_[terms_[i][0].first], value_[terms_[i][1].first]), s = std::abs(v);
        break;
      default:
        break;
      }
      value_[i] = v;
      scale_[i] = std::max(s, std::abs(v));
    }
  }

 private:
  Graph& g_;
  std::vector<NodeId> ids_;
  std::vector<long double> value_, scale_;
  std::vector<bool> free_;
  std::vector<std::size_t> size_;
  std::vector<std::vector<std::pair<std::size_t, long double>>> terms_;
};

}  // namespace

bool seems_zero(Expr e) { return Values(e).vanishes(); }

Expr generalized(Expr e, std::uint32_t first) {
  Graph& g = *e.graph;
  Values values(e);
  if (!values.vanishes()) return e;
  std::vector<std::size_t> candidates;
  for (std::size_t i = 0; i + 1 < values.count(); ++i)
    if (values.size(i) > kShort) candidates.push_back(i);
  std::stable_sort(candidates.begin(), candidates.end(),
                   [&](std::size_t a, std::size_t b) { return values.size(a) > values.size(b); });
  std::unordered_map<NodeId, Expr> replacement;
  std::size_t work = 0;
  for (std::size_t i : candidates) {
    if ((work += values.count() - i) > kMostWork) break;
    values.set_free(i, true);
    values.evaluate(i);
    if (values.vanishes()) {
      replacement.emplace(values.id(i), g.quasi(first++, 0));
      continue;
    }
    values.set_free(i, false);
    values.evaluate(i);
    work += values.count() - i;
  }
  return replacement.empty() ? e : replace_nodes({&e, 1}, replacement)[0];
}

}  // namespace anholon
