#include <algorithm>

#include "base/escape.h"
#include "numeric/number.h"
#include "program/emit_text.h"

namespace anholon {

namespace {

using namespace emit;

// `$` marks the name that the user gave. The tolerances are those of program/expansion.cpp.
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

// The Jacobian is computed once (@ONCE) or in each round (@EACH); @SETTLED: the step no longer shrinks, and the bound
// on its size.
constexpr const char* kNewton = R"(
int $_leading(double t, const double *state, const double *p, double *lead)
{
  double a[$_UNKNOWNS * $_UNKNOWNS], row[$_UNKNOWNS], column[$_UNKNOWNS];
  double f[$_UNKNOWNS], step[$_UNKNOWNS], before = HUGE_VAL;
  int order[$_UNKNOWNS], round, j, status;
@ONCE  for (round = 0; round < 30; ++round) {
    double length = 0, size = 0;
@EACH    $_residual(t, state, lead, p, f);
    $_solve(a, order, row, column, f, step);
    for (j = 0; j < $_UNKNOWNS; ++j) {
      lead[j] -= step[j];
      length += fabs(step[j]) * column[j];
      size += fabs(lead[j]) * column[j];
    }
    if (!isfinite(length) || !isfinite(size)) return 3;
    /* Round-off is reached. */
    if (length <= 4e-15 * size || @SETTLED) return 0;
    before = length;
  }
  return 2;
}
)";

std::string replaced(std::string text, const std::string& from, const std::string& to) {
  for (std::size_t at = 0; (at = text.find(from, at)) != std::string::npos; at += to.size())
    text.replace(at, from.size(), to);
  return text;
}

std::string put(std::string text, const std::string& mark, const std::string& by) {
  return text.replace(text.find(mark), mark.size(), by);
}

std::vector<std::string> targets(const std::string& array, std::size_t count) {
  std::vector<std::string> out;
  for (std::size_t i = 0; i < count; ++i) out.push_back(array + "[" + std::to_string(i) + "]");
  return out;
}

std::string unused(std::initializer_list<std::pair<const char*, bool>> arguments) {
  std::string out;
  for (const auto& [name, used] : arguments)
    if (!used) out += std::string("  (void)") + name + ";\n";
  return out;
}

std::string names_table(const std::string& name, const std::vector<std::string>& list) {
  std::string out = "const char *const " + name + "[] = {\n";
  for (const std::string& s : list) out += "  \"" + code_string(s) + "\",\n";
  return out + "  0};\n";
}

}  // namespace

std::string emit_c(const System& system, const Structure& structure, const EmitOptions& options) {
  const Motion m = motion(system, structure, options);
  const LocalNames names(system, structure, m);
  Writer writer(system, structure, m, names, Language::c);
  const std::size_t n = system.size(), parameters = system.model->parameters.size();

  // Inputs follow the parameters.
  const bool inputs = !m.inputs.empty();
  const auto with_inputs = [&](std::string text) {
    if (!inputs) return text;
    text = replaced(std::move(text), "const double *p, double *", "const double *p, const double *u, double *");
    return replaced(replaced(replaced(std::move(text), "p, f)", "p, u, f)"), "p, a)", "p, u, a)"), "p, lead)",
                    "p, u, lead)");
  };
  // Precedes statements that read u.
  const auto own_inputs = [&](const Statements& s) {
    return !inputs    ? std::string()
           : s.inputs ? "  double own[$_INPUTS];\n  if (!u) $_inputs(t, state, p, own), u = own;\n"
                      : "  (void)u;\n";
  };
  const auto not_read = [](const Statements& s) {
    const bool all = s.inputs;  // passed on to the formulas of the inputs
    return unused({{"t", all || s.time}, {"state", all || s.state}, {"lead", s.lead}, {"p", all || s.parameters}});
  };
  const std::string arguments =
      with_inputs("(double t, const double *state, const double *lead, const double *p, double *out)");
  const Statements residual = writer.body(m.residual, targets("out", n));
  Column entries;
  for (const Column& row : m.jacobian) entries.insert(entries.end(), row.begin(), row.end());
  const Statements jacobian = writer.body(entries, targets("out", n * n), true);
  const Statements hidden = writer.body(m.hidden, targets("out", m.hidden.size()));
  const Statements formulas = writer.body(m.input_values, targets("out", m.inputs.size()));
  Column free, derived;
  std::vector<std::string> free_targets, derived_targets;
  for (std::size_t i = 0; i < parameters; ++i) {
    const bool is_free = std::find(m.derived.begin(), m.derived.end(), i) == m.derived.end();
    (is_free ? free : derived).push_back(m.parameters[i]);
    (is_free ? free_targets : derived_targets).push_back("p[" + std::to_string(i) + "]");
  }
  const Statements defaults = writer.body(free, free_targets);
  const Statements follow = writer.body(derived, derived_targets);

  std::string out = R"( *
 * $_defaults      sets p to the default values
)";
  if (!derived.empty())
    out += " * $_derived       computes anew the parameters that depend on others: call it after a change of p\n";
  if (inputs) out += " * $_inputs        the inputs by the formulas of the model\n";
  out += R"( * $_residual      the equations, out of any state and lead
 * $_jacobian      their derivatives by lead
 * $_hidden        the hidden constraints
 * $_leading       solves for lead; on entry lead is where to start (zeros will do if linear)
 * $_rhs           d state / dt, for an integrator
)";
  if (options.start) out += " * $_start         a time and a state to begin with\n";
  out += R"( * $_leading and $_rhs return 0; 1 if the jacobian is singular, 2 if Newton's method
 * does not converge, 3 if a formula has no value.
 */
