#include "base/escape.h"
#include "emit/rate_formulas.h"
#include "emit/statements.h"
#include "emit/text.h"
#include "numeric/number.h"

namespace anholon {

namespace {

using namespace emit;

std::string tuple(const std::string& name, const std::vector<std::string>& list) {
  std::string out = name + " = (";
  for (const std::string& s : list) out += "\"" + code_string(s) + "\", ";
  return out + ")\n";
}

std::string tuple(const std::string& name, const std::vector<double>& list) {
  std::string out = name + " = (";
  for (double x : list) out += number_text(x) + ", ";
  return out + ")\n";
}

constexpr const char* kRoot = R"(

def _root(np, u, r=None):
    """sqrt(u), or u**r, of a sum of squares u. A library that differentiates may have root_of_squares(u, r), whose
    derivatives are numbers at u = 0, too."""
    own = getattr(np, "root_of_squares", None)
    return own(u, r) if own else np.sqrt(u) if r is None else u**r
)";

class FormulaModule {
 public:
  explicit FormulaModule(const RateFormulas& f)
      : f_(f), names_(f), writer_(*f.model->graph, names_, Language::python, RootsOfSquares::of_library) {}

  std::string text() {
    std::string out = "\"\"\"" + code_string(f_.title.empty() ? "A motion" : f_.title) + "\n" + R"(
The rates x' = f(t, x, u, p) and outputs y, in SI units; an output that has a unit in the file is in that unit.
`np` is the library for arrays: numpy, jax.numpy, …; each function returns a list with a number or an array for each
row. Where LEAD is not empty, solve matrix lead = right of equations() for lead first; where LINEAR is false,
equations() takes lead, too, and the solution is Newton's correction of it.
"""

)" + tuple("STATES", f_.x.names) +
                      tuple("MEANINGS", f_.meanings) + tuple("INPUTS", f_.u.names) + tuple("PARAMETERS", f_.p.names) +
                      tuple("LEAD", f_.lead.names) + tuple("OUTPUTS", f_.output_names) +
                      tuple("LEFT_OUT", f_.left_out) + "LINEAR = " + (f_.linear ? "True" : "False") +
                      "\nT0 = " + number_text(f_.t) + "\n" + tuple("START", f_.start) +
                      tuple("DEFAULTS", f_.parameters) + tuple("START_INPUTS", f_.inputs);
    out += "\n\ndef defaults(np):\n    \"\"\"p of the model.\"\"\"\n" + list("out", f_.exact_parameters) +
           "    return out\n";
    if (!f_.explicit_rates())
      out += std::string("\n\ndef equations(np, t, x, u, p") + (f_.linear ? "" : ", lead") +
             "):\n    \"\"\"The matrix, row by row, and the right side.\"\"\"\n" +
             list("matrix", entries(f_.matrix())) + list("right", f_.right()) +
             "    n = len(LEAD)\n    return [matrix[k * n:(k + 1) * n] for k in range(n)], right\n";
    const std::string lead = f_.explicit_rates() ? "lead=None" : "lead";
    out += "\n\ndef rates(np, t, x, u, p, " + lead + "):\n    \"\"\"x'\"\"\"\n" + list("out", f_.rates) +
           "    return out\n";
    out += "\n\ndef outputs(np, t, x, u, p, " + lead + "):\n    \"\"\"y\"\"\"\n" + list("out", f_.outputs) +
           "    return out\n";
    if (f_.u.size() > 0 && !f_.input_formulas.empty())
      out += "\n\ndef inputs(np, t, x, p):\n    \"\"\"u by the formulas of the model.\"\"\"\n" +
             list("out", f_.input_formulas) + "    return out\n";
    return out.find("_root(np, ") == std::string::npos ? out : out + kRoot;
  }

 private:
  // Returns a list with these entries.
  std::string list(const std::string& name, const Column& formulas) {
    const Column es = with_guarded_branches(formulas);
    std::vector<std::string> targets;
    for (std::size_t i = 0; i < es.size(); ++i) targets.push_back(name + "[" + std::to_string(i) + "]");
    return "    " + name + " = [0.0] * " + std::to_string(es.size()) + "\n" + writer_.body(es, targets, true).text;
  }

  const RateFormulas& f_;
  LocalNames names_;
  Writer writer_;
};

}  // namespace

std::string emit_formulas(const RateFormulas& formulas) { return FormulaModule(formulas).text(); }

}  // namespace anholon
