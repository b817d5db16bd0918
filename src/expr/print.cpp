#include "expr/print.h"

#include <algorithm>
#include <array>
#include <cctype>

namespace anholon {

namespace {

enum Strength : int { kSum = 1, kProduct = 2, kPower = 3, kAtom = 4 };

struct Printed {
  std::string text;
  int strength = kAtom;
  bool negative = false;  // starts with a minus sign
};

const std::array kGreekNames = {
    "alpha", "beta", "gamma", "delta", "epsilon", "zeta", "eta", "theta", "iota", "kappa", "lambda",
    "mu", "nu", "xi", "pi", "rho", "sigma", "tau", "upsilon", "phi", "chi", "psi", "omega", "Gamma",
    "Delta", "Theta", "Lambda", "Xi", "Pi", "Sigma", "Phi", "Psi", "Omega"};

bool is_greek(const std::string& s) {
  return std::find(kGreekNames.begin(), kGreekNames.end(), s) != kGreekNames.end();
}

std::string latex_escape(const std::string& name) {
  std::string escaped;
  for (char c : name) escaped += c == '_' ? "\\_" : std::string(1, c);
  return escaped;
}

class Printer {
 public:
  Printer(Graph& g, const SymbolNames& names, Format format) : g_(g), names_(names), format_(format) {}

  std::vector<std::string> run(std::span<const Expr> es) {
    std::vector<NodeId> ids;
    std::vector<bool> seen(g_.size(), false);
    for (Expr e : es)
      if (!seen[e.id]) seen[e.id] = true, ids.push_back(e.id);
    for (std::size_t i = 0; i < ids.size(); ++i) {
      if (names_.defined.count(ids[i])) continue;
      for (const Term& t : g_.terms(ids[i]))
        if (!seen[t.node]) seen[t.node] = true, ids.push_back(t.node);
    }
    std::sort(ids.begin(), ids.end());
    for (Expr e : es) ++uses_[e.id];
    for (NodeId id : ids)
      if (!names_.defined.count(id))
        for (const Term& t : g_.terms(id)) ++uses_[t.node];
    for (NodeId id : ids) {
      done_[id] = node(id);
      if (names_.defined.count(id)) continue;
      // The text of an operand goes with its last use: a deep formula needs no more than its length.
      for (const Term& t : g_.terms(id))
        if (--uses_[t.node] == 0) done_.erase(t.node);
    }
    std::vector<std::string> out;
    for (Expr e : es) out.push_back(done_[e.id].text);
    return out;
  }

 private:
  bool latex() const { return format_ == Format::latex; }

  // The place of a node among its neighbours.
  struct Rank {
    int kind, order;
  };
  Rank rank(NodeId id) {
    const auto it = rank_.find(id);
    if (it != rank_.end()) return it->second;
    Rank r{0, -1};
    const Node& n = g_.node(id);
    switch (n.kind) {
      case Kind::number: case Kind::pi: r.kind = 0; break;
      case Kind::parameter: r.kind = 1; break;
      case Kind::mass: r.kind = 2; break;
      case Kind::multiplier: r.kind = 3; break;
      case Kind::quasi: r = {5, static_cast<int>(n.order) + 1}; break;
      case Kind::given: case Kind::time: r.kind = 4; break;
      case Kind::jet: r = {5, n.order}; break;
      case Kind::function: case Kind::atan2: r.kind = 6; break;
      case Kind::sum: case Kind::product: r.kind = 7; break;
    }
    // Operands were ranked before (ids ascend), so this does not go deep.
    for (const Term& t : g_.terms(id))
      if (const auto o = rank_.find(t.node); o != rank_.end()) r.order = std::max(r.order, o->second.order);
    return rank_[id] = r;
  }

  std::string cut(std::string s) const { return s.size() > kLongestPrint ? "…" : std::move(s); }

  std::string symbol(const std::vector<std::string>& list, const Node& n, const char* prefix) const {
    std::string base = n.index < list.size() ? list[n.index] : prefix + std::to_string(n.index);
    return derivative_name(latex() ? latex_name(base) : base, n.order, format_);
  }

