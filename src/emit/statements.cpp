#include "emit/statements.h"

#include <algorithm>

#include "base/assert.h"
#include "emit/text.h"
#include "expr/derivatives/squares.h"

namespace anholon::emit {

namespace {

// A node that is used once is written inline, up to this length.
constexpr std::size_t kLongestInline = 72;
// Longer sums and products are computed in parts: compilers recurse over their terms.
constexpr std::size_t kMostPieces = 24;
constexpr std::size_t kLineWidth = 100;
// Whole powers up to this exponent are products.
constexpr int kLargestProduct = 4;
constexpr int kSum = 1, kProduct = 2, kPower = 3, kAtom = 4;

const char* function_name(Function f, Language language) { return language == Language::c ? info(f).c : info(f).numpy; }

// Returns how often the text of a power contains its base.
std::size_t bases(const Rational& exponent) {
  const Rational r = abs(exponent);
  if (r.is_integer() && r <= kLargestProduct) return r.get_num().get_ui();
  return r == Rational(3, 2) ? 2 : 1;
}

}  // namespace

std::string Writer::wrapped(const Text& t, int strength) { return t.strength >= strength ? t.s : "(" + t.s + ")"; }

std::string Writer::fresh() {
  std::string name;
  do name = "w" + std::to_string(++next_);
  while (names_.taken(name));
  return name;
}

Writer::Text Writer::power(NodeId base, const Rational& exponent) const {
  const Text& x = text_.at(base);
  if (exponent == 1) return x;
  const bool of_library =
      roots_ == RootsOfSquares::of_library && !exponent.is_integer() && exponent > 0 && is_sum_of_squares(g_, base);
  const std::string begin = of_library ? "_root(np, " : language_ == Language::c ? "sqrt(" : "np.sqrt(";
  const Text root{begin + x.s + ")", kAtom};
  if (exponent == Rational(1, 2)) return root;
  if (exponent == Rational(3, 2)) return {wrapped(x, kAtom) + "*" + root.s, kProduct};
  if (exponent.is_integer() && exponent <= kLargestProduct) {
    std::string out = wrapped(x, kAtom);
    for (long k = exponent.to_long(); k > 1; --k) out += "*" + wrapped(x, kAtom);
    return {out, kProduct};
  }
  const std::string e = number(exponent);
  if (of_library && exponent < 1) return {begin + x.s + ", " + e + ")", kAtom};
  if (language_ == Language::c) return {"pow(" + x.s + ", " + e + ")", kAtom};
  return {wrapped(x, kAtom) + "**" + (e.find('/') == std::string::npos ? e : "(" + e + ")"), kPower};
}

const GeneralPowers* Writer::powers(NodeId id) {
  const auto [at, fresh] = general_.try_emplace(id);
  if (fresh) at->second = general_powers(g_, id);
  return at->second ? &*at->second : nullptr;
}

std::vector<Term> Writer::without_powers(NodeId product, GeneralPowers& out) {
  const std::span<const Term> all = g_.terms(product);
  std::set<NodeId> joined;
  const auto whole_power_of = [&](const Term& t, NodeId base) {
    return t.node == base && g_.rational(t.weight).is_integer();
  };
  for (const Term& t : all) {
    const GeneralPowers* p = g_.rational(t.weight) == 1 ? powers(t.node) : nullptr;
    const bool joins = p && std::any_of(p->powers.begin(), p->powers.end(), [&](const GeneralPower& one) {
                         return std::any_of(all.begin(), all.end(),
                                            [&](const Term& other) { return whole_power_of(other, one.base); });
                       });
    if (!joins) continue;
    for (const GeneralPower& one : p->powers) join_powers(out.powers, one);
    out.rest.insert(out.rest.end(), p->rest.begin(), p->rest.end());
    out.constant += p->constant;
    joined.insert(t.node);
  }
  std::vector<Term> terms;
  for (const Term& t : all) {
    const auto same = std::find_if(out.powers.begin(), out.powers.end(),
                                   [&](const GeneralPower& p) { return whole_power_of(t, p.base); });
    if (same != out.powers.end())
      same->constant += g_.rational(t.weight);
    else if (!joined.count(t.node))
      terms.push_back(t);
  }
  return terms;
}

std::vector<Writer::Use> Writer::read_by(NodeId id) {
  std::vector<Use> list;
  const auto add = [&](const GeneralPowers& p) {
    for (const NodeId node : p.operands()) list.push_back({node, 1});
  };
  if (const GeneralPowers* p = powers(id)) {
    add(*p);
  } else if (g_.node(id).kind == Kind::product) {
    GeneralPowers joined;
    for (const Term& t : without_powers(id, joined)) list.push_back({t.node, g_.rational(t.weight)});
    add(joined);
  } else {
    for (const Term& t : g_.summands(id)) list.push_back({t.node, 1});
  }
  return list;
}

// Returns the nodes that are read, operands first.
std::vector<NodeId> Writer::needed(const Column& es) {
  std::vector<NodeId> ids;
  std::vector<bool> seen(g_.size(), false);
  const auto add = [&](NodeId id) {
    if (!seen[id]) ids.push_back(id);
    seen[id] = true;
  };
  for (Expr e : es) add(e.id);
  for (std::size_t i = 0; i < ids.size(); ++i)
    for (const Use& u : read_by(ids[i])) add(u.node);
  std::sort(ids.begin(), ids.end());
  return ids;
}

std::vector<Writer::Piece> Writer::factors(const GeneralPowers& all) const {
  const auto sum = [&](const std::vector<FactorOfExponent>& terms, const Rational& constant) {
    std::string out;
    const auto add = [&](const Rational& c, const std::string& body) {
      out += out.empty() ? c < 0 ? "-" : "" : c < 0 ? " - " : " + ";
      out += body.empty() ? number(abs(c)) : abs(c) == 1 ? body : number(abs(c)) + "*" + body;
    };
    for (const FactorOfExponent& f : terms) {
      std::string body;
      for (const auto& [node, exponent] : f.of)
        body += (body.empty()   ? (exponent < 0 ? "1.0/" : "")
                 : exponent < 0 ? "/"
                                : "*") +
                wrapped(power(node, abs(exponent)), f.of.size() == 1 && exponent > 0 ? kProduct : kPower);
      add(f.factor, body);
    }
    if (constant != 0 || terms.empty()) add(constant, "");
    return out;
  };
  const bool c = language_ == Language::c;
  std::vector<Piece> out;
  for (const GeneralPower& p : all.powers)
    out.push_back({'*', (c ? "pow(" : "np.power(") + text_.at(p.base).s + ", " + sum(p.terms, p.constant) + ")"});
  std::vector<FactorOfExponent> rest;
  for (const auto& [node, coefficient] : all.rest) rest.push_back({coefficient, {{node, 1}}});
  if (!rest.empty() || all.constant != 0)
    out.push_back({'*', std::string(function_name(Function::exp, language_)) + "(" + sum(rest, all.constant) + ")"});
  return out;
}

// Roots and reciprocals that are used more than once get variables.
void Writer::name_powers(NodeId id, Statements& body) {
  GeneralPowers general;
  for (const Term& t : without_powers(id, general)) {
    const Rational& e = g_.rational(t.weight);
    const auto uses = power_uses_.find({t.node, e});
    if (uses == power_uses_.end() || uses->second < 2 || powers_.count(uses->first)) continue;
    const Text x = power(t.node, abs(e));
    const std::string name = fresh();
    body.text += assign(name, {{e < 0 ? '/' : '*', e < 0 ? wrapped(x, kPower) : x.s}}, true);
    powers_[uses->first] = name;
  }
}

std::vector<Writer::Piece> Writer::product(NodeId id) {
  std::vector<Text> bottom;
  std::vector<Piece> out;
  // x*x needs no brackets among other factors, a quotient of numbers does.
  const auto factor = [](const Text& x) {
    return x.s.find('/') == std::string::npos ? wrapped(x, kProduct) : wrapped(x, kPower);
  };
  GeneralPowers general;
  const std::vector<Term> terms = without_powers(id, general);
  if (!general.powers.empty()) out = factors(general);
  for (const Term& t : terms) {
    const Rational& e = g_.rational(t.weight);
    if (const auto named = powers_.find({t.node, e}); named != powers_.end())
      out.push_back({'*', named->second});
    else if (e < 0)
      bottom.push_back(power(t.node, -e));
    else
      out.push_back({'*', factor(power(t.node, e))});
  }
  if (bottom.size() > 1 && bottom.size() <= kMostPieces) {
    std::string all;
    for (const Text& x : bottom) all += (all.empty() ? "" : "*") + factor(x);
    out.push_back({'/', "(" + all + ")"});
  } else {
    for (const Text& x : bottom) out.push_back({'/', wrapped(x, kPower)});
  }
  return out;
}

std::vector<Writer::Piece> Writer::sum(NodeId id) {
  std::vector<Piece> out;
  for (const Term& t : g_.summands(id)) {
    Rational c = g_.rational(t.weight);
    if (g_.is_number(t.node)) {
      c *= g_.value(t.node);
      out.push_back({c < 0 ? '-' : '+', number(abs(c))});
      continue;
    }
    const Text& x = text_.at(t.node);
    const char op = c < 0 ? '-' : '+';
    c = abs(c);
    if (c == 1)
      out.push_back({op, wrapped(x, kProduct)});
    else if (x.strength == kProduct && x.s.compare(0, 4, "1.0/") == 0)
      out.push_back({op, number(c) + x.s.substr(3)});
    else
      out.push_back({op, number(c) + "*" + wrapped(x, kProduct)});
  }
  return out;
}

std::string Writer::call(NodeId id) {
  const Node& n = g_.node(id);
  const auto choice = [&](const std::string& condition, const std::string& a, const std::string& b) {
    return language_ == Language::c ? "(" + condition + " ? " + a + " : " + b + ")"
                                    : "np.where(" + condition + ", " + a + ", " + b + ")";
  };
  if (n.kind == Kind::select) {
    const std::span<const Term> t = g_.terms(id);
    return choice(wrapped(text_.at(t[0].node), kSum) + " >= 0", text_.at(t[1].node).s, text_.at(t[2].node).s);
  }
  if (n.kind == Kind::lookup) {
    const StepFunction& f = g_.step_function(n.index);
    const std::string& x = text_.at(g_.terms(id)[0].node).s;
    return language_ == Language::python ? python_lookup(f, x) : c_lookup(f, x);
  }
  if (n.kind == Kind::atan2)
    return std::string(language_ == Language::c ? "atan2(" : "np.arctan2(") + text_.at(g_.terms(id)[0].node).s + ", " +
           text_.at(g_.terms(id)[1].node).s + ")";
  const Function f = static_cast<Function>(n.index);
  used_sign_ = used_sign_ || f == Function::sign;
  return std::string(function_name(f, language_)) + "(" + text_.at(g_.terms(id)[0].node).s + ")";
}

static std::string joined(char op, const std::string& s, bool first) {
  switch (op) {
  case '+':
    return first ? s : " + " + s;
  case '-':
    return first ? "-" + s : " - " + s;
  case '*':
    return first ? s : "*" + s;
  default:
    return first ? "1.0/" + s : "/" + s;
  }
}

std::string Writer::assign(const std::string& name, const std::vector<Piece>& all, bool declare) const {
  const bool c = language_ == Language::c;
  std::string out;
  for (std::size_t from = 0; from < all.size(); from += kMostPieces) {
    const std::size_t to = std::min(all.size(), from + kMostPieces);
    std::string begin = c ? "  " : "    ";
    if (c && declare && from == 0) begin += to < all.size() ? "double " : "const double ";
    begin += name + " = ";
    if (from > 0) begin += name;
    std::string line, text;
    bool broken = false;
    const std::string indent(c ? 6 : 8, ' ');
    for (std::size_t i = from; i < to; ++i) {
      const std::string piece = joined(all[i].op, all[i].s, i == 0);
      const std::size_t before = broken ? indent.size() : begin.size() + 1;
      if (!line.empty() && before + line.size() + piece.size() + 2 > kLineWidth) {
        text += line + "\n" + indent;
        broken = true;
        line = piece[0] == ' ' ? piece.substr(1) : piece;
      } else {
        line += piece;
      }
    }
    text += line;
    // A line break would end a statement in Python, so broken lines are put in brackets.
    if (!c && broken) {
      if (from > 0)
        out += begin.substr(0, begin.size() - name.size()) + "(" + name + text + ")\n";
      else
        out += begin + "(" + text + ")\n";
    } else {
      out += begin + text + (c ? ";\n" : "\n");
    }
  }
  return out;
}

void Writer::write(NodeId id, Statements& body) {
  const Node& n = g_.node(id);
  std::vector<Piece> pieces;
  int strength = kAtom;
  switch (n.kind) {
  case Kind::number: {
    const std::string s = number(g_.value(id));
    text_[id] = {s, s[0] == '-' ? kSum : s.find('/') != std::string::npos ? kProduct : kAtom};
    return;
  }
  case Kind::pi:
    text_[id] = {language_ == Language::c ? "3.14159265358979323846" : "np.pi", kAtom};
    return;
  case Kind::time:
  case Kind::jet:
  case Kind::parameter:
  case Kind::multiplier:
  case Kind::control:
  case Kind::state:
    text_[id] = {names_.symbol(id), kAtom};
    return;
  case Kind::mass:
  case Kind::given:
  case Kind::quasi:
    ANHOLON_ASSERT(!"a frozen mass, unknown function or quasi-velocity in a program");
    return;
  case Kind::sum:
    pieces = sum(id), strength = kSum;
    break;
  case Kind::product:
    name_powers(id, body);
    pieces = product(id), strength = kProduct;
    break;
  case Kind::function:
  case Kind::atan2:
  case Kind::select:
  case Kind::lookup:
    if (const GeneralPowers* p = powers(id))
      pieces = factors(*p), strength = pieces.size() > 1 ? kProduct : kAtom;
    else
      pieces = {{'*', call(id)}};
    break;
  }
  std::size_t length = 0;
  for (const Piece& p : pieces) length += p.s.size() + 3;
  if (uses_[id] <= 1 && length <= kLongestInline) {
    std::string s;
    for (std::size_t i = 0; i < pieces.size(); ++i) s += joined(pieces[i].op, pieces[i].s, i == 0);
    text_[id] = {s, strength};
    return;
  }
  const std::string name = fresh();
  body.text += assign(name, pieces, true);
  text_[id] = {name, kAtom};
}

void Writer::load(const std::vector<NodeId>& ids, Statements& body) {
  struct Read {
    std::size_t array, index;
    NodeId id;
    auto operator<=>(const Read&) const = default;
  };
  std::vector<Read> all;
  for (NodeId id : ids) {
    if (g_.node(id).kind == Kind::time) body.time = true;
    if (const LocalNames::Place* place = names_.place(id)) all.push_back({place->array, place->index, id});
  }
  std::sort(all.begin(), all.end());
  for (const Read& r : all) {
    const std::string& array = names_.arrays()[r.array];
    body.text += assign(names_.symbol(r.id), {{'+', array + "[" + std::to_string(r.index) + "]"}}, true);
    body.arrays.insert(array);
  }
}

Statements Writer::body(const Column& es, const std::vector<std::string>& targets, bool sparse) {
  Statements body;
  text_.clear();
  uses_.clear();
  power_uses_.clear();
  powers_.clear();
  next_ = 0;
  const std::vector<NodeId> ids = needed(es);
  for (Expr e : es) ++uses_[e.id];
  for (NodeId id : ids)
    for (const auto& [node, e] : read_by(id)) {
      uses_[node] += bases(e);
      if (e < 0 || !e.is_integer()) ++power_uses_[{node, e}];
    }
  load(ids, body);
  for (NodeId id : ids) write(id, body);
  for (std::size_t i = 0; i < es.size(); ++i)
    if (!sparse || !is_zero(es[i])) body.text += assign(targets[i], {{'+', text_.at(es[i].id).s}}, false);
  return body;
}

}  // namespace anholon::emit
