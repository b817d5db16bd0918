#include <algorithm>

#include "base/escape.h"
#include "numeric/number.h"
#include "program/emit_text.h"

namespace anholon {

namespace {

using namespace emit;

// The placeholders are those of emit_c.cpp.
constexpr const char* kNewton = R"(
def _scaled(a):
    """a with rows and columns divided by their largest entries, and these"""
    if not np.isfinite(a).all():
        return a, np.ones(len(a)), np.ones(len(a))
    row = np.abs(a).max(axis=1, initial=0.0)
    row[row == 0.0] = 1.0
    a = a / row[:, None]
    column = np.abs(a).max(axis=0, initial=0.0)
    column[column == 0.0] = 1.0
    a = a / column
    if np.linalg.svd(a, compute_uv=False)[-1] < 50 * 1.1102230246251565e-16:
        raise np.linalg.LinAlgError("singular configuration: the equations do not determine all of lead")
    return a, row, column


def leading(t, state, p=None, start=None@GIVEN):
    """The leading derivatives and multipliers at one state; start is where Newton's method begins.

    Numbers that are nan where a formula has no value. Raises LinAlgError if the jacobian is singular,
    ArithmeticError if Newton's method does not converge.
    """
    lead = np.zeros(len(LEAD)) if start is None else np.array(start, dtype=float)
    before = np.inf
@ONCE    for _ in range(30):
@EACH        f = residual(t, state, lead, p@INPUTS)
        if not (np.isfinite(a).all() and np.isfinite(f).all()):
            return np.full(len(LEAD), np.nan)
        step = np.linalg.solve(a, f / row) / column
        lead = lead - step
        length = (np.abs(step) * column).sum()
        size = (np.abs(lead) * column).sum()
        # Round-off is reached.
        if length <= 4e-15 * size or @SETTLED:
            return lead
        before = length
    raise ArithmeticError("Newton's method for the leading derivatives does not converge")
)";

std::string put(std::string text, const std::string& mark, const std::string& by) {
  return text.replace(text.find(mark), mark.size(), by);
}

std::string table(const std::string& name, const std::vector<std::string>& list) {
  std::string out = name + " = (\n";
  for (const std::string& s : list) out += "    \"" + code_string(s) + "\",\n";
  return list.empty() ? name + " = ()\n" : out + ")\n";
}

std::vector<std::string> targets(std::size_t count, std::size_t columns = 0) {
  std::vector<std::string> out;
  for (std::size_t i = 0; i < count; ++i)
    out.push_back(columns == 0 ? "out[" + std::to_string(i) + "]"
                               : "out[" + std::to_string(i / columns) + ", " + std::to_string(i % columns) + "]");
  return out;
}

// The arguments of a function as arrays.
std::string arrays(const Statements& b) {
  std::string out;
  if (b.time) out += "    t = np.asarray(t, dtype=float)[()]\n";
  out += "    state = np.asarray(state, dtype=float)\n";
  if (b.lead) out += "    lead = np.asarray(lead, dtype=float)\n";
  if (b.parameters) out += "    p = DEFAULTS if p is None else np.asarray(p, dtype=float)\n";
  if (b.inputs) out += "    u = inputs(t, state, p) if u is None else np.asarray(u, dtype=float)\n";
  return out;
}

}  // namespace