  Printed node(NodeId id) {
    rank(id);
    if (const auto it = names_.defined.find(id); it != names_.defined.end())
      return {latex() ? latex_name(it->second) : it->second};
    const Node& n = g_.node(id);
    switch (n.kind) {
      case Kind::number: return number(g_.value(id));
      case Kind::pi: return {latex() ? "\\pi" : "pi"};
      case Kind::time: return {"t"};
      case Kind::jet: return {symbol(names_.coordinates, n, "q")};
      case Kind::parameter: return {symbol(names_.parameters, n, "p")};
      case Kind::mass: return {symbol(names_.masses, n, "mu")};
      case Kind::given: return {symbol(names_.given, n, "f")};
      case Kind::quasi: return {symbol(names_.quasi, n, "u")};
      case Kind::multiplier: {
        const std::string base = n.index < names_.multipliers.size() ? names_.multipliers[n.index] : std::to_string(n.index);
        return {derivative_name(latex() ? "\\lambda_{\\mathrm{" + latex_escape(base) + "}}" : "lambda." + base, n.order, format_)};
      }
      case Kind::function: {
        const FunctionInfo& f = info(static_cast<Function>(n.index));
        const std::string& u = done_[g_.terms(id)[0].node].text;
        return {cut(latex() ? std::string(f.latex) + "\\left(" + u + "\\right)" : std::string(f.name) + "(" + u + ")")};
      }
      case Kind::atan2: {
        const std::string &y = done_[g_.terms(id)[0].node].text, &x = done_[g_.terms(id)[1].node].text;
        return {cut(latex() ? "\\operatorname{atan2}\\left(" + y + ", " + x + "\\right)" : "atan2(" + y + ", " + x + ")")};
      }
      case Kind::sum: return sum(id);
      case Kind::product: return product(id);
    }
    return {};
  }

  Printed number(const Rational& r) const {
    const bool negative = r < 0;
    if (r.get_den() == 1) return {r.get_str(), negative ? kSum : kAtom, negative};
    const Rational a = abs(r);
    std::string s = latex() ? "\\frac{" + a.get_num().get_str() + "}{" + a.get_den().get_str() + "}" : a.get_str();
    if (negative) s = "-" + s;
    return {std::move(s), negative ? kSum : kProduct, negative};
  }

  std::string wrap(const Printed& p, int strength) const {
    if (p.strength >= strength) return p.text;
    return latex() ? "\\left(" + p.text + "\\right)" : "(" + p.text + ")";
  }

  std::string join(const std::string& a, const std::string& b) const {
    return a.empty() ? b : b.empty() ? a : a + (latex() ? " \\, " : "*") + b;
  }

  // |coefficient| * term, without sign.
  std::string weighted(const Rational& coefficient, NodeId id) {
    const Rational c = abs(coefficient);
    if (g_.is_number(id) && g_.value(id) == 1) return number(c).text;
    if (c == 1) return wrap(done_[id], kProduct);
    const std::string body = wrap(done_[id], kProduct);
    if (c.get_den() == 1) return join(c.get_num().get_str(), body);
    if (latex()) return join(number(c).text, body);
    const std::string top = c.get_num() == 1 ? body : join(c.get_num().get_str(), body);
    return top + "/" + c.get_den().get_str();
  }

  Printed sum(NodeId id) {
    std::vector<Term> terms(g_.terms(id).begin(), g_.terms(id).end());
    std::stable_sort(terms.begin(), terms.end(), [&](const Term& a, const Term& b) {
      const Rank ra = rank(a.node), rb = rank(b.node);
      return ra.order > rb.order;
    });
    std::string out;
    bool negative = false;
    for (const Term& t : terms) {
      const Rational& c = g_.rational(t.weight);
      if (out.empty()) {
        negative = c < 0;
        out = (negative ? "-" : "") + weighted(c, t.node);
      } else {
        out += (c < 0 ? " - " : " + ") + weighted(c, t.node);
      }
      if (out.size() > kLongestPrint) return {"…"};
    }
    return {std::move(out), terms.size() == 1 && !negative ? kProduct : kSum, negative};
  }

