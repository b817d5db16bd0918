#include "print/print.h"

#include <algorithm>
#include <map>

#include "print/powers.h"
#include "print/print_names.h"
#include "print/spelling.h"

namespace anholon {

namespace {

std::string written_name(const std::string& name, Format format) {
  switch (format) {
  case Format::text:
    return name;
  case Format::latex:
    return latex_name(name);
  case Format::mathml:
    return mathml_name(name);
  }
  return name;
}

class Printer : Spelling {
 public:
  Printer(Graph& g, const SymbolNames& names, Format format) : Spelling(format, kLongestPrint), g_(g), names_(names) {
    for (const auto& [id, name] : names.defined) {
      const std::span<const Term> terms = g.terms(id);
      if (g.node(id).kind == Kind::product && terms.size() == 1 && g.rational(terms[0].weight).get_num() == 1)
        roots_.emplace(std::pair{terms[0].node, g.rational(terms[0].weight).get_den()}, name);
    }
  }

  std::vector<std::string> run(std::span<const Expr> es) {
    std::vector<NodeId> ids;
    std::vector<bool> seen(g_.size(), false);
    for (Expr e : es)
      if (!seen[e.id]) seen[e.id] = true, ids.push_back(e.id);
    for (std::size_t i = 0; i < ids.size(); ++i) {
      if (names_.defined.count(ids[i])) continue;
      for (const NodeId o : read_by(ids[i]))
        if (!seen[o]) seen[o] = true, ids.push_back(o);
    }
    std::sort(ids.begin(), ids.end());
    for (Expr e : es) ++uses_[e.id];
    for (NodeId id : ids)
      if (!names_.defined.count(id))
        for (const NodeId o : read_by(id)) ++uses_[o];
    for (NodeId id : ids) {
      done_[id] = node(id);
      if (names_.defined.count(id)) continue;
      // The text of an operand is released at its last use: a deep formula needs no more memory than its length.
      for (const NodeId o : read_by(id))
        if (--uses_[o] == 0) done_.erase(o);
    }
    std::vector<std::string> out;
    for (Expr e : es) out.push_back(done_[e.id].text);
    return out;
  }

  std::vector<std::string> contents(std::span<const Expr> es) {
    std::vector<NodeId> ids;
    std::vector<bool> seen(g_.size(), false), root(g_.size(), false);
    for (Expr e : es)
      if (!seen[e.id]) seen[e.id] = root[e.id] = true, ids.push_back(e.id);
    for (std::size_t i = 0; i < ids.size(); ++i) {
      if (!root[ids[i]] && names_.defined.count(ids[i])) continue;
      for (const NodeId o : read_by(ids[i]))
        if (!seen[o]) seen[o] = true, ids.push_back(o);
    }
    std::sort(ids.begin(), ids.end());
    std::unordered_map<NodeId, std::string> texts;
    for (NodeId id : ids) {
      rank(id);
      if (root[id]) texts[id] = content(id).text;
      done_[id] = node(id);
    }
    std::vector<std::string> out;
    for (Expr e : es) out.push_back(texts[e.id]);
    return out;
  }

 private:
  std::span<const Term> operands(NodeId id) const { return names_.short_sums ? g_.summands(id) : g_.terms(id); }

  // Returns exp(n*log(x)) as x^n, which is read as the same node; nullptr if `id` is printed unchanged.
  const GeneralPower* power_of(NodeId id) {
    const Node& n = g_.node(id);
    if (n.kind != Kind::function || static_cast<Function>(n.index) != Function::exp) return nullptr;
    const auto [at, fresh] = powers_.try_emplace(id);
    if (fresh && !names_.defined.count(g_.terms(id)[0].node)) at->second = general_powers(g_, id);
    const std::optional<GeneralPowers>& p = at->second;
    return p && p->powers.size() == 1 && p->rest.empty() && p->constant == 0 ? &p->powers[0] : nullptr;
  }

