#include "base/escape.h"
#include "emit/statements.h"
#include "emit/text.h"
#include "numeric/number.h"

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
  if (b.reads("lead")) out += "    lead = np.asarray(lead, dtype=float)\n";
  if (b.reads("p")) out += "    p = DEFAULTS if p is None else np.asarray(p, dtype=float)\n";
  if (b.reads("u")) out += "    u = inputs(t, state, p) if u is None else np.asarray(u, dtype=float)\n";
  return out;
}

// The text of a Python module, part by part.
class PythonModule {
 public:
  PythonModule(const System& system, const Structure& structure, const EmitOptions& options)
      : system_(system), structure_(structure), options_(options), m_(motion(system, structure, options)),
        names_(system, structure, m_), writer_(*system.model->graph, names_, Language::python),
        inputs_(!m_.inputs.empty()) {}

  std::string text() {
    return documentation() + tables() + start() + parameters() + inputs() + equations() + newton() + right_side() +
           demonstration();
  }

 private:
  // Inputs are the last argument of a function and are passed on.
  std::string u_argument() const { return inputs_ ? ", u=None" : ""; }
  std::string u() const { return inputs_ ? ", u" : ""; }

  std::string documentation() const {
    std::string out = "\"\"\"";
    std::vector<std::string> about = head(system_, structure_, m_, options_);
    if (!about.empty() && about[0].empty()) about[0] = "A motion";
    for (const std::string& l : about) out += code_string(l) + "\n";
    out += R"(
residual, jacobian and hidden also take many states at once: state[:, k] at time t[k].
With SciPy: solve_ivp(rhs, (T0, T1), START, args=(p,), rtol=1e-10, atol=1e-10)
"""
)";
    return options_.start ? out : put(out, "START", "start");
  }

  // The names of all quantities.
  std::string tables() const {
    std::vector<std::string> parameters;
    for (const Parameter& p : system_.model->parameters) parameters.push_back(p.name);
    return "import numpy as np\n\n" + table("STATE", m_.state_names) + table("LEAD", m_.leading_names) +
           table("PARAMETERS", parameters) + table("HIDDEN", m_.hidden_names) +
           (inputs_ ? table("INPUTS", m_.input_names) : "");
  }

  std::string start() const {
    if (!options_.start) return {};
    std::string out = "T0 = " + number_text(options_.start->t) + "\nSTART = np.array([";
    const std::vector<double> state = start_state(system_, m_, *options_.start);
    for (double x : state) out += "\n    " + number_text(x) + ",";
    return out + (state.empty() ? "], dtype=float)\n" : "\n], dtype=float)\n");
  }

  std::string parameters() {
    const auto [free, derived] = parameter_assignments(m_);
    const bool any = !derived.values.empty();
    std::string out = "\n\ndef defaults():\n    \"\"\"The default values of the parameters.\"\"\"\n    p = "
                      "np.empty(len(PARAMETERS))\n" +
                      writer_.body(free.values, free.targets).text +
                      (any ? "    return derived(p)\n" : "    return p\n");
    if (any)
      out +=
          "\n\ndef derived(p):\n    \"\"\"Computes anew, in p, the parameters that depend on others: call it after a "
          "change of p.\"\"\"\n" +
          writer_.body(derived.values, derived.targets).text + "    return p\n";
    return out + "\n\nDEFAULTS = defaults()\n";
  }

  std::string inputs() {
    if (!inputs_) return {};
    const Statements formulas = writer_.body(m_.input_values, targets(m_.inputs.size()));
    return "\n\ndef inputs(t, state, p=None):\n    \"\"\"The inputs by the formulas of the model.\"\"\"\n" +
           arrays(formulas) + "    out = np.empty((len(INPUTS),) + state.shape[1:])\n" + formulas.text +
           "    return out\n";
  }

  std::string equations() {
    const std::size_t n = system_.size();
    const Statements residual = writer_.body(m_.residual, targets(n));
    std::string out = "\n\ndef residual(t, state, lead, p=None" + u_argument() +
                      "):\n    \"\"\"The equations, left side minus right side.\"\"\"\n" + arrays(residual) +
                      "    out = np.empty((len(LEAD),) + state.shape[1:])\n" + residual.text + "    return out\n";
    const Statements jacobian = writer_.body(entries(m_.jacobian), targets(n * n, n), true);
    out += "\n\ndef jacobian(t, state, lead, p=None" + u_argument() +
           "):\n    \"\"\"The derivatives of the residuals by lead.\"\"\"\n" + arrays(jacobian) +
           "    out = np.zeros((len(LEAD), len(LEAD)) + state.shape[1:])\n" + jacobian.text + "    return out\n";
    const Statements hidden = writer_.body(m_.hidden, targets(m_.hidden.size()));
    return out +
           "\n\ndef hidden(t, state, p=None):\n    \"\"\"What must be zero at a state that satisfies the "
           "constraints.\"\"\"\n" +
           arrays(hidden) + "    out = np.empty((len(HIDDEN),) + state.shape[1:])\n" + hidden.text + "    return out\n";
  }

  std::string newton() const {
    const std::string factor = "a, row, column = _scaled(jacobian(t, state, lead, p" + u() + "))\n";
    std::string text = put(put(kNewton, "@GIVEN", u_argument()), "@INPUTS", u());
    text = put(text, "@ONCE", m_.linear ? "    " + factor : "");
    text = put(text, "@EACH", m_.linear ? "" : "        " + factor);
    return "\n" + put(text, "@SETTLED",
                      m_.linear ? "length > 0.5 * before" : "(length <= 1e-8 * size and length > 0.5 * before)");
  }

  std::string right_side() const {
    std::string out = "\n\ndef rhs(t, state, p=None" + u_argument() +
                      "):\n    \"\"\"d state / dt\"\"\"\n"
                      "    lead = leading(t, state, p" +
                      (inputs_ ? ", u=u" : "") + ")\n    out = np.empty(len(STATE))\n";
    for (std::size_t i = 0; i < m_.state.size(); ++i)
      out += "    out[" + std::to_string(i) + "] = " + rate_of_state(structure_, m_, i) + "\n";
    return out + "    return out\n";
  }

  // What the module does as a program.
  std::string demonstration() const {
    if (!options_.start) return {};
    return R"(

if __name__ == "__main__":
    for _name, _value in zip(LEAD, leading(T0, START)):
        print(f"{_name} = {_value:.16g}")
)";
  }

  const System& system_;
  const Structure& structure_;
  const EmitOptions& options_;
  Motion m_;
  LocalNames names_;
  Writer writer_;
  bool inputs_;
};

}  // namespace

std::string emit_python(const System& system, const Structure& structure, const EmitOptions& options) {
  return PythonModule(system, structure, options).text();
}

}  // namespace anholon
