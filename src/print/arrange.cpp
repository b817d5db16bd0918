#include "print/arrange.h"

#include <algorithm>
#include <limits>
#include <optional>

#include "expr/polynomial.h"
#include "print/grouping.h"

namespace anholon {

namespace {

using namespace arrangement;

// Bounds on the effort for one expression. All are far above the size that a person reads.
constexpr long kMostProducts = 300'000;      // products of terms in one normal form
constexpr std::size_t kArrangedTerms = 800;  // monomials that are grouped

// The parts of an expression that can be left whole.
struct Features {
  bool sums_of_angles = false, fractions = false, names = false;
};

Features features(Expr e, const SymbolNames& names) {
  const Graph& g = *e.graph;
  Features f;
  for (NodeId id : reachable({&e, 1})) {
    const Node& n = g.node(id);
    f.names |= names.defined.count(id) > 0;
    if (n.kind == Kind::product)
      for (const Term& t : g.terms(id)) f.fractions |= g.rational(t.weight) < 0;
    if (n.kind == Kind::function) {
      const Function function = static_cast<Function>(n.index);
      f.sums_of_angles |= function == Function::tan || ((function == Function::sin || function == Function::cos) &&
                                                        g.node(g.terms(id)[0].node).kind == Kind::sum);
    }
  }
  return f;
}

}  // namespace

static bool is_arranged(Expr e) {
  const Kind kind = e.graph->node(e.id).kind;
  return kind != Kind::sum && kind != Kind::product;
}

std::optional<NormalForm> written_out(Expr e) { return normal_form(e, {}, kMostWork); }

Expr arranged(Expr e, const SymbolNames& names) { return is_arranged(e) ? e : arranged(e, names, written_out(e)); }

Expr arranged(Expr e, const SymbolNames& names, const std::optional<NormalForm>& plain) {
  if (is_arranged(e)) return e;
  const Graph& g = *e.graph;
  const auto length = [&](Expr x) {
    const std::string text = print(x, names, Format::text);
    return text.find("…") == std::string::npos ? text.size() : kLongestPrint;  // cut: as long as can be
  };
  Expr best = e;
  std::size_t shortest = length(e);
  if (plain)
    if (const std::optional<Expr> full = expression(*plain))  // `expanded(e)`
      if (const std::size_t n = length(*full); n <= shortest) best = *full, shortest = n;

  std::vector<Written> seen;
  std::size_t least = std::numeric_limits<std::size_t>::max();
  const Features has = features(e, names);
  for (bool angles : {false, true})
    for (bool fractions : {false, true})
      for (bool keep_names : {false, true}) {
        if ((angles && !has.sums_of_angles) || (fractions && !has.fractions) || (keep_names && !has.names)) continue;
        const Whole whole{angles, fractions, keep_names ? &names.defined : nullptr};
        const std::optional<NormalForm> form =
            angles || fractions || keep_names ? normal_form(e, whole, kMostProducts) : plain;
        if (!form || form->numerator.size() + form->denominator.size() > kArrangedTerms) continue;
        Written w{form->generators, {}, as_sum(form->numerator), as_sum(form->denominator)};
        const auto same = [&](const Written& o) {
          return o.generators == w.generators && o.numerator == w.numerator && o.denominator == w.denominator;
        };
        if (std::any_of(seen.begin(), seen.end(), same)) continue;
        seen.push_back(w);
        for (const auto& [s, c] : form->angles) {
          const Expr sine = form->generators[s], cosine = form->generators[c];  // numbers for multiples of pi
          if (g.node(sine.id).kind == Kind::function && g.node(cosine.id).kind == Kind::function)
            w.angles.push_back({s, c, {e.graph, g.terms(sine.id)[0].node}});
        }
        for (Sum* part : {&w.numerator, &w.denominator}) {
          choose_squares(*part, w.angles);
          join_angles(w, *part);
        }
        const auto [x, cost] = grouped(w, names);
        if (cost < least && length(x) <= shortest) best = x, least = cost;
      }
  return best;
}

}  // namespace anholon
