#include "expr/table.h"

#include <algorithm>
#include <map>

#include "base/assert.h"
#include "expr/diff.h"

namespace anholon {

bool is_piece_of_table(std::string_view member) {
  return member == "knot" || (member.size() == 2 && member[0] == 'c' && member[1] >= '0' && member[1] <= '3');
}

int smoothness(Fit fit) { return static_cast<int>(fit) - 1; }

namespace {

using Numbers = std::vector<Rational>;

// Returns second derivatives at the knots, from a tridiagonal, diagonally dominant system. They are exact as long as
// they have few digits, whose number grows with every knot; otherwise a hundred and twenty digits are kept.
Numbers natural_spline(const Numbers& x, const Numbers& y) {
  const std::size_t n = x.size();
  constexpr std::uint64_t kMostBits = 800;  // the limit of numerator and denominator
  const auto rounded = [](const Rational& r) {
    if (r.bits() <= kMostBits) return r;
    mpz_class scaled = (r.get_num() << 400) / r.get_den();
    return Rational(scaled, mpz_class(1) << 400);
  };
  Numbers upper(n, 0), right(n, 0), m(n, 0);
  for (std::size_t i = 1; i + 1 < n; ++i) {
    const Rational before = x[i] - x[i - 1], after = x[i + 1] - x[i];
    const Rational pivot = 2 * (before + after) - before * upper[i - 1];
    const Rational slopes = 6 * ((y[i + 1] - y[i]) / after - (y[i] - y[i - 1]) / before);
    upper[i] = rounded(after / pivot);
    right[i] = rounded((slopes - before * right[i - 1]) / pivot);
  }
  for (std::size_t i = n - 1; i-- > 1;) m[i] = rounded(right[i] - upper[i] * m[i + 1]);
  return m;
}

// Returns slopes at the knots that keep the function monotone in every interval.
Numbers monotone_slopes(const Numbers& x, const Numbers& y) {
  const std::size_t n = x.size();
  Numbers m, d(n, 0);
  for (std::size_t i = 0; i + 1 < n; ++i) m.push_back((y[i + 1] - y[i]) / (x[i + 1] - x[i]));
  for (std::size_t i = 1; i + 1 < n; ++i) {
    if (sgn(m[i - 1]) * sgn(m[i]) <= 0) continue;
    const Rational before = x[i] - x[i - 1], after = x[i + 1] - x[i];
    const Rational w1 = 2 * after + before, w2 = after + 2 * before;
    d[i] = (w1 + w2) / (w1 / m[i - 1] + w2 / m[i]);
  }
  // At the ends the slope of the interval is used; it cannot overshoot.
  d[0] = m[0];
  d[n - 1] = m[n - 2];
  return d;
}

// The coefficients c0..c3 of an interval, measured from its left knot.
using Cubic = std::vector<Rational>;

std::vector<Cubic> stretches(const Table& t) {
  const std::size_t n = t.x.size();
  std::vector<Cubic> list;
  const Numbers second = t.fit == Fit::spline ? natural_spline(t.x, t.y) : Numbers();
  const Numbers slope = t.fit == Fit::monotone ? monotone_slopes(t.x, t.y) : Numbers();
  for (std::size_t i = 0; i + 1 < n; ++i) {
    const Rational h = t.x[i + 1] - t.x[i], m = (t.y[i + 1] - t.y[i]) / h;
    switch (t.fit) {
    case Fit::hold:
      list.push_back({t.y[i]});
      break;
    case Fit::linear:
      list.push_back({t.y[i], m});
      break;
    case Fit::monotone:
      list.push_back({t.y[i], slope[i], Rational((3 * m - 2 * slope[i] - slope[i + 1]) / h),
                      Rational((slope[i] + slope[i + 1] - 2 * m) / (h * h))});
      break;
    case Fit::spline:
      list.push_back({t.y[i], Rational(m - h * (2 * second[i] + second[i + 1]) / 6), Rational(second[i] / 2),
                      Rational((second[i + 1] - second[i]) / (6 * h))});
      break;
    }
  }
  return list;
}

}  // namespace

TableFunction::TableFunction(Graph& g, const Table& t) {
  const std::size_t n = t.x.size();
  ANHOLON_ASSERT(n >= 2 && t.y.size() == n);
  std::vector<Cubic> pieces = stretches(t);
  const std::size_t terms = pieces[0].size();
  const bool tangent = t.outside != Outside::hold && terms > 1;
  // The tangents at both ends.
  Cubic first(terms, 0), last(terms, 0);
  first[0] = t.y[0];
  last[0] = t.y[n - 1];
  if (tangent) {
    first[1] = pieces.front()[1];
    const Rational h = t.x[n - 1] - t.x[n - 2];
    Rational slope = 0;
    for (std::size_t k = terms; k-- > 1;) slope = slope * h + Rational(static_cast<int>(k)) * pieces.back()[k];
    last[1] = slope;
  }
  pieces.insert(pieces.begin(), first);
  pieces.push_back(last);
  const auto add = [&](const std::string& name, int power, Numbers values) {
    return g.add_step_function({t.name + name, t.x, std::move(values), power, smoothness(t.fit)});
  };
  Numbers knots = {t.x[0]};
  knots.insert(knots.end(), t.x.begin(), t.x.end());
  knot_ = add(".knot", -1, knots);
  for (std::size_t k = 0; k < terms; ++k) {
    Numbers values;
    for (const Cubic& c : pieces) values.push_back(c[k]);
    coefficients_.push_back(add(".c" + std::to_string(k), static_cast<int>(k), values));
  }
}

Expr TableFunction::operator()(Expr x) const {
  Graph& g = *x.graph;
  Expr value = g.lookup(coefficients_.back(), x);
  if (coefficients_.size() == 1) return value;
  const Expr knot = g.lookup(knot_, x), d = x - knot;
  for (std::size_t k = coefficients_.size() - 1; k-- > 0;) {
    const Expr c = g.lookup(coefficients_[k], x), higher = d * value;
    value = c + higher;
  }
  return value;
}

static bool is_constant_in_time(Expr e) {
  const std::vector<NodeId> met = symbols({&e, 1});
  return std::all_of(met.begin(), met.end(), [&](NodeId id) { return e.graph->node(id).kind == Kind::parameter; });
}

std::optional<std::string> too_rough(Expr e, int derivative) {
  const Graph& g = *e.graph;
  struct Use {
    int power, smooth;
  };
  std::map<std::string, Use> tables;
  for (NodeId id : reachable({&e, 1})) {
    const Node& n = g.node(id);
    if (n.kind != Kind::lookup) continue;
    const StepFunction& f = g.step_function(n.index);
    if (f.power < 0 || is_constant_in_time(Expr{e.graph, g.terms(id)[0].node})) continue;
    Use& use = tables.try_emplace(f.name.substr(0, f.name.rfind('.')), Use{f.power, f.smooth}).first->second;
    use.power = std::min(use.power, f.power);
  }
  for (const auto& [name, use] : tables)
    if (use.smooth - use.power < derivative - 1) return name;
  return std::nullopt;
}

}  // namespace anholon
