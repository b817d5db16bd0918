#include <algorithm>
#include <cctype>
#include <limits>

#include "base/assert.h"
#include "program/emit_text.h"

namespace anholon::emit {

namespace {

// A node used once is written where it is used, up to this length.
constexpr std::size_t kLongestInline = 72;
// Longer sums and products are computed in parts: compilers recurse over their terms.
constexpr std::size_t kMostPieces = 24;
constexpr std::size_t kLineWidth = 100;
// Whole powers up to this one are products.
constexpr int kLargestProduct = 4;
constexpr int kSum = 1, kProduct = 2, kPower = 3, kAtom = 4;

// Words of C, of Python, and what the texts use themselves.
constexpr const char* kReserved[] = {
    "auto", "break", "case", "char", "const", "continue", "default", "do", "double", "else", "enum", "extern", "float",
    "for", "goto", "if", "inline", "int", "long", "register", "restrict", "return", "short", "signed", "sizeof", "static",
    "struct", "switch", "typedef", "union", "unsigned", "void", "volatile", "while", "asm", "typeof", "bool", "true",
    "false", "nullptr", "constexpr", "alignas", "alignof", "static_assert", "thread_local", "linux", "unix", "and", "as",
    "assert", "async", "await", "class", "def", "del", "elif", "except", "finally", "from", "global", "import", "in", "is",
    "lambda", "nonlocal", "not", "or", "pass", "raise", "try", "with", "yield", "match", "type", "None", "True", "False",
    "np", "numpy", "main", "t", "state", "lead", "p", "out", "i", "sin", "cos", "tan", "asin", "acos", "atan", "sinh", "cosh",
    "tanh", "asinh", "acosh", "atanh", "exp", "log", "fabs", "sqrt", "pow", "atan2", "isfinite"};

std::string times_differentiated(int c) {
  return c == 0 ? "" : c == 1 ? ", differentiated once" : ", differentiated " + std::to_string(c) + " times";
}

// No control characters, no marks that turn the direction of writing, nothing that ends a comment.
std::string harmless(const std::string& s) {
  std::string out;
  for (std::size_t i = 0; i < s.size(); ++i) {
    const unsigned char c = static_cast<unsigned char>(s[i]);
    if (c == 0xE2 && i + 2 < s.size()) {
      const unsigned char b = static_cast<unsigned char>(s[i + 1]), a = static_cast<unsigned char>(s[i + 2]);
      if ((b == 0x80 && (a == 0x8E || a == 0x8F || (a >= 0xA8 && a <= 0xAE))) || (b == 0x81 && a >= 0xA6 && a <= 0xA9)) {
        i += 2;
        out += ' ';
        continue;
      }
    }
    if (c < 0x20 || c == 0x7F) {
      out += ' ';
      continue;
    }
    if (!out.empty() && ((out.back() == '*' && c == '/') || (out.back() == '/' && c == '*'))) out += ' ';
    out += s[i];
  }
  return out;
}

}  // namespace

std::string lines(const std::vector<std::string>& list, const std::string& indent) {
  std::string out;
  for (const std::string& l : list) {
    out += indent + l;
    out.erase(out.find_last_not_of(' ') + 1);
    out += "\n";
  }
  return out;
}

std::string identifier(const std::string& text, const std::string& otherwise) {
  std::string out;
  for (char c : text) out += std::isalnum(static_cast<unsigned char>(c)) ? c : '_';
  if (out.empty() || out.find_first_not_of('_') == std::string::npos) return otherwise;
  // LocalNames that begin with _ belong to the compilers.
  if (!std::isalpha(static_cast<unsigned char>(out[0]))) out = otherwise + (out[0] == '_' ? "" : "_") + out;
  return out;
}

std::string number(const Rational& r) {
  const mpz_class &num = r.get_num(), &den = r.get_den();
  if (num == 0) return "0.0";
  const mpz_class exact_limit = mpz_class(1) << std::numeric_limits<double>::digits;
  if (den == 1 && abs(num) < 1000000000) return num.get_str() + ".0";
  // Decimal digits d with r = ±0.d * 10^exponent; 25 of them are more than enough for one rounding.
  constexpr std::size_t kDigits = 25;
  const auto ten = [](unsigned long n) {
    mpz_class p;
    mpz_ui_pow_ui(p.get_mpz_t(), 10, n);
    return p;
  };
  const long shift = static_cast<long>(kDigits) + 1 + static_cast<long>(mpz_sizeinbase(den.get_mpz_t(), 10)) -
                     static_cast<long>(mpz_sizeinbase(num.get_mpz_t(), 10));
  mpz_class top = abs(num), below = den;
  if (shift > 0) top *= ten(static_cast<unsigned long>(shift));
  else below *= ten(static_cast<unsigned long>(-shift));
  mpz_class quotient, rest;
  mpz_tdiv_qr(quotient.get_mpz_t(), rest.get_mpz_t(), top.get_mpz_t(), below.get_mpz_t());
  std::string digits = quotient.get_str();
  const long exponent = static_cast<long>(digits.size()) - shift;  // of 0.d
  const bool cut = digits.size() > kDigits && digits.find_first_not_of('0', kDigits) != std::string::npos;
  const bool terminates = rest == 0 && !cut;
  digits.resize(std::min(digits.size(), kDigits));
  while (digits.size() > 1 && digits.back() == '0') digits.pop_back();
  const std::string sign = num < 0 ? "-" : "";
  if (exponent > std::numeric_limits<double>::max_exponent10 || exponent <= std::numeric_limits<double>::min_exponent10)
    throw Failure(Span{}, "a number near " + sign + digits.substr(0, 1) + "e" + std::to_string(exponent - 1) + " occurs: double cannot hold it",
                  "choose units in which numbers lie between 1e-300 and 1e300");
  // A short decimal as one, a quotient of exact numbers as such: either is rounded once.
  if (!(terminates && digits.size() <= 17) && abs(num) < exact_limit && den < exact_limit)
    return num.get_str() + ".0/" + den.get_str() + ".0";
  if (exponent > 9 || exponent < -3) {
    const std::string tail = digits.size() > 1 ? "." + digits.substr(1) : "";
    return sign + digits.substr(0, 1) + tail + "e" + std::to_string(exponent - 1);
  }
  if (exponent <= 0) return sign + "0." + std::string(static_cast<std::size_t>(-exponent), '0') + digits;
  const std::size_t whole = static_cast<std::size_t>(exponent);
  if (digits.size() <= whole) return sign + digits + std::string(whole - digits.size(), '0') + ".0";
  return sign + digits.substr(0, whole) + "." + digits.substr(whole);
}

// ---- the motion ----------------------------------------------------------------------------

std::size_t Motion::place(std::size_t variable, unsigned order) const {
  for (std::size_t i = 0; i < state.size(); ++i)
    if (state[i].variable == variable && state[i].order == order) return i;
  ANHOLON_ASSERT(!"a derivative that is no part of the state");
  return 0;
}

Motion motion(const System& s, const Structure& structure) {
  const Model& model = *s.model;
  Graph& g = *model.graph;
  const std::size_t n = s.size();
  for (NodeId id : symbols(s.equations)) {
    const Node& node = g.node(id);
    if (node.kind == Kind::given)
      throw Failure(Span{}, "the given function '" + model.unknown_functions[node.index] + "' has no formula",
                    "a program needs one: [functions] " + model.unknown_functions[node.index] + " = \"…\"");
    ANHOLON_ASSERT(node.kind != Kind::mass);
  }
  // What is not truly there is set to zero before it can be differentiated further.
  const auto up_to = [&](const Column& es, int below) {
    return substitute(es, [&](NodeId id) {
      const auto j = s.variable(id);
      return j && static_cast<int>(g.node(id).order) > structure.d[*j] - below ? g.zero() : Expr{};
    });
  };
  Motion m;
  int largest_d = 0;
  for (int d : structure.d) largest_d = std::max(largest_d, d);
  for (int k = 0; k < largest_d; ++k)
    for (std::size_t j = 0; j < n; ++j)
      if (k < structure.d[j]) m.state.push_back({j, static_cast<unsigned>(k)});
  for (const StateEntry& e : m.state) m.state_names.push_back(derivative_name(s.variable_names[e.variable], e.order, Format::text));
  for (std::size_t j = 0; j < n; ++j)
    m.leading_names.push_back(derivative_name(s.variable_names[j], static_cast<unsigned>(structure.d[j]), Format::text));

  for (std::size_t i = 0; i < n; ++i) {
    const int c = structure.c[i];
    Column e = up_to({s.equations[i]}, c);
    Column leading;
    for (std::size_t j = 0; j < n; ++j)
      leading.push_back(structure.sigma[i][j] != kAbsent && structure.sigma[i][j] == structure.d[j] - c
                            ? s.symbol(j, static_cast<unsigned>(structure.sigma[i][j])) : g.zero());
    // A symbol that is no leading one stands in `leading` as 0, on which nothing depends.
    Column row = gradient(e[0], leading);
    for (std::size_t j = 0; j < n; ++j)
      if (is_zero(leading[j])) row[j] = g.zero();
    m.jacobian.push_back(row);
    for (int k = 0; k < c; ++k) {
      m.hidden.push_back(e[0]);
      m.hidden_names.push_back(derivative_name(s.equation_names[i], static_cast<unsigned>(k), Format::text));
      e = up_to(total_derivative(e), c - k - 1);
    }
    m.residual.push_back(e[0]);
    m.equation_names.push_back(s.equation_names[i] + times_differentiated(c));
  }
  for (const Column& row : m.jacobian)
    for (NodeId id : symbols(row)) {
      const auto j = s.variable(id);
      if (j && static_cast<int>(g.node(id).order) == structure.d[*j]) m.linear = false;
    }

  for (const Parameter& p : model.parameters) m.parameters.push_back(p.value);
  if (m.parameters.empty()) return m;
  std::vector<bool> free;
  for (std::size_t i = 0; i < m.parameters.size(); ++i) {
    free.push_back(symbols({&m.parameters[i], 1}).empty());
    if (!free.back()) m.derived.push_back(i);
  }
  // Parameters may refer to each other in any order: put values in until only free ones are left.
  for (std::size_t depth = 0; depth < m.parameters.size(); ++depth)
    m.parameters = substitute(m.parameters, [&](NodeId id) {
      const Node& node = g.node(id);
      return node.kind == Kind::parameter && !free[node.index] ? model.parameters[node.index].value : Expr{};
    });
  return m;
}

std::vector<double> start_state(const System& s, const Motion& m, const EmitOptions::Start& start) {
  std::vector<double> out;
  for (const StateEntry& e : m.state)
    out.push_back(e.variable >= s.coordinates || e.order > 1 ? 0 : e.order == 0 ? start.q[e.variable] : start.qd[e.variable]);
  return out;
}

// ---- names ---------------------------------------------------------------------------------

std::string LocalNames::fresh(const std::string& wanted) {
  std::string name = identifier(wanted, "x");
  // Capitals only may be a macro of math.h.
  if (name.size() > 2 && std::none_of(name.begin(), name.end(), [](unsigned char c) { return std::islower(c); })) name += '_';
  while (!taken_.insert(name).second) name += '_';
  return name;
}

LocalNames::LocalNames(const System& s, const Structure& structure) : taken_(std::begin(kReserved), std::end(kReserved)) {
  Graph& g = *s.model->graph;
  symbols_[g.time().id] = "t";
  for (std::size_t j = 0; j < s.size(); ++j) symbols_[s.symbol(j, 0).id] = fresh(s.variable_names[j]);
  for (std::size_t i = 0; i < s.model->parameters.size(); ++i)
    symbols_[g.parameter(static_cast<std::uint32_t>(i)).id] = fresh(s.model->parameters[i].name);
  for (std::size_t j = 0; j < s.size(); ++j)
    for (int k = 1; k <= structure.d[j]; ++k)
      symbols_[s.symbol(j, static_cast<unsigned>(k)).id] = fresh(s.variable_names[j] + "_" + std::to_string(k));
}

// ---- statements ----------------------------------------------------------------------------

namespace {

const char* function_name(Function f, Language language) {
  const bool c = language == Language::c;
  switch (f) {
    case Function::sin: return c ? "sin" : "np.sin";
    case Function::cos: return c ? "cos" : "np.cos";
    case Function::tan: return c ? "tan" : "np.tan";
    case Function::asin: return c ? "asin" : "np.arcsin";
    case Function::acos: return c ? "acos" : "np.arccos";
    case Function::atan: return c ? "atan" : "np.arctan";
    case Function::sinh: return c ? "sinh" : "np.sinh";
    case Function::cosh: return c ? "cosh" : "np.cosh";
    case Function::tanh: return c ? "tanh" : "np.tanh";
    case Function::asinh: return c ? "asinh" : "np.arcsinh";
    case Function::acosh: return c ? "acosh" : "np.arccosh";
    case Function::atanh: return c ? "atanh" : "np.arctanh";
    case Function::exp: return c ? "exp" : "np.exp";
    case Function::log: return c ? "log" : "np.log";
    case Function::abs: return c ? "fabs" : "np.abs";
    case Function::sign: return c ? "$_sign" : "np.sign";
  }
  return "";
}

// How often the text of a power holds its base.
std::size_t bases(const Rational& exponent) {
  const Rational r = abs(exponent);
  if (r.get_den() == 1 && r <= kLargestProduct) return r.get_num().get_ui();
  return r == Rational(3, 2) ? 2 : 1;
}

}  // namespace

Writer::Writer(const System& system, const Structure& structure, const Motion& motion, const LocalNames& names, Language language)
    : g_(*system.model->graph), system_(system), structure_(structure), motion_(motion), names_(names), language_(language) {}

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
  const Text root{std::string(language_ == Language::c ? "sqrt(" : "np.sqrt(") + x.s + ")", kAtom};
  if (exponent == Rational(1, 2)) return root;
  if (exponent == Rational(3, 2)) return {wrapped(x, kAtom) + "*" + root.s, kProduct};
  if (exponent.get_den() == 1 && exponent <= kLargestProduct) {
    std::string out = wrapped(x, kAtom);
    for (long k = exponent.get_num().get_si(); k > 1; --k) out += "*" + wrapped(x, kAtom);
    return {out, kProduct};
  }
  const std::string e = number(exponent);
  if (language_ == Language::c) return {"pow(" + x.s + ", " + e + ")", kAtom};
  return {wrapped(x, kAtom) + "**" + (e.find('/') == std::string::npos ? e : "(" + e + ")"), kPower};
}

