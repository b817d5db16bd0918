#include "emit/python_rates.h"

#include "base/escape.h"
#include "emit/python_arithmetic.h"
#include "emit/straight_line.h"
#include "emit/text.h"
#include "numeric/number.h"

namespace anholon::emit {

namespace {

// @FREE: the parameters that others do not determine; @COUNT: the constants; @CONSTANTS, @RATES: the statements. @ONE,
// @MANY: those with the default parameters; @ROWS: the rows that blocks of states need.
constexpr const char* kRates = R"(

def _rate_constants(np, p):
    """What rates() needs of the parameters."""
    p = [p[i] for i in @FREE]
    c = [0.0] * @COUNT
@CONSTANTS    return c


def _rates(np, t, x, c, out):
@RATES

# The same for the default parameters, in fewer operations.
_multiply, _divide, _add, _subtract = np.multiply, np.divide, np.add, np.subtract


def _default_rates_of_one(t, x):
@ONE

def _default_rates(t, x, out, w):
@MANY

def _sine_and_cosine(x, sine, cosine, w):
    # By T = tan(x/2): sin x = 2 T/(1 + T^2), cos x = 2/(1 + T^2) - 1. NumPy's tan takes less time than its sin and cos.
    _multiply(x, 0.5, sine)
    np.tan(sine, sine)
    _multiply(sine, sine, w)
    _add(w, 1.0, w)
    _divide(2.0, w, w)
    _multiply(sine, w, sine)
    _subtract(w, 1.0, cosine)


_NUMBERS = (float, int, np.float64)


def rates(t, x, p=None, out=None):
    """dx/dt of the numbers X: coordinates, independent velocities, the model's states. Inputs follow their formulas.

    x is one state, or many: x[:, k] at time t[k] or t, with p[:, k] or p. out, an array like x, takes the result. A list
    of numbers gives a list, which is the fastest way for one state. The constraints hold by themselves and there are no
    multipliers. Numbers are nan or infinite where a formula has no value.
    """
    if type(x) is list and p is None and out is None and len(x) == len(X) and type(x[0]) in _NUMBERS:
        try:
            return _default_rates_of_one(t, x)
        except (ArithmeticError, ValueError, TypeError):
            return rates(t, np.array(x, dtype=float)).tolist()
    x = np.asarray(x, dtype=float)
    p = None if p is None else np.asarray(p, dtype=float)
    if x.ndim == 1:
        try:
            if p is None:
                numbers = _default_rates_of_one(float(t), x.tolist())
            else:
                numbers = [0.0] * len(X)
                _rates(_One, float(t), x.tolist(), _rate_constants(_One, p.tolist()), numbers)
        except (ArithmeticError, ValueError, TypeError):
            # A formula has no value: NumPy's functions then give nan, where those of single numbers raise.
            numbers = rates(t, x[:, None], p)[:, 0]
        if out is None:
            return np.array(numbers, dtype=float)
        out[:] = numbers
        return out
    out = np.empty_like(x) if out is None else out
    flat, result = x.reshape(len(X), -1), out.reshape(len(X), -1)
    if np.may_share_memory(flat, result):
        result = np.empty_like(flat)
    times = np.asarray(t, dtype=float)
    times = times if times.ndim == 0 else np.broadcast_to(times, x.shape[1:]).reshape(-1)
    each = p is not None and p.ndim > 1
    p = p.reshape(len(p), -1) if each else p
    # A block of this size stays in the processor's cache.
    states, size = flat.shape[1], 4096
    rows = np.empty((@ROWS, min(states, size)))
    with np.errstate(all="ignore"):
        c = None if each or p is None else _rate_constants(np, p)
        for first in range(0, states, size):
            block = slice(first, first + size)
            at = times if times.ndim == 0 else times[block]
            if p is None:
                _default_rates(at, flat[:, block], result[:, block], rows[:, : min(size, states - first)])
            else:
                _rates(np, at, flat[:, block], _rate_constants(np, p[:, block]) if each else c, result[:, block])
    if not np.may_share_memory(result, out):
        out[...] = result.reshape(out.shape)
    return out
)";

std::string names(const std::string& name, const std::vector<std::string>& list) {
  std::string out = name + " = (\n";
  for (const std::string& s : list) out += "    \"" + code_string(s) + "\",\n";
  return list.empty() ? name + " = ()\n" : out + ")\n";
}

}  // namespace

std::string python_rates(const RateFormulas& f) {
  const StraightLine rates(f, f.rates, Language::python);
  std::string out = "\n\n# The same motion in independent velocities. X_MEANINGS: their formulas.\n" +
                    names("X", f.x.names) + names("X_MEANINGS", f.meanings) + "X_START = np.array([";
  for (const double x : f.start) out += number_text(x) + ", ";
  out += "], dtype=float)\n";
  std::string free = "(";
  for (const Expr e : f.p.symbols) free += std::to_string(f.model->graph->node(e.id).index) + ", ";
  std::string text = put(kRates, "@FREE", free + ")");
  text = put(text, "@COUNT", std::to_string(rates.constant_count()));
  text = put(text, "@CONSTANTS", rates.constants());
  const std::string statements = rates.statements(false);
  const Arithmetic with_defaults = arithmetic(f, f.rates);
  const PythonOfMany many = python_of_many(with_defaults);
  text = put(text, "@ONE", python_of_one(with_defaults, f.x.size()));
  text = put(text, "@MANY", many.text.empty() ? "    return\n" : many.text);
  text = put(text, "@ROWS", std::to_string(many.rows));
  return out + put(text, "@RATES", statements.empty() ? "    return\n" : statements);
}

}  // namespace anholon::emit
