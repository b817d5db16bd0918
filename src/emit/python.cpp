#include "base/escape.h"
#include "emit/elimination.h"
#include "emit/python_rates.h"
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


def _newton(t, state, p, lead@GIVEN):
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

// The functions of NumPy for single numbers, which are several times faster than NumPy's own. @FUNCTIONS: those that the
// module math has under the names of C.
constexpr const char* kScalars = R"(class _One:
    """What NumPy has, for single numbers."""
    pi, abs, sqrt, power, arctan2 = math.pi, abs, math.sqrt, math.pow, math.atan2
@FUNCTIONS
    @staticmethod
    def sign(x):
        return (x > 0.0) - (x < 0.0)

    @staticmethod
    def where(condition, a, b):
        return a if condition else b

    @staticmethod
    def searchsorted(knots, x, side):
        return bisect.bisect_right(knots, x)

    @staticmethod
    def take(values, i):
        return values[i]

)";

std::string scalars() {
  constexpr std::size_t kPrefix = std::string_view("np.").size();
  std::string functions;
  for (const FunctionInfo& f : elementary_functions()) {
    const std::string numpy = std::string(f.numpy).substr(kPrefix);
    if (numpy == "abs" || numpy == "sign") continue;  // not in the module math
    functions += "    " + numpy + " = math." + f.c + "\n";
  }
  return replaced(kScalars, "@FUNCTIONS", functions);
}

// @GIVEN, @INPUTS: the inputs as an argument and as a name; @FAST, @NEAR: the elimination; @BLOCK: many states.
constexpr const char* kLeading = R"(
def leading(t, state, p=None, start=None@GIVEN):
    """The leading derivatives and multipliers at one state, or at many: state[:, k] at time t[k] or t.

    start is where Newton's method begins. Numbers are nan where a formula has no value. At one state it raises
    LinAlgError if the jacobian is singular, ArithmeticError if Newton's method does not converge; among many states
    there is nan.
    """
    state = np.asarray(state, dtype=float)
    if state.ndim > 1:
        return _of_many(t, state, p, start@PASSED)
@FAST    return _newton(t, state, p, BEGIN if start is None else np.array(start, dtype=float)@PASSED)


def _at(a, k):
    """The numbers of state k: a has them for all states, or one for each."""
    return None if a is None else a if np.ndim(a) < 2 else np.asarray(a).reshape(len(a), -1)[:, k]


def _of_many(t, state, p, start@GIVEN):
    flat = state.reshape(len(state), -1)
    lead = np.empty((len(LEAD), flat.shape[1]))
    times = np.broadcast_to(np.asarray(t, dtype=float), state.shape[1:]).reshape(-1)
@BLOCKS    for k in left:
        try:
            lead[:, k] = _newton(times[k], flat[:, k], _at(p, k), BEGIN if start is None else np.array(_at(start, k), dtype=float)@ONES)
        except ArithmeticError:
            lead[:, k] = np.nan
        except np.linalg.LinAlgError:
            lead[:, k] = np.nan
    return lead.reshape((len(LEAD),) + state.shape[1:])
)";

// Computes one state, in the numbers of Python.
constexpr const char* kFast = R"(    try:
        lead, suits = _eliminated(_One, float(t), state.tolist(), _DEFAULTS if p is None else np.asarray(p, dtype=float).tolist()@FAST_U)
        if suits:
            return np.array(lead, dtype=float)
    except (ArithmeticError, ValueError, TypeError):
        pass  # a formula has no value, or a pivot is zero
)";

// Computes many states, in blocks that stay in the processor's cache.
constexpr const char* kBlocks = R"(    left = []
    with np.errstate(all="ignore"):
        for first in range(0, flat.shape[1], 2048):
            block = slice(first, first + 2048)
            some, suits = _eliminated(np, times[block], flat[:, block], _block(p, block)@BLOCK_U)
            for j, x in enumerate(some):
                lead[j, block] = x
            left += (first + np.flatnonzero(~np.broadcast_to(suits, lead[0, block].shape))).tolist()
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