  // Returns the nodes whose texts the text of a node contains.
  std::vector<NodeId> read_by(NodeId id) {
    if (power_of(id)) return powers_.at(id)->operands();
    std::vector<NodeId> list;
    for (const Term& t : operands(id)) list.push_back(t.node);
    return list;
  }

  // The sort key of a node among its neighbours.
  struct Rank {
    int kind, order;       // highest derivative
    bool inside = false;   // the derivative is within brackets
    bool constant = true;  // parameters and masses only
  };
  Rank rank(NodeId id) {
    const auto it = rank_.find(id);
    if (it != rank_.end()) return it->second;
    Rank r{0, -1};
    const Node& n = g_.node(id);
    switch (n.kind) {
    case Kind::number:
    case Kind::pi:
      r.kind = 0;
      break;
    case Kind::parameter:
      r.kind = 1;
      break;
    case Kind::mass:
      r.kind = 2;
      break;
    case Kind::multiplier:
      r.kind = 4;
      break;
    case Kind::given:
    case Kind::time:
      r.kind = 5;
      break;
    case Kind::jet:
      r = {6, n.order};
      break;
    case Kind::quasi:
      r = {6, static_cast<int>(n.order) + 1};
      break;
    case Kind::state:
    case Kind::control:
      r = {5, static_cast<int>(n.order)};
      break;
    case Kind::function:
    case Kind::atan2:
    case Kind::select:
    case Kind::lookup:
      r.kind = 7;
      break;
    case Kind::sum:
    case Kind::product:
      r.kind = 8;
      break;
    }
    r.constant = r.kind <= 2 || r.kind >= 7;
    // Operands have been ranked before (ids ascend), so the recursion is not deep.
    std::vector<NodeId> of;
    if (power_of(id))
      of = read_by(id);
    else
      for (const Term& t : g_.terms(id)) of.push_back(t.node);
    for (const NodeId operand : of)
      if (const auto o = rank_.find(operand); o != rank_.end()) {
        if (o->second.order > r.order) r.order = o->second.order, r.inside = true;
        if (o->second.order == r.order) r.inside &= o->second.inside;
        r.constant &= o->second.constant;
      }
    if (n.kind == Kind::sum || n.kind == Kind::function || n.kind == Kind::atan2 || n.kind == Kind::select ||
        n.kind == Kind::lookup)
      r.inside = true;
    if (n.kind == Kind::sum && r.constant) r.kind = 3;
    return rank_[id] = r;
  }

  // Returns the spelling given by [notation], or by the rules for names.
  std::string written(const std::string& name) const {
    const auto chosen = names_.notation.find(name);
    if (chosen == names_.notation.end() || format_ == Format::text) return written_name(name, format_);
    return latex() ? chosen->second.latex : chosen->second.mathml;
  }

  std::string symbol(const std::vector<std::string>& list, const Node& n, const char* prefix) const {
    const std::string base = n.index < list.size() ? list[n.index] : prefix + std::to_string(n.index);
    return derivative_name(written(base), n.order, format_);
  }

  Printed node(NodeId id) {
    rank(id);
    if (const auto it = names_.defined.find(id); it != names_.defined.end()) return {written(it->second)};
    return content(id);
  }