std::vector<Writer::Piece> Writer::product(NodeId id) {
  std::vector<Text> bottom;
  std::vector<Piece> out;
  // x*x may stand among other factors as it is, a quotient of numbers not.
  const auto factor = [](const Text& x) { return x.s.find('/') == std::string::npos ? wrapped(x, kProduct) : wrapped(x, kPower); };
  for (const Term& t : g_.terms(id)) {
    const Rational& e = g_.rational(t.weight);
    if (e < 0) bottom.push_back(power(t.node, -e));
    else out.push_back({'*', factor(power(t.node, e))});
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
    if (c == 1) out.push_back({op, wrapped(x, kProduct)});
    else if (x.strength == kProduct && x.s.compare(0, 4, "1.0/") == 0) out.push_back({op, number(c) + x.s.substr(3)});
    else out.push_back({op, number(c) + "*" + wrapped(x, kProduct)});
  }
  return out;
}

std::string Writer::call(NodeId id) {
  const Node& n = g_.node(id);
  if (n.kind == Kind::atan2)
    return std::string(language_ == Language::c ? "atan2(" : "np.arctan2(") + text_.at(g_.terms(id)[0].node).s + ", " +
           text_.at(g_.terms(id)[1].node).s + ")";
  const Function f = static_cast<Function>(n.index);
  used_sign_ = used_sign_ || f == Function::sign;
  return std::string(function_name(f, language_)) + "(" + text_.at(g_.terms(id)[0].node).s + ")";
}