#include <math.h>

)";
  out += "enum { $_UNKNOWNS = " + std::to_string(n) + ", $_STATE = " + std::to_string(m.state.size()) +
         ", $_HIDDEN = " + std::to_string(m.hidden.size()) + ", $_PARAMETERS = " + std::to_string(parameters) +
         (inputs ? ", $_INPUTS = " + std::to_string(m.inputs.size()) : std::string()) + " };\n\n";
  out += "extern const char *const $_parameter_names[], *const $_state_names[], *const $_lead_names[];\n";
  if (inputs) out += "extern const char *const $_input_names[];\n";
  out += "void $_defaults(double *p);\n";
  if (!derived.empty()) out += "void $_derived(double *p);\n";
  if (inputs) out += "void $_inputs(double t, const double *state, const double *p, double *out);\n";
  out += "void $_residual" + arguments + ";\nvoid $_jacobian" + arguments + ";\n";
  out += "void $_hidden(double t, const double *state, const double *p, double *out);\n";
  out += with_inputs("int $_leading(double t, const double *state, const double *p, double *lead);\n"
                     "int $_rhs(double t, const double *state, const double *p, double *dstate);\n");
  if (options.start) out += "void $_start(double *t, double *state);\n";
  out += "\n/* Each ends with a null pointer. */\n";
  std::vector<std::string> parameter_names;
  for (const Parameter& p : system.model->parameters) parameter_names.push_back(p.name);
  out += names_table("$_parameter_names", parameter_names) + names_table("$_state_names", m.state_names) +
         names_table("$_lead_names", m.leading_names) +
         (inputs ? names_table("$_input_names", m.input_names) : std::string());
  if (writer.used_sign()) out += "\nstatic double $_sign(double x) { return x > 0 ? 1 : x < 0 ? -1 : 0; }\n";

  out += "\nvoid $_defaults(double *p)\n{\n" + unused({{"p", parameters > 0}}) + defaults.text;
  if (!derived.empty()) out += "  $_derived(p);\n}\n\nvoid $_derived(double *p)\n{\n" + follow.text;
  out += "}\n";
  if (inputs)
    out += "\nvoid $_inputs(double t, const double *state, const double *p, double *out)\n{\n" +
           unused({{"t", formulas.time}, {"state", formulas.state}, {"p", formulas.parameters}}) + formulas.text +
           "}\n";
  out += "\nvoid $_residual" + arguments + "\n{\n" + own_inputs(residual) + not_read(residual) + residual.text + "}\n";
  out += "\nvoid $_jacobian" + arguments + "\n{\n  int i;\n" + own_inputs(jacobian) + not_read(jacobian) +
         "  for (i = 0; i < $_UNKNOWNS * $_UNKNOWNS; ++i) out[i] = 0;\n" + jacobian.text + "}\n";
  out += "\nvoid $_hidden(double t, const double *state, const double *p, double *out)\n{\n" +
         unused({{"t", hidden.time}, {"state", hidden.state}, {"p", hidden.parameters}, {"out", !m.hidden.empty()}}) +
         hidden.text + "}\n";

  out += kSolver;
  const std::vector<std::string> factor = {"$_jacobian(t, state, lead, p, a);",
                                           "status = $_factor(a, order, row, column);", "if (status) return status;"};
  std::string newton = put(kNewton, "@ONCE", m.linear ? lines(factor, "  ") : "");
  newton = put(newton, "@EACH", m.linear ? "" : lines(factor, "    "));
  newton = with_inputs(newton);
  out +=
      put(newton, "@SETTLED", m.linear ? "length > 0.5 * before" : "(length <= 1e-8 * size && length > 0.5 * before)");

  out += with_inputs("\nint $_rhs(double t, const double *state, const double *p, double *dstate)\n{\n") +
         unused({{"dstate", !m.state.empty()}}) +
         with_inputs("  double lead[$_UNKNOWNS] = {0};\n  const int status = $_leading(t, state, p, lead);\n");
  for (std::size_t i = 0; i < m.state.size(); ++i) {
    const StateEntry& e = m.state[i];
    const bool last = static_cast<int>(e.order) + 1 == structure.d[e.variable];
    out += "  dstate[" + std::to_string(i) + "] = " +
           (last ? "lead[" + std::to_string(e.variable) : "state[" + std::to_string(m.place(e.variable, e.order + 1))) +
           "];\n";
  }
  out += "  return status;\n}\n";
  if (options.start) {
    out += "\nvoid $_start(double *t, double *state)\n{\n  *t = " + number_text(options.start->t) + ";\n";
    const std::vector<double> state = start_state(system, m, *options.start);
    for (std::size_t i = 0; i < state.size(); ++i)
      out += "  state[" + std::to_string(i) + "] = " + number_text(state[i]) + ";\n";
    out += "}\n";
  }
  // A title may contain a $.
  return "/*\n" + lines(head(system, structure, m, options), " * ") +
         replaced(out, "$", identifier(options.name, "motion"));
}

}  // namespace anholon