  Printed content(NodeId id) {
    const Node& n = g_.node(id);
    switch (n.kind) {
    case Kind::number:
      return number(g_.value(id));
    case Kind::pi:
      return {written_name("pi", format_)};
    case Kind::time:
      return {written_name("t", format_)};
    case Kind::jet:
      return {symbol(names_.coordinates, n, "q")};
    case Kind::parameter:
      return {symbol(names_.parameters, n, "p")};
    case Kind::mass:
      return {symbol(names_.masses, n, "mu")};
    case Kind::given:
      return {symbol(names_.given, n, "f")};
    case Kind::quasi:
      return {symbol(names_.quasi, n, "u")};
    case Kind::state:
      return {symbol(names_.states, n, "z")};
    case Kind::control:
      return {symbol(names_.controls, n, "u")};
    case Kind::multiplier: {
      const std::string base =
          n.index < names_.multipliers.size() ? names_.multipliers[n.index] : std::to_string(n.index);
      const auto indexed = indexed_name(base);
      const auto chosen = names_.notation.find(base);
      const bool plain = chosen == names_.notation.end();
      const std::string own =
          "\\mathrm{" + latex_escape(indexed ? indexed->first : base) + "}" + (indexed ? "," + indexed->second : "");
      const std::string name =
          latex()    ? "\\lambda_{" + (plain ? own : chosen->second.latex) + "}"
          : mathml() ? "<msub><mi>λ</mi>" +
                           (plain ? "<mtext>" + markup_escape(base) + "</mtext>" : chosen->second.mathml) + "</msub>"
                     : "lambda." + base;
      return {derivative_name(name, n.order, format_)};
    }
    case Kind::function: {
      if (const GeneralPower* p = power_of(id)) return text_of(*this, done_, *p);
      const FunctionInfo& f = info(static_cast<Function>(n.index));
      return {call(f.name, f.latex, done_[g_.terms(id)[0].node].text)};
    }
    case Kind::atan2: {
      const std::string &y = done_[g_.terms(id)[0].node].text, &x = done_[g_.terms(id)[1].node].text;
      return {call("atan2", "\\operatorname{atan2}", y + (mathml() ? "<mo>,</mo>" : ", ") + x)};
    }
    case Kind::select:
      return branches(id);
    case Kind::lookup: {
      const std::string& name = g_.step_function(n.index).name;
      return {call(name, "\\operatorname{" + latex_escape(name) + "}", done_[g_.terms(id)[0].node].text)};
    }
    case Kind::sum:
      return sum(id);
    case Kind::product:
      return product(id);
    }
    return {};
  }

  // Prints piecewise(s >= 0, a, b).
  Printed branches(NodeId id) const {
    const std::span<const Term> t = g_.terms(id);
    const std::string &s = done_.at(t[0].node).text, &a = done_.at(t[1].node).text, &b = done_.at(t[2].node).text;
    if (latex())
      return {cut("\\begin{cases} " + a + " & " + s + " \\ge 0 \\\\ " + b + " & \\text{else} \\end{cases}"), kSum};
    if (mathml())
      return {cut(row("<mo>{</mo><mtable><mtr><mtd>" + row(a) + "</mtd><mtd>" + row(s + "<mo>≥</mo><mn>0</mn>") +
                      "</mtd></mtr><mtr><mtd>" + row(b) + "</mtd><mtd><mtext>else</mtext></mtd></mtr></mtable>")),
              kSum};
    return {cut("piecewise(" + s + " >= 0, " + a + ", " + b + ")")};
  }

  // Returns c * term without its sign.
  std::string weighted(const Rational& c, NodeId id) const {
    if (g_.is_number(id) && g_.value(id) == 1) return number(c).text;
    return Spelling::weighted(c, done_.at(id));
  }