static std::string joined(char op, const std::string& s, bool first) {
  switch (op) {
    case '+': return first ? s : " + " + s;
    case '-': return first ? "-" + s : " - " + s;
    case '*': return first ? s : "*" + s;
    default: return first ? "1.0/" + s : "/" + s;
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
    // What a line break would end in Python, brackets hold together.
    if (!c && broken) {
      if (from > 0) out += begin.substr(0, begin.size() - name.size()) + "(" + name + text + ")\n";
      else out += begin + "(" + text + ")\n";
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
    case Kind::pi: text_[id] = {language_ == Language::c ? "3.14159265358979323846" : "np.pi", kAtom}; return;
    case Kind::time: case Kind::jet: case Kind::parameter: case Kind::multiplier:
      text_[id] = {names_.symbol(id), kAtom};
      return;
    case Kind::mass: case Kind::given: ANHOLON_ASSERT(!"a frozen mass or unknown function in a program"); return;
    case Kind::sum: pieces = sum(id), strength = kSum; break;
    case Kind::product: pieces = product(id), strength = kProduct; break;
    case Kind::function: case Kind::atan2: pieces = {{'*', call(id)}}; break;
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
  std::vector<std::pair<std::size_t, NodeId>> state, lead, parameters;
  for (NodeId id : ids) {
    const Node& n = g_.node(id);
    if (n.kind == Kind::time) body.time = true;
    if (n.kind == Kind::parameter) parameters.push_back({n.index, id});
    const auto j = system_.variable(id);
    if (!j) continue;
    if (static_cast<int>(n.order) < structure_.d[*j]) state.push_back({motion_.place(*j, n.order), id});
    else lead.push_back({*j, id});
  }
  const auto read = [&](std::vector<std::pair<std::size_t, NodeId>>& list, const char* array) {
    std::sort(list.begin(), list.end());
    for (const auto& [index, id] : list)
      body.text += assign(names_.symbol(id), {{'+', std::string(array) + "[" + std::to_string(index) + "]"}}, true);
    return !list.empty();
  };
  body.state = read(state, "state");
  body.lead = read(lead, "lead");
  body.parameters = read(parameters, "p");
}

Statements Writer::body(const Column& es, const std::vector<std::string>& targets, bool sparse) {
  Statements body;
  text_.clear();
  uses_.clear();
  next_ = 0;
  const std::vector<NodeId> ids = reachable(es);
  for (Expr e : es) ++uses_[e.id];
  for (NodeId id : ids)
    for (const Term& t : g_.summands(id))
      uses_[t.node] += g_.node(id).kind == Kind::product ? bases(g_.rational(t.weight)) : 1;
  load(ids, body);
  for (NodeId id : ids) write(id, body);
  for (std::size_t i = 0; i < es.size(); ++i)
    if (!sparse || !is_zero(es[i])) body.text += assign(targets[i], {{'+', text_.at(es[i].id).s}}, false);
  return body;
}

// ---- the head ------------------------------------------------------------------------------

std::vector<std::string> head(const System& s, const Structure& structure, const Motion& m, const EmitOptions& o) {
  const Model& model = *s.model;
  std::vector<std::string> out;
  const auto add = [&](const std::string& line) {
    std::string kept = harmless(line);
    while (!kept.empty() && kept.back() == ' ') kept.pop_back();
    out.push_back(kept);
  };
  const auto count = [](std::size_t n) { return "[" + std::to_string(n) + "]"; };
  // "  0  x": the numbers of an array, each with its meaning.
  const auto list = [&](const std::vector<std::string>& meanings) {
    for (std::size_t i = 0; i < meanings.size(); ++i) {
      const std::string index = std::to_string(i);
      add(std::string(index.size() < 4 ? 4 - index.size() : 0, ' ') + index + "  " + meanings[i]);
    }
  };
  add(model.title);
  add(std::string(s.form->title) + ", " + s.form->equation + " of " + s.form->source);
  if (!o.made_by.empty()) add("Written by: " + o.made_by);
  add("");
  add("Numbers are double, in the units of the model. x' is dx/dt.");
  add("");
  add("t: the time");
  add("state" + count(m.state.size()) + ": what the integrator of ordinary differential equations carries");
  list(m.state_names);
  add("lead" + count(s.size()) + ": the leading derivatives and multipliers, for which the equations are solved");
  list(m.leading_names);
  if (!model.parameters.empty()) add("p" + count(model.parameters.size()) + ": parameters, with their default values");
  std::vector<std::string> values;
  for (std::size_t i = 0; i < model.parameters.size(); ++i) {
    const Parameter& p = model.parameters[i];
    values.push_back(p.name + " = " + print(p.value, model.names, Format::text) + (p.doc.empty() ? "" : "    " + p.doc));
  }
  list(values);
  add("residual" + count(s.size()) + ": the equations, left side minus right side");
  list(m.equation_names);
  add("jacobian" + count(s.size() * s.size()) + ": derivatives of the residuals (rows) by lead (columns), row by row");
  if (!m.hidden.empty()) add("hidden" + count(m.hidden.size()) + ": constraints that the state must satisfy; an integrator lets them drift");
  list(m.hidden_names);
  for (std::size_t r = 0; r < model.constraints.size(); ++r)
    if (std::find(s.constraints.begin(), s.constraints.end(), r) == s.constraints.end())
      add("The constraint " + model.constraints[r].name + " follows from the others: it is left out, its multiplier is 0.");
  add(m.linear ? "The equations are linear in lead."
               : "The equations are not linear in lead: Newton's method needs a start that is not too far off.");
  if (structure.state_dimension < static_cast<int>(m.state.size()))
    add("Of the state " + std::to_string(structure.state_dimension) + " numbers are independent.");
  return out;
}

}  // namespace anholon::emit
