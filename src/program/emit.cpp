#include <algorithm>
#include <cctype>
#include <limits>

#include "base/assert.h"
#include "base/escape.h"
#include "program/emit_text.h"

namespace anholon::emit {

namespace {

// Words of C, of Python, and of the generated texts.
constexpr const char* kReserved[] = {"auto",
                                     "break",
                                     "case",
                                     "char",
                                     "const",
                                     "continue",
                                     "default",
                                     "do",
                                     "double",
                                     "else",
                                     "enum",
                                     "extern",
                                     "float",
                                     "for",
                                     "goto",
                                     "if",
                                     "inline",
                                     "int",
                                     "long",
                                     "register",
                                     "restrict",
                                     "return",
                                     "short",
                                     "signed",
                                     "sizeof",
                                     "static",
                                     "struct",
                                     "switch",
                                     "typedef",
                                     "union",
                                     "unsigned",
                                     "void",
                                     "volatile",
                                     "while",
                                     "asm",
                                     "typeof",
                                     "bool",
                                     "true",
                                     "false",
                                     "nullptr",
                                     "constexpr",
                                     "alignas",
                                     "alignof",
                                     "static_assert",
                                     "thread_local",
                                     "linux",
                                     "unix",
                                     "and",
                                     "as",
                                     "assert",
                                     "async",
                                     "await",
                                     "class",
                                     "def",
                                     "del",
                                     "elif",
                                     "except",
                                     "finally",
                                     "from",
                                     "global",
                                     "import",
                                     "in",
                                     "is",
                                     "lambda",
                                     "nonlocal",
                                     "not",
                                     "or",
                                     "pass",
                                     "raise",
                                     "try",
                                     "with",
                                     "yield",
                                     "match",
                                     "type",
                                     "None",
                                     "True",
                                     "False",
                                     "np",
                                     "numpy",
                                     "main",
                                     "t",
                                     "state",
                                     "lead",
                                     "p",
                                     "out",
                                     "i",
                                     "sin",
                                     "cos",
                                     "tan",
                                     "asin",
                                     "acos",
                                     "atan",
                                     "sinh",
                                     "cosh",
                                     "tanh",
                                     "asinh",
                                     "acosh",
                                     "atanh",
                                     "exp",
                                     "log",
                                     "fabs",
                                     "sqrt",
                                     "pow",
                                     "atan2",
                                     "isfinite"};

std::string times_differentiated(int c) {
  return c == 0 ? "" : c == 1 ? ", differentiated once" : ", differentiated " + std::to_string(c) + " times";
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
  for (char c : text)
    if (c != ']') out += std::isalnum(static_cast<unsigned char>(c)) ? c : '_';  // th[3] is th_3
  if (out.empty() || out.find_first_not_of('_') == std::string::npos) return otherwise;
  // Names that begin with _ are reserved for compilers.
  if (!std::isalpha(static_cast<unsigned char>(out[0]))) out = otherwise + (out[0] == '_' ? "" : "_") + out;
  return out;
}

std::string number(const Rational& r) {
  const mpz_class &num = r.get_num(), &den = r.get_den();
  if (num == 0) return "0.0";
  const mpz_class exact_limit = mpz_class(1) << std::numeric_limits<double>::digits;
  if (den == 1 && abs(num) < 1000000000) return num.get_str() + ".0";
  // Decimal digits d with r = ±0.d * 10^exponent; 25 digits are more than enough for one rounding.
  constexpr std::size_t kDigits = 25;
  const auto ten = [](unsigned long n) {
    mpz_class p;
    mpz_ui_pow_ui(p.get_mpz_t(), 10, n);
    return p;
  };
  const long shift = static_cast<long>(kDigits) + 1 + static_cast<long>(mpz_sizeinbase(den.get_mpz_t(), 10)) -
                     static_cast<long>(mpz_sizeinbase(num.get_mpz_t(), 10));
  mpz_class top = abs(num), below = den;
  if (shift > 0)
    top *= ten(static_cast<unsigned long>(shift));
  else
    below *= ten(static_cast<unsigned long>(-shift));
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
    throw Failure(Span{},
                  "a number near " + sign + digits.substr(0, 1) + "e" + std::to_string(exponent - 1) +
                      " occurs: double cannot hold it",
                  "choose units in which numbers lie between 1e-300 and 1e300");
  // A short decimal is written as such, and so is a quotient of exact numbers: either is rounded once.
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

Motion motion(const System& s, const Structure& structure, const EmitOptions& options) {
  const Model& model = *s.model;
  if (!model.states.empty())
    throw Failure(model.states[0].span,
                  "a program for a model with states ('" + model.states[0].name + "') is not written yet",
                  "anholon simulate computes its motion");
  for (const Event& e : model.events)
    if (!e.set.empty())
      throw Failure(e.span, "a program for a model whose events set something ('" + e.name + "') is not written yet",
                    "anholon simulate computes its motion");
  Graph& g = *model.graph;
  const std::size_t n = s.size();
  for (NodeId id : symbols(s.equations)) {
    const Node& node = g.node(id);
    if (node.kind == Kind::given)
      throw Failure(Span{}, "the given function '" + model.unknown_functions[node.index] + "' has no formula",
                    "a program needs one: [functions] " + model.unknown_functions[node.index] + " = \"…\"");
    ANHOLON_ASSERT(node.kind != Kind::mass);
  }
  // Derivatives that do not truly occur are set to zero before further differentiation.
  const auto up_to = [&](const Column& es, int below) {
    return substitute(es, [&](NodeId id) {
      const auto j = s.variable(id);
      return j && static_cast<int>(g.node(id).order) > structure.d[*j] - below ? g.zero() : Expr{};
    });
  };
  Motion m;
  for (const InputFormula& u : options.inputs) {
    m.inputs.push_back(u.control);
    m.input_values.push_back(u.value);
    m.input_names.push_back(model.controls[u.control].name);
  }
  int largest_d = 0;
  for (int d : structure.d) largest_d = std::max(largest_d, d);
  for (int k = 0; k < largest_d; ++k)
    for (std::size_t j = 0; j < n; ++j)
      if (k < structure.d[j]) m.state.push_back({j, static_cast<unsigned>(k)});
  for (const StateEntry& e : m.state)
    m.state_names.push_back(derivative_name(s.variable_names[e.variable], e.order, Format::text));
  for (std::size_t j = 0; j < n; ++j)
    m.leading_names.push_back(
        derivative_name(s.variable_names[j], static_cast<unsigned>(structure.d[j]), Format::text));

  for (std::size_t i = 0; i < n; ++i) {
    const int c = structure.c[i];
    Column e = up_to({s.equations[i]}, c);
    Column leading;
    for (std::size_t j = 0; j < n; ++j)
      leading.push_back(structure.sigma[i][j] != kAbsent && structure.sigma[i][j] == structure.d[j] - c
                            ? s.symbol(j, static_cast<unsigned>(structure.sigma[i][j]))
                            : g.zero());
    // A symbol that is not a leading derivative is 0 in `leading`, on which nothing depends.
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
  // Parameters may refer to each other in any order: values are substituted until only free parameters are left.
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
    out.push_back(e.variable >= s.coordinates || e.order > 1 ? 0
                  : e.order == 0                             ? start.q[e.variable]
                                                             : start.qd[e.variable]);
  return out;
}

// ---- names ---------------------------------------------------------------------------------

std::string LocalNames::fresh(const std::string& wanted) {
  std::string name = identifier(wanted, "x");
  // A name in capitals may be a macro of math.h.
  if (name.size() > 2 && std::none_of(name.begin(), name.end(), [](unsigned char c) { return std::islower(c); }))
    name += '_';
  while (!taken_.insert(name).second) name += '_';
  return name;
}

LocalNames::LocalNames(const System& s, const Structure& structure, const Motion& motion)
    : taken_(std::begin(kReserved), std::end(kReserved)) {
  Graph& g = *s.model->graph;
  symbols_[g.time().id] = "t";
  if (!motion.inputs.empty()) taken_.insert({"u", "own"});
  for (std::size_t j = 0; j < s.size(); ++j) symbols_[s.symbol(j, 0).id] = fresh(s.variable_names[j]);
  for (std::size_t i = 0; i < s.model->parameters.size(); ++i)
    symbols_[g.parameter(static_cast<std::uint32_t>(i)).id] = fresh(s.model->parameters[i].name);
  for (std::size_t k = 0; k < motion.inputs.size(); ++k)
    symbols_[g.control(static_cast<std::uint32_t>(motion.inputs[k]), 0).id] = fresh(motion.input_names[k]);
  for (std::size_t j = 0; j < s.size(); ++j)
    for (int k = 1; k <= structure.d[j]; ++k)
      symbols_[s.symbol(j, static_cast<unsigned>(k)).id] = fresh(s.variable_names[j] + "_" + std::to_string(k));
}

// ---- the head ------------------------------------------------------------------------------

std::vector<std::string> head(const System& s, const Structure& structure, const Motion& m, const EmitOptions& o) {
  const Model& model = *s.model;
  std::vector<std::string> out;
  const auto add = [&](const std::string& line) {
    std::string kept = comment_line(line);
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
    values.push_back(p.name + " = " + print(p.value, model.names, Format::text) +
                     (p.doc.empty() ? "" : "    " + p.doc));
  }
  list(values);
  if (!m.inputs.empty()) {
    add("u" + count(m.inputs.size()) + ": inputs; where there is none (a null pointer, None) these formulas give them");
    std::vector<std::string> formulas;
    for (std::size_t k = 0; k < m.inputs.size(); ++k)
      formulas.push_back(m.input_names[k] + " = " + print(m.input_values[k], model.names, Format::text));
    list(formulas);
  }
  add("residual" + count(s.size()) + ": the equations, left side minus right side");
  list(m.equation_names);
  add("jacobian" + count(s.size() * s.size()) + ": derivatives of the residuals (rows) by lead (columns), row by row");
  if (!m.hidden.empty())
    add("hidden" + count(m.hidden.size()) + ": constraints that the state must satisfy; an integrator lets them drift");
  list(m.hidden_names);
  for (std::size_t r = 0; r < model.constraints.size(); ++r)
    if (std::find(s.constraints.begin(), s.constraints.end(), r) == s.constraints.end())
      add("The constraint " + model.constraints[r].name +
          " follows from the others: it is left out, its multiplier is 0.");
  add(m.linear ? "The equations are linear in lead."
               : "The equations are not linear in lead: Newton's method needs a start that is not too far off.");
  if (structure.state_dimension < static_cast<int>(m.state.size()))
    add("Of the state " + std::to_string(structure.state_dimension) + " numbers are independent.");
  return out;
}

}  // namespace anholon::emit