std::string emit_python(const System& system, const Structure& structure, const EmitOptions& options) {
  const Motion m = motion(system, structure, options);
  const LocalNames names(system, structure, m);
  Writer writer(system, structure, m, names, Language::python);
  const std::size_t n = system.size(), parameters = system.model->parameters.size();

  Column free, derived;
  std::vector<std::string> free_targets, derived_targets, parameter_names;
  for (std::size_t i = 0; i < parameters; ++i) {
    const bool is_free = std::find(m.derived.begin(), m.derived.end(), i) == m.derived.end();
    (is_free ? free : derived).push_back(m.parameters[i]);
    (is_free ? free_targets : derived_targets).push_back("p[" + std::to_string(i) + "]");
    parameter_names.push_back(system.model->parameters[i].name);
  }

  // Inputs are the last argument and are passed on.
  const bool inputs = !m.inputs.empty();
  const std::string u_argument = inputs ? ", u=None" : "", u = inputs ? ", u" : "";

  std::string out = "\"\"\"";
  std::vector<std::string> about = head(system, structure, m, options);
  if (!about.empty() && about[0].empty()) about[0] = "A motion";
  for (const std::string& l : about) out += code_string(l) + "\n";
  out += R"(
residual, jacobian and hidden also take many states at once: state[:, k] at time t[k].
With SciPy: solve_ivp(rhs, (T0, T1), START, args=(p,), rtol=1e-10, atol=1e-10)
"""
)";
  if (!options.start) out = put(out, "START", "start");
  out += "import numpy as np\n\n" + table("STATE", m.state_names) + table("LEAD", m.leading_names) +
         table("PARAMETERS", parameter_names) + table("HIDDEN", m.hidden_names) +
         (inputs ? table("INPUTS", m.input_names) : "");
  if (options.start) {
    out += "T0 = " + number_text(options.start->t) + "\nSTART = np.array([";
    const std::vector<double> state = start_state(system, m, *options.start);
    for (double x : state) out += "\n    " + number_text(x) + ",";
    out += state.empty() ? "], dtype=float)\n" : "\n], dtype=float)\n";
  }

  out += "\n\ndef defaults():\n    \"\"\"The default values of the parameters.\"\"\"\n    p = "
         "np.empty(len(PARAMETERS))\n" +
         writer.body(free, free_targets).text + (derived.empty() ? "    return p\n" : "    return derived(p)\n");
  if (!derived.empty())
    out += "\n\ndef derived(p):\n    \"\"\"Computes anew, in p, the parameters that depend on others: call it after a "
           "change of p.\"\"\"\n" +
           writer.body(derived, derived_targets).text + "    return p\n";
  out += "\n\nDEFAULTS = defaults()\n";

  if (inputs) {
    const Statements formulas = writer.body(m.input_values, targets(m.inputs.size()));
    out += "\n\ndef inputs(t, state, p=None):\n    \"\"\"The inputs by the formulas of the model.\"\"\"\n" +
           arrays(formulas) + "    out = np.empty((len(INPUTS),) + state.shape[1:])\n" + formulas.text +
           "    return out\n";
  }
  const Statements residual = writer.body(m.residual, targets(n));
  out += "\n\ndef residual(t, state, lead, p=None" + u_argument +
         "):\n    \"\"\"The equations, left side minus right side.\"\"\"\n" + arrays(residual) +
         "    out = np.empty((len(LEAD),) + state.shape[1:])\n" + residual.text + "    return out\n";
  Column entries;
  for (const Column& row : m.jacobian) entries.insert(entries.end(), row.begin(), row.end());
  const Statements jacobian = writer.body(entries, targets(n * n, n), true);
  out += "\n\ndef jacobian(t, state, lead, p=None" + u_argument +
         "):\n    \"\"\"The derivatives of the residuals by lead.\"\"\"\n" + arrays(jacobian) +
         "    out = np.zeros((len(LEAD), len(LEAD)) + state.shape[1:])\n" + jacobian.text + "    return out\n";
  const Statements hidden = writer.body(m.hidden, targets(m.hidden.size()));
  out += "\n\ndef hidden(t, state, p=None):\n    \"\"\"What must be zero at a state that satisfies the "
         "constraints.\"\"\"\n" +
         arrays(hidden) + "    out = np.empty((len(HIDDEN),) + state.shape[1:])\n" + hidden.text + "    return out\n";

  const std::string factor = "a, row, column = _scaled(jacobian(t, state, lead, p" + u + "))\n";
  std::string newton =
      put(put(put(kNewton, "@GIVEN", u_argument), "@INPUTS", u), "@ONCE", m.linear ? "    " + factor : "");
  newton = put(newton, "@EACH", m.linear ? "" : "        " + factor);
  out += "\n" + put(newton, "@SETTLED",
                    m.linear ? "length > 0.5 * before" : "(length <= 1e-8 * size and length > 0.5 * before)");

  out += "\n\ndef rhs(t, state, p=None" + u_argument +
         "):\n    \"\"\"d state / dt\"\"\"\n"
         "    lead = leading(t, state, p" +
         (inputs ? ", u=u" : "") + ")\n    out = np.empty(len(STATE))\n";
  for (std::size_t i = 0; i < m.state.size(); ++i) {
    const StateEntry& e = m.state[i];
    const bool last = static_cast<int>(e.order) + 1 == structure.d[e.variable];
    out += "    out[" + std::to_string(i) + "] = " +
           (last ? "lead[" + std::to_string(e.variable) : "state[" + std::to_string(m.place(e.variable, e.order + 1))) +
           "]\n";
  }
  out += "    return out\n";
  if (options.start)
    out += R"(

if __name__ == "__main__":
    for _name, _value in zip(LEAD, leading(T0, START)):
        print(f"{_name} = {_value:.16g}")
)";
  return out;
}

}  // namespace anholon