// Returns the arguments of a function as arrays.
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
    if (options_.start) elimination_ = elimination_at_start(system_, m_, *options_.start);
    return documentation() + tables() + start() + parameters() + inputs() + equations() + newton() + one() +
           elimination() + leading() + right_side() + rates() + results() + demonstration();
  }

 private:
  // Inputs are the last argument of a function, and are passed on.
  std::string u_argument() const { return inputs_ ? ", u=None" : ""; }
  std::string u() const { return inputs_ ? ", u" : ""; }

  std::string documentation() const {
    std::string out = "\"\"\"";
    std::vector<std::string> about = head(system_, structure_, m_, options_);
    if (!about.empty() && about[0].empty()) about[0] = "A motion";
    for (const std::string& l : about) out += code_string(l) + "\n";
    out += R"(
All functions also take many states at once: state[:, k] at time t[k].
With SciPy: solve_ivp(rhs, (T0, T1), START, args=(p,), rtol=1e-10, atol=1e-10)
"""
)";
    if (options_.rates)
      out =
          put(out, "With SciPy:",
              "rates(t, x, p) is the same motion in the numbers X: in independent velocities, without multipliers and\n"
              "constraints that drift, and several times faster. It begins at X_START.\nWith SciPy:");
    return options_.start ? out : put(out, "START", "start");
  }

  // Returns tables with the names of all quantities.
  std::string tables() const {
    std::vector<std::string> parameters;
    for (const Parameter& p : system_.model->parameters) parameters.push_back(p.name);
    return std::string(fast() ? "import bisect\nimport math\n\n" : "") + "import numpy as np\n\n" +
           table("STATE", m_.state_names) + table("LEAD", m_.leading_names) + table("PARAMETERS", parameters) +
           table("HIDDEN", m_.hidden_names) + (inputs_ ? table("INPUTS", m_.input_names) : "") + event_tables();
  }

  std::string event_tables() const {
    std::string out = m_.outputs.empty() ? "" : table("OUTPUTS", m_.output_names);
    if (m_.events.empty()) return out;
    std::vector<std::string> names;
    std::string directions, stops;
    for (const Motion::Event& e : m_.events) {
      const Event& of = system_.model->events[e.index];
      names.push_back(of.name);
      directions += std::to_string(of.direction) + ", ";
      stops += of.stop ? "True, " : "False, ";
    }
    return out + table("EVENTS", names) + "EVENT_DIRECTIONS = (" + directions + ")\nEVENT_STOPS = (" + stops + ")\n";
  }

  std::string start() const {
    if (!options_.start) return {};
    std::string out = "T0 = " + number_text(options_.start->t) + "\nSTART = np.array([";
    const std::vector<double> state = start_state(m_, *options_.start);
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
    text = put(text, "@SETTLED",
               m_.linear ? "length > 0.5 * before" : "(length <= 1e-8 * size and length > 0.5 * before)");
    std::string begin = "\n\nBEGIN = np.zeros(len(LEAD))\n";
    if (!m_.linear && options_.start && !options_.start->leading.empty()) {
      begin = "\n\nBEGIN = np.array([";
      for (double x : options_.start->leading) begin += number_text(x) + ", ";
      begin += "])\n";
    }
    return begin + "\n" + text;
  }

  // Functions of single numbers are faster by the module math.
  bool fast() const { return elimination_ || options_.rates; }
  std::string one() const { return fast() ? "\n\n_DEFAULTS = DEFAULTS.tolist()\n\n\n" + scalars() : ""; }

  std::string rates() const { return options_.rates ? python_rates(*options_.rates) : ""; }

  // Returns the matrix and the right side by names, then the elimination: a function that takes the library for numbers
  // as an argument.
  std::string elimination() {
    if (!elimination_) return {};
    Graph& g = *system_.model->graph;
    const Column right = substitute(m_.residual, [&](NodeId id) {
      const auto j = system_.variable(id);
      return j && static_cast<int>(g.node(id).order) == structure_.d[*j] ? g.zero() : Expr{};
    });
    EliminationNames names;
    names.prefix = "_";
    Column es;
    std::vector<std::string> own;
    const auto name = [&](Expr e, const char* kind, std::size_t i) {
      if (is_zero(e)) return std::string();
      es.push_back(e);
      return own.emplace_back(names.prefix + kind + std::to_string(i));
    };
    const Column matrix = entries(m_.jacobian);
    for (std::size_t i = 0; i < matrix.size(); ++i) names.matrix.push_back(name(matrix[i], "a", i));
    for (std::size_t i = 0; i < right.size(); ++i) names.right.push_back(name(-right[i], "b", i));
    const Statements body = writer_.body(es, own);
    if (elimination_->refined) {
      for (std::size_t i = 0; i < right.size(); ++i) names.left.push_back(names.prefix + "r" + std::to_string(i));
      names.residual = writer_.body(m_.residual, names.left).text;
    }
    std::string out;
    if (inputs_) {
      const Statements formulas = writer_.body(m_.input_values, targets(m_.inputs.size()));
      out +=
          "\ndef _own_inputs(np, t, state, p):\n    out = [0.0] * len(INPUTS)\n" + formulas.text + "    return out\n\n";
    }
    return out + "\ndef _eliminated(np, t, state, p" + u() +
           "):\n    \"\"\"lead by elimination with pivots that suit the start, and whether they suit this "
           "state.\"\"\"\n" +
           (inputs_ && body.reads("u") ? "    if u is None:\n        u = _own_inputs(np, t, state, p)\n" : "") +
           body.text + python_elimination(*elimination_, names);
  }

  std::string leading() const {
    std::string text = replaced(replaced(put(kLeading, "@FAST", elimination_ ? kFast : ""), "@GIVEN", u_argument()),
                                "@PASSED", inputs_ ? ", u=u" : "");
    text = replaced(text, "@FAST_U", inputs_ ? ", None if u is None else np.asarray(u, dtype=float).tolist()" : "");
    text = put(text, "@BLOCKS", elimination_ ? kBlocks : "    left = range(flat.shape[1])\n");
    text = replaced(text, "@BLOCK_U", inputs_ ? ", _block(u, block, None)" : "");
    if (elimination_)
      text = "\ndef _block(a, block, otherwise=" + std::string("_DEFAULTS") +
             "):\n    return otherwise if a is None else a if np.ndim(a) < 2 else np.asarray(a, "
             "dtype=float).reshape(len(a), -1)[:, block]\n" +
             "\n" + text;
    return "\n" + replaced(text, "@ONES", inputs_ ? ", u=_at(u, k)" : "");
  }

  std::string right_side() const {
    std::string out = "\n\ndef rhs(t, state, p=None" + u_argument() +
                      "):\n    \"\"\"d state / dt\"\"\"\n    state = np.asarray(state, dtype=float)\n"
                      "    lead = leading(t, state, p" +
                      (inputs_ ? ", u=u" : "") + ")\n    out = np.empty_like(state)\n";
    for (std::size_t i = 0; i < m_.state.size(); ++i)
      out += "    out[" + std::to_string(i) + "] = " + rate_of_state(structure_, m_, i) + "\n";
    return out + "    return out\n";
  }

  // Returns the functions of outputs, events and their assignments.
  std::string results() {
    std::string out;
    const auto function = [&](const std::string& name, const std::string& told, const char* count, const Column& es) {
      if (es.empty()) return;
      const Statements b = writer_.body(es, targets(es.size()));
      out += "\n\ndef " + name + "(t, state, lead, p=None" + u_argument() + "):\n    \"\"\"" + told + "\"\"\"\n" +
             arrays(b) + "    out = np.empty((len(" + count + "),) + state.shape[1:])\n" + b.text + "    return out\n";
    };
    function("outputs", "Monitors and outputs of the model; lead is that of leading().", "OUTPUTS", m_.outputs);
    if (m_.events.empty()) return out;
    Column when;
    for (const Motion::Event& e : m_.events) when.push_back(e.when);
    function("events", "Formulas that pass zero where an event happens, in the directions EVENT_DIRECTIONS.", "EVENTS",
             when);
    out += "\n\ndef reset(k, t, state, lead, p=None" + u_argument() +
           "):\n    \"\"\"State and parameters after event k, at one state. Modes are parameters.\"\"\"\n"
           "    state, new = np.asarray(state, dtype=float), np.array(state, dtype=float)\n"
           "    p = DEFAULTS if p is None else np.asarray(p, dtype=float)\n    after = p.copy()\n";
    for (std::size_t k = 0; k < m_.events.size(); ++k) {
      const Motion::Event& e = m_.events[k];
      if (e.values.empty()) continue;
      std::vector<std::string> to;
      for (const std::string& t : e.targets) to.push_back((t[0] == 'p' ? "after" : "new") + t.substr(t.find('[')));
      const Statements b = writer_.body(e.values, to);
      out += "    if k == " + std::to_string(k) + ":\n" +
             (inputs_ && b.reads("u") ? "        u = inputs(t, state, p) if u is None else np.asarray(u, dtype=float)\n"
                                      : "") +
             indented(b.text);
    }
    return out + (m_.derived.empty() ? "    return new, after\n" : "    return new, derived(after)\n");
  }

  static std::string indented(const std::string& text) {
    std::string out = text.empty() ? "" : "    ";
    for (std::size_t i = 0; i < text.size(); ++i) {
      out += text[i];
      if (text[i] == '\n' && i + 1 < text.size()) out += "    ";
    }
    return out;
  }

  // Returns the code of the module as a program.
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
  std::optional<PivotOrder> elimination_;
};

}  // namespace

std::string emit_python(const System& system, const Structure& structure, const EmitOptions& options) {
  return PythonModule(system, structure, options).text();
}

}  // namespace anholon