  Printed power(NodeId base, const Rational& exponent) {
    if (exponent == 1) return done_[base];
    if (exponent == Rational(1, 2))
      return {latex() ? "\\sqrt{" + done_[base].text + "}" : "sqrt(" + done_[base].text + ")"};
    const std::string b = wrap(done_[base], kAtom);
    if (latex()) return {"{" + b + "}^{" + exponent.get_str() + "}", kPower};
    const bool plain = exponent.get_den() == 1 && exponent > 0;
    return {b + "^" + (plain ? exponent.get_str() : "(" + exponent.get_str() + ")"), kPower};
  }

  Printed product(NodeId id) {
    std::vector<Term> terms(g_.terms(id).begin(), g_.terms(id).end());
    std::stable_sort(terms.begin(), terms.end(), [&](const Term& a, const Term& b) {
      const Rank ra = rank(a.node), rb = rank(b.node);
      return ra.kind != rb.kind ? ra.kind < rb.kind : false;
    });
    std::string top, bottom;
    int below = 0;
    for (const Term& t : terms) {
      const Rational& e = g_.rational(t.weight);
      if (e < 0) {
        const Printed p = power(t.node, -e);
        bottom = join(bottom, latex() && terms.size() == 1 ? p.text : wrap(p, kProduct));
        below += p.strength < kPower ? 2 : 1;
      } else {
        top = join(top, wrap(power(t.node, e), kProduct));
      }
    }
    if (bottom.empty()) return {cut(top), terms.size() == 1 ? power(terms[0].node, g_.rational(terms[0].weight)).strength : kProduct};
    if (top.empty()) top = "1";
    if (latex()) return {cut("\\frac{" + top + "}{" + bottom + "}"), kProduct};
    return {cut(top + "/" + (below > 1 ? "(" + bottom + ")" : bottom)), kProduct};
  }

  Graph& g_;
  const SymbolNames& names_;
  Format format_;
  std::unordered_map<NodeId, Printed> done_;
  std::unordered_map<NodeId, std::size_t> uses_;
  std::unordered_map<NodeId, Rank> rank_;
};

}  // namespace

std::string latex_name(const std::string& name) {
  if (is_greek(name)) return "\\" + name;
  if (name.size() == 1) return name;
  std::size_t digits = name.size();
  while (digits > 0 && std::isdigit(static_cast<unsigned char>(name[digits - 1]))) --digits;
  const std::size_t underscore = name.find('_');
  if (digits < name.size() && digits > 0 && underscore == std::string::npos)
    return latex_name(name.substr(0, digits)) + "_{" + name.substr(digits) + "}";
  if (underscore != std::string::npos && underscore > 0 && underscore + 1 < name.size())
    return latex_name(name.substr(0, underscore)) + "_{" + latex_name(name.substr(underscore + 1)) + "}";
  return "\\mathrm{" + latex_escape(name) + "}";
}

std::string derivative_name(const std::string& name, unsigned order, Format format) {
  if (order == 0) return name;
  if (format == Format::latex) {
    static const char* const kDots[] = {"\\dot{", "\\ddot{", "\\dddot{"};
    if (order <= 3) return kDots[order - 1] + name + "}";
    return name + "^{(" + std::to_string(order) + ")}";
  }
  if (order <= 3) return name + std::string(order, '\'');
  return "D(" + name + "," + std::to_string(order) + ")";
}

std::vector<std::string> print(std::span<const Expr> es, const SymbolNames& names, Format format) {
  if (es.empty()) return {};
  return Printer(*es[0].graph, names, format).run(es);
}

std::string print(Expr e, const SymbolNames& names, Format format) {
  return print(std::span<const Expr>(&e, 1), names, format)[0];
}

}  // namespace anholon
