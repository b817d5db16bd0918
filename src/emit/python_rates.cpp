#include "emit/python_rates.h"

#include "base/escape.h"
#include "emit/straight_line.h"
#include "emit/text.h"
#include "numeric/number.h"

namespace anholon::emit {

namespace {

// @FREE: the parameters that others do not determine; @COUNT: the constants; @SIZE: the numbers of a state; @CONSTANTS, @RATES:
// the statements.
constexpr const char* kRates = R"(

def _rate_constants(np, p):
    """What rates() needs of the parameters."""
    p = [p[i] for i in @FREE]
    c = [0.0] * @COUNT
@CONSTANTS    return c


def _rates(np, t, x, c, out):
@RATES

with np.errstate(all="ignore"):
    _RATE_CONSTANTS = [float(_c) for _c in _rate_constants(np, DEFAULTS)]


def rates(t, x, p=None, out=None):
    """dx/dt of the numbers X: coordinates, independent velocities, the model's states. Inputs follow their formulas.

    x is one state, or many: x[:, k] at time t[k] or t, with p[:, k] or p. out, an array like x, takes the result. The
    constraints hold by themselves and there are no multipliers. Numbers are nan or infinite where a formula has no value.
    A list of floats is one state, too; its rates are a list, which is the fastest call for one state.
    """
    if type(x) is list and p is None and out is None:
        try:
            numbers = [0.0] * @SIZE
            _rates(_One, t, x, _RATE_CONSTANTS, numbers)
            return numbers
        except (ArithmeticError, ValueError, TypeError):
            return rates(t, np.asarray(x, dtype=float)).tolist()
    x = np.asarray(x, dtype=float)
    p = None if p is None else np.asarray(p, dtype=float)
    out = np.empty_like(x) if out is None else out
    if x.ndim == 1:
        try:
            numbers = [0.0] * @SIZE
            _rates(_One, float(t), x.tolist(), _RATE_CONSTANTS if p is None else _rate_constants(_One, p.tolist()), numbers)
            out[:] = numbers
        except (ArithmeticError, ValueError, TypeError):
            # A formula has no value: NumPy's functions then give nan, where those of single numbers raise.
            with np.errstate(all="ignore"):
                _rates(np, np.float64(t), x, _RATE_CONSTANTS if p is None else _rate_constants(np, p), out)
        return out
    flat, result = x.reshape(len(X), -1), out.reshape(len(X), -1)
    times = np.asarray(t, dtype=float)
    times = times if times.ndim == 0 else np.broadcast_to(times, x.shape[1:]).reshape(-1)
    each = p is not None and p.ndim > 1
    p = p.reshape(len(p), -1) if each else p
    with np.errstate(all="ignore"):
        c = None if each else _RATE_CONSTANTS if p is None else _rate_constants(np, p)
        # A block of this size stays in the processor's cache.
        for first in range(0, flat.shape[1], 8192):
            block = slice(first, first + 8192)
            _rates(np, times if times.ndim == 0 else times[block], flat[:, block],
                   _rate_constants(np, p[:, block]) if each else c, result[:, block])
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
  for (int k = 0; k < 2; ++k) text = put(text, "@SIZE", std::to_string(f.x.size()));
  text = put(text, "@COUNT", std::to_string(rates.constant_count()));
  text = put(text, "@CONSTANTS", rates.constants());
  const std::string statements = rates.statements(false);
  return out + put(text, "@RATES", statements.empty() ? "    return\n" : statements);
}

}  // namespace anholon::emit
