#include "emit/text.h"

#include <algorithm>
#include <functional>
#include <limits>

#include "base/escape.h"

namespace anholon::emit {

namespace {

// The tolerances are those of program/expansion.cpp.
constexpr const char* kSolver = R"(
/* Factors a (row by row), its rows and columns divided by their largest entries, with partial
   pivoting. Returns 1 if a pivot is no more than round-off, 3 if an entry is not a number. */
static int $_factor(double *a, int *order, double *row, double *column)
{
  const int n = $_UNKNOWNS;
  const double tiny = 50 * 1.1102230246251565e-16;
  int i, j, k;
  for (i = 0; i < n; ++i) {
    order[i] = i;
    row[i] = 0;
    for (j = 0; j < n; ++j) {
      if (!isfinite(a[i * n + j])) return 3;
      if (fabs(a[i * n + j]) > row[i]) row[i] = fabs(a[i * n + j]);
    }
    if (!(row[i] > 0)) return 1;
    for (j = 0; j < n; ++j) a[i * n + j] /= row[i];
  }
  for (j = 0; j < n; ++j) {
    column[j] = 0;
    for (i = 0; i < n; ++i)
      if (fabs(a[i * n + j]) > column[j]) column[j] = fabs(a[i * n + j]);
    if (!(column[j] > 0)) return 1;
    for (i = 0; i < n; ++i) a[i * n + j] /= column[j];
  }
  for (k = 0; k < n; ++k) {
    int best = k;
    const double *top;
    for (i = k + 1; i < n; ++i)
      if (fabs(a[order[i] * n + k]) > fabs(a[order[best] * n + k])) best = i;
    i = order[k], order[k] = order[best], order[best] = i;
    top = a + order[k] * n;
    if (!(fabs(top[k]) > tiny)) return 1;
    for (i = k + 1; i < n; ++i) {
      double *r = a + order[i] * n;
      r[k] /= top[k];
      for (j = k + 1; j < n; ++j) r[j] -= r[k] * top[j];
    }
  }
  return 0;
}

/* x = a^-1 b with the factors of a. */
static void $_solve(const double *a, const int *order, const double *row, const double *column,
  const double *b, double *x)
{
  const int n = $_UNKNOWNS;
  int i, j;
  for (i = 0; i < n; ++i) {
    const double *r = a + order[i] * n;
    x[i] = b[order[i]] / row[order[i]];
    for (j = 0; j < i; ++j) x[i] -= r[j] * x[j];
  }
  for (i = n - 1; i >= 0; --i) {
    const double *r = a + order[i] * n;
    for (j = i + 1; j < n; ++j) x[i] -= r[j] * x[j];
    x[i] /= r[i];
  }
  for (i = 0; i < n; ++i) x[i] /= column[i];
}
)";

}  // namespace

const char* c_solver() { return kSolver; }

std::string replaced(std::string text, const std::string& from, const std::string& to) {
  for (std::size_t at = 0; (at = text.find(from, at)) != std::string::npos; at += to.size())
    text.replace(at, from.size(), to);
  return text;
}

std::string lines(const std::vector<std::string>& list, const std::string& indent) {
  std::string out;
  for (const std::string& l : list) {
    out += indent + l;
    out.erase(out.find_last_not_of(' ') + 1);
    out += "\n";
  }
  return out;
}