  Printed sum(NodeId id) {
    std::vector<Term> terms(operands(id).begin(), operands(id).end());
    // Highest derivatives come first; single accelerations come before accelerations in brackets.
    std::stable_sort(terms.begin(), terms.end(), [&](const Term& a, const Term& b) {
      const Rank ra = rank(a.node), rb = rank(b.node);
      if (ra.order != rb.order) return ra.order > rb.order;
      return ra.order >= 2 && !ra.inside && rb.inside;
    });
    // Among equal first terms, a positive one comes first if there is one.
    const auto below_zero = [&](const Term& t) {
      const Printed& p = done_.at(t.node);
      return (g_.rational(t.weight) < 0) == p.opposite.empty();
    };
    const auto alike = [&](const Term& t) {
      const Rank first = rank(terms[0].node), other = rank(t.node);
      return first.order == other.order && (first.order < 2 || first.inside == other.inside);
    };
    std::size_t positive = 0;
    while (positive < terms.size() && alike(terms[positive]) && below_zero(terms[positive])) ++positive;
    if (positive < terms.size() && alike(terms[positive]))
      std::rotate(terms.begin(), terms.begin() + static_cast<std::ptrdiff_t>(positive),
                  terms.begin() + static_cast<std::ptrdiff_t>(positive) + 1);

    const std::string plus_sign = mathml() ? "<mo>+</mo>" : " + ", minus_sign = mathml() ? minus() : " - ";
    Printed out;
    bool negative = false;
    for (const Term& t : terms) {
      const bool minus_here = below_zero(t);
      const std::string body = weighted(abs(g_.rational(t.weight)), t.node);
      if (out.text.empty()) {
        negative = minus_here;
        out.text = (negative ? minus() : "") + body;
        if (negative) out.opposite = body;
      } else {
        out.text += (minus_here ? minus_sign : plus_sign) + body;
        if (negative) out.opposite += (minus_here ? plus_sign : minus_sign) + body;
      }
      if (out.text.size() > kLongestPrint) return {cut(out.text)};
    }
    out.opposite_strength = terms.size() == 1 ? kProduct : kSum;
    out.strength = negative ? kSum : out.opposite_strength;
    return out;
  }

  Printed product(NodeId id) {
    std::vector<Term> terms(g_.terms(id).begin(), g_.terms(id).end());
    std::stable_sort(terms.begin(), terms.end(),
                     [&](const Term& a, const Term& b) { return rank(a.node).kind < rank(b.node).kind; });
    std::string top, bottom;
    int below = 0, strength = kProduct;
    bool negative = false;
    for (const Term& t : terms) {
      Rational e = g_.rational(t.weight);
      Printed base;
      if (const auto root = roots_.find({t.node, e.get_den()}); root != roots_.end()) {
        base.text = written(root->second);
        e = e.get_num();
      } else {
        base = done_[t.node];
      }
      if (!base.opposite.empty() && e.is_integer()) {
        if (mpz_odd_p(e.get_num().get_mpz_t())) negative = !negative;
        base = {base.opposite, base.opposite_strength};
      }
      const Printed p = power(base, abs(e));
      if (e < 0) {
        bottom = join(bottom, format_ != Format::text && terms.size() == 1 ? p.text : wrap(p, kProduct));
        below += p.strength == kProduct ? 2 : 1;
      } else {
        top = join(top, wrap(p, kProduct));
        if (terms.size() == 1) strength = p.strength < kProduct ? kAtom : p.strength;
      }
    }
    if (!bottom.empty()) {
      if (top.empty()) top = mathml() ? "<mn>1</mn>" : "1";
      top = fraction(top, below > 1 && format_ == Format::text ? "(" + bottom + ")" : bottom);
    }
    Printed p{cut(top), strength};
    return negative ? negated(std::move(p)) : p;
  }

  Graph& g_;
  const SymbolNames& names_;
  std::map<std::pair<NodeId, mpz_class>, std::string> roots_;  // defined names of x^(1/k)
  std::unordered_map<NodeId, Printed> done_;
  std::unordered_map<NodeId, std::size_t> uses_;
  std::unordered_map<NodeId, Rank> rank_;
  std::unordered_map<NodeId, std::optional<GeneralPowers>> powers_;
};

}  // namespace

std::vector<std::string> print_contents(std::span<const Expr> es, const SymbolNames& names, Format format) {
  if (es.empty()) return {};
  return Printer(*es[0].graph, names, format).contents(es);
}

std::vector<std::string> print(std::span<const Expr> es, const SymbolNames& names, Format format) {
  if (es.empty()) return {};
  return Printer(*es[0].graph, names, format).run(es);
}

std::string print(Expr e, const SymbolNames& names, Format format) {
  return print(std::span<const Expr>(&e, 1), names, format)[0];
}

}  // namespace anholon
