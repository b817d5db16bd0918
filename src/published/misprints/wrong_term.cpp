// A false equation whose error is one term: a side lacks the term, has it in excess, or has it with a wrong factor.
#include <algorithm>

#include "expr/normal.h"
#include "print/arrange.h"
#include "published/at_points.h"
#include "published/compare.h"

namespace anholon {

namespace {

bool is_sum(const Graph& g, NodeId id) { return g.node(id).kind == Kind::sum && g.node(id).count > 1; }

bool is_one_term(Expr e) {
  const Graph& g = *e.graph;
  if (is_sum(g, e.id)) return false;
  if (g.node(e.id).kind == Kind::sum) e.id = g.terms(e.id)[0].node;
  return g.node(e.id).kind != Kind::product ||
         std::none_of(g.terms(e.id).begin(), g.terms(e.id).end(), [&](const Term& t) { return is_sum(g, t.node); });
}

bool has_minus(Expr term) {
  const Graph& g = *term.graph;
  return g.node(term.id).kind == Kind::sum && g.rational(g.terms(term.id)[0].weight) < 0;
}

// Returns a formula that is printed unchanged.
Syntax verbatim(std::string text) { return {Syntax::Op::name, std::move(text), {}, {}, 0, 0, {}}; }

class Search {
 public:
  Search(const PublishedEquation& equation, Expr difference, Vocabulary& words, const SymbolNames& names,
         std::vector<PointValues>& points)
      : equation_(equation), sides_{equation.left, equation.right}, difference_(difference), words_(words),
        names_(names), points_(points) {}

  Change run() {
    for (const int side : {0, 1})
      for (std::size_t i = 0; i < operands(side); ++i)
        if (auto change = in_place_of(side, i)) return *change;
    return added(has_minus(difference_) ? 0 : 1);
  }

 private:
  std::size_t operands(int side) const { return sides_[side].op == Syntax::Op::add ? sides_[side].args.size() : 1; }
  const Syntax& operand(int side, std::size_t i) const {
    return sides_[side].op == Syntax::Op::add ? sides_[side].args[i] : sides_[side];
  }
  bool subtracted(int side, std::size_t i) const {
    return sides_[side].op == Syntax::Op::add && i > 0 && sides_[side].operators[i - 1].op == Syntax::Op::subtract;
  }
  std::string text(Expr e) const { return print(arranged(e, names_), names_, Format::text); }

  // Returns the change that gives the operand another number as its factor, if this factor is the error.
  std::optional<Change> in_place_of(int side, std::size_t i) {
    const Syntax& s = operand(side, i);
    Expr value;
    try {
      value = words_.number(s);
    } catch (const Failure&) {  // a vector
      return std::nullopt;
    }
    if (is_zero(value)) return std::nullopt;
    const auto ratio = constant_ratio(difference_, value, points_);
    if (!ratio || !proved_zero(difference_ - *ratio * value)) return std::nullopt;
    const bool minus = subtracted(side, i) != (side == 1);  // in left - right
    const Rational rest = 1 - (minus ? -*ratio : *ratio);
    Change c;
    c.side = side, c.term = i;
    c.span = equation_.source.span(s.offset, s.end - s.offset);
    const std::string sign = i == 0 ? "" : subtracted(side, i) ? "- " : "+ ";
    c.from = sign + print(s);
    Syntax after = sides_[side];
    if (rest == 0) {
      after = without(side, i);
    } else {
      const Expr right = rest * value;
      const bool turned = i > 0 && has_minus(right);
      const std::string to = text(turned ? -right : right);
      c.to = i == 0 ? to : (subtracted(side, i) != turned ? "- " : "+ ") + to;
      if (sides_[side].op != Syntax::Op::add) {
        after = verbatim(to);
      } else {
        after.args[i] = verbatim(to);
        if (turned) after.operators[i - 1].op = subtracted(side, i) ? Syntax::Op::add : Syntax::Op::subtract;
      }
      if (sign == c.to.substr(0, sign.size())) c.from.erase(0, sign.size()), c.to.erase(0, sign.size());
    }
    return finished(std::move(c), after);
  }

  // Returns the side without an operand.
  Syntax without(int side, std::size_t i) const {
    Syntax after = sides_[side];
    if (after.op != Syntax::Op::add) return verbatim("0");
    const bool negative = i == 0 && after.operators[0].op == Syntax::Op::subtract;
    after.args.erase(after.args.begin() + static_cast<std::ptrdiff_t>(i));
    after.operators.erase(after.operators.begin() + static_cast<std::ptrdiff_t>(i == 0 ? 0 : i - 1));
    if (negative) after.args[0] = opposite(after.args[0]);
    return after.args.size() == 1 ? Syntax(after.args[0]) : after;
  }

  Change added(int side) {
    const Syntax& s = sides_[side];
    const std::string term = text(side == 0 ? -difference_ : difference_);
    Change c;
    c.side = side;
    if (print(s) == "0") {
      c.from = "0", c.to = term;
      c.span = equation_.source.span(s.offset, s.end - s.offset);
      return finished(std::move(c), verbatim(term));
    }
    c.to = "+ " + term;
    c.span = equation_.source.span(s.end, 0);
    Syntax after = s.op == Syntax::Op::add ? s : Syntax{Syntax::Op::add, {}, {s}, {}, 0, 0, {}};
    after.args.push_back(verbatim(term));
    after.operators.push_back({Syntax::Op::add, {}});
    return finished(std::move(c), after);
  }

  Change finished(Change c, const Syntax& after) const {
    c.places = {c};
    c.equation = c.side == 0 ? print(after) + " = " + print(sides_[1]) : print(sides_[0]) + " = " + print(after);
    c.proved = true;
    return c;
  }

  const PublishedEquation& equation_;
  const Syntax sides_[2];
  Expr difference_;
  Vocabulary& words_;
  const SymbolNames& names_;
  std::vector<PointValues>& points_;
};

}  // namespace

std::optional<Change> wrong_term(const PublishedEquation& equation, Expr difference, Vocabulary& words,
                                 const SymbolNames& names, std::vector<PointValues>& points) {
  if (!is_one_term(difference)) return std::nullopt;
  return Search(equation, difference, words, names, points).run();
}

}  // namespace anholon