std::string number(const Rational& r) {
  const mpz_class num = r.get_num(), den = r.get_den();
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
  const long exponent = static_cast<long>(digits.size()) - shift;  // the exponent of 0.d
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
  // A short decimal is written as such, and so is a quotient of exact numbers, because both are rounded once.
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

std::string python_lookup(const StepFunction& f, const std::string& x) {
  const auto list = [](const std::vector<Rational>& numbers) {
    std::string out;
    for (const Rational& r : numbers) out += (out.empty() ? "" : ", ") + number(r);
    return "[" + out + "]";
  };
  return "np.take(" + list(f.values) + ", np.searchsorted(" + list(f.knots) + ", " + x + ", side='right'))";
}

std::string c_lookup(const StepFunction& f, const std::string& x) {
  // Splits in halves, because compilers recurse over nested expressions.
  const std::function<std::string(std::size_t, std::size_t)> among = [&](std::size_t from, std::size_t to) {
    if (from == to) return number(f.values[from]);
    const std::size_t middle = from + (to - from) / 2;
    return "((" + x + ") < " + number(f.knots[middle]) + " ? " + among(from, middle) + " : " + among(middle + 1, to) +
           ")";
  };
  return among(0, f.knots.size());
}

ParameterAssignments parameter_assignments(const Motion& m) {
  ParameterAssignments all;
  for (std::size_t i = 0; i < m.parameters.size(); ++i) {
    const bool derived = std::find(m.derived.begin(), m.derived.end(), i) != m.derived.end();
    Assignments& to = derived ? all.derived : all.free;
    to.values.push_back(m.parameters[i]);
    to.targets.push_back("p[" + std::to_string(i) + "]");
  }
  return all;
}

Column entries(const std::vector<Column>& jacobian) {
  Column all;
  for (const Column& row : jacobian) all.insert(all.end(), row.begin(), row.end());
  return all;
}

std::string rate_of_state(const Structure& structure, const Motion& m, std::size_t i) {
  const StateEntry& e = m.state[i];
  if (static_cast<int>(e.order) + 1 == structure.d[e.variable]) return "lead[" + std::to_string(e.variable) + "]";
  return "state[" + std::to_string(m.place(e.variable, e.order + 1)) + "]";
}

std::string put(std::string text, const std::string& mark, const std::string& by) {
  return text.replace(text.find(mark), mark.size(), by);
}

std::vector<std::string> head(const System& s, const Structure& structure, const Motion& m, const EmitOptions& o) {
  const Model& model = *s.model;
  std::vector<std::string> out;
  const auto add = [&](const std::string& line) {
    std::string kept = comment_line(line);
    while (!kept.empty() && kept.back() == ' ') kept.pop_back();
    out.push_back(kept);
  };
  const auto count = [](std::size_t n) { return "[" + std::to_string(n) + "]"; };
  // Lists the numbers of an array, each with its meaning: "  0  x".
  const auto list = [&](const std::vector<std::string>& meanings) {
    for (std::size_t i = 0; i < meanings.size(); ++i) {
      const std::string index = std::to_string(i);
      add(std::string(index.size() < 4 ? 4 - index.size() : 0, ' ') + index + "  " + meanings[i]);
    }
  };
  if (!model.title.empty()) add(model.title);
  add(std::string(s.form->title) + ", " + s.form->equation + " of " + s.form->source);
  if (!o.made_by.empty()) add("Written by: " + o.made_by);
  add("");
  add("Numbers are double, in SI units; an output that has a unit in the file is in that unit. x' is dx/dt.");
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
  if (!m.outputs.empty()) {
    add("outputs" + count(m.outputs.size()) + ": monitors and outputs of the model");
    list(m.output_names);
  }
  std::vector<std::string> events;
  bool moves = false;
  for (const Motion::Event& e : m.events) {
    const Event& of = model.events[e.index];
    std::string meaning = of.name + (of.direction > 0 ? ", upward" : of.direction < 0 ? ", downward" : "");
    for (std::size_t i = 0; i < of.set.size(); ++i)
      meaning += (i ? ", " : ": sets ") + print(of.set[i].symbol, model.names, Format::text);
    events.push_back(meaning + (of.stop ? ": the motion ends" : ""));
    moves = moves || e.moves;
  }
  if (!events.empty()) add("events" + count(events.size()) + ": formulas that pass zero where an event happens");
  list(events);
  if (moves && !m.hidden.empty())
    add("After an event that sets coordinates or velocities `hidden` tells how far they are off the constraints: the "
        "reset does not project them, as a motion of anholon does.");
  for (const std::string& parameter : o.of_order)
    add("The value of " + parameter + " decides the order of the equations: another one needs a program of its own.");
  for (const std::string& parameter : o.switching)
    add("The value of " + parameter + " decides which constraints hold: another one needs a program of its own.");
  for (const std::string& what : m.left_out) add("Left out is " + what + ", which holds derivatives beyond lead.");
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
