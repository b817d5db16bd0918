#include <algorithm>

#include "base/escape.h"
#include "emit/statements.h"
#include "emit/text.h"
#include "numeric/number.h"

namespace anholon {

namespace {

using namespace emit;

// `$` marks the name that the user gave.
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
  for (const std::string& s : list) {
    const std::string text = code_string(s);
    // Two question marks may begin a trigraph.
    out += "  \"" + (text.find("??") == std::string::npos ? text : replaced(text, "?", "\\?")) + "\",\n";
  }
  return out + "  0};\n";
}

// The text of a C file, part by part. `$` marks the name that the user gave.
class CFile {
 public:
  CFile(const System& system, const Structure& structure, const EmitOptions& options)
      : system_(system), structure_(structure), options_(options), m_(motion(system, structure, options)),
        names_(system, structure, m_), writer_(*system.model->graph, names_, Language::c), inputs_(!m_.inputs.empty()) {
    const std::size_t n = system.size();
    residual_ = writer_.body(m_.residual, targets("out", n));
    jacobian_ = writer_.body(entries(m_.jacobian), targets("out", n * n), true);
    hidden_ = writer_.body(m_.hidden, targets("out", m_.hidden.size()));
    formulas_ = writer_.body(m_.input_values, targets("out", m_.inputs.size()));
    outputs_ = writer_.body(m_.outputs, targets("out", m_.outputs.size()));
    Column when;
    for (const Motion::Event& e : m_.events) {
      when.push_back(e.when);
      sets_.push_back(writer_.body(e.values, targets("out", e.values.size())));
    }
    events_ = writer_.body(when, targets("out", when.size()));
    const ParameterAssignments parameters = parameter_assignments(m_);
    defaults_ = writer_.body(parameters.free.values, parameters.free.targets);
    derived_ = writer_.body(parameters.derived.values, parameters.derived.targets);
  }

  std::string text() const {
    const std::string program = contents() + declarations() + tables() + parameters() + equations() + c_solver() +
                                newton() + right_side() + many() + results() + resets() + start();
    // A title may contain a $.
    return "/*\n" + lines(head(system_, structure_, m_, options_), " * ") +
           replaced(program, "$", identifier(options_.name, "motion"));
  }

 private:
  // Adds the inputs after the parameters.
  std::string with_inputs(std::string text) const {
    if (!inputs_) return text;
    text = replaced(std::move(text), "const double *p, double *", "const double *p, const double *u, double *");
    text = replaced(std::move(text), "double *lead, double *p)", "double *lead, double *p, const double *u)");
    return replaced(replaced(replaced(std::move(text), "p, f)", "p, u, f)"), "p, a)", "p, u, a)"), "p, lead)",
                    "p, u, lead)");
  }

  std::string arguments() const {
    return with_inputs("(double t, const double *state, const double *lead, const double *p, double *out)");
  }

  // Returns the lines before the statements of a function of all arguments: its own inputs, and a mention of each
  // argument that it does not read.
  std::string before(const Statements& s) const {
    const std::string own = !inputs_       ? ""
                            : s.reads("u") ? "  double own[$_INPUTS];\n  if (!u) $_inputs(t, state, p, own), u = own;\n"
                                           : "  (void)u;\n";
    const bool all = s.reads("u");  // t, state and p are passed on to the formulas of the inputs
    return own + unused({{"t", all || s.time},
                         {"state", all || s.reads("state")},
                         {"lead", s.reads("lead")},
                         {"p", all || s.reads("p")}});
  }

  // Returns the comment that lists the functions, and the headers.
  std::string contents() const {
    std::string out = R"( *
 * $_defaults      sets p to the default values
)";
    if (!m_.derived.empty())
      out += " * $_derived       computes anew the parameters that depend on others: call it after a change of p\n";
    if (inputs_) out += " * $_inputs        the inputs by the formulas of the model\n";
    out += R"( * $_residual      the equations, out of any state and lead
 * $_jacobian      their derivatives by lead
 * $_hidden        the hidden constraints
 * $_leading       solves for lead; on entry lead is where to start: zeros if linear, $_begin at the start
 * $_rhs           d state / dt, for an integrator
 * $_rhs_near      the same; lead is where to start, and becomes the solution
 * $_rhs_many      of many states: number i of state k is state[i*count + k], likewise dstate; nan where there is none
)";
    if (!m_.outputs.empty()) out += " * $_outputs       monitors and outputs of the model\n";
    if (!m_.events.empty())
      out += " * $_events        formulas that pass zero where an event happens: upward (direction 1), downward (-1) "
             "or both (0)\n"
             " * $_reset         what event k sets, in state and p; the motion ends there if $_event_stops[k]\n";
    if (options_.start) out += " * $_start         a time and a state to begin with\n";
    return out + R"( * $_leading and $_rhs, _near, _many return 0; 1 if the jacobian is singular, 2 if Newton's method
 * does not converge, 3 if a formula has no value.
 */
#include <math.h>

)";
  }

  std::string declarations() const {
    std::string out =
        "enum { $_UNKNOWNS = " + std::to_string(system_.size()) + ", $_STATE = " + std::to_string(m_.state.size()) +
        ", $_HIDDEN = " + std::to_string(m_.hidden.size()) +
        ", $_PARAMETERS = " + std::to_string(m_.parameters.size()) +
        ", $_OUTPUTS = " + std::to_string(m_.outputs.size()) + ", $_EVENTS = " + std::to_string(m_.events.size()) +
        (inputs_ ? ", $_INPUTS = " + std::to_string(m_.inputs.size()) : std::string()) + " };\n\n";
    out += "extern const char *const $_parameter_names[], *const $_state_names[], *const $_lead_names[];\n";
    if (inputs_) out += "extern const char *const $_input_names[];\n";
    out += "extern const double $_begin[];\nvoid $_defaults(double *p);\n";
    if (!m_.derived.empty()) out += "void $_derived(double *p);\n";
    if (inputs_) out += "void $_inputs(double t, const double *state, const double *p, double *out);\n";
    out += "void $_residual" + arguments() + ";\nvoid $_jacobian" + arguments() + ";\n";
    out += "void $_hidden(double t, const double *state, const double *p, double *out);\n";
    out += with_inputs("int $_leading(double t, const double *state, const double *p, double *lead);\n"
                       "int $_rhs(double t, const double *state, const double *p, double *dstate);\n"
                       "int $_rhs_near(double t, const double *state, const double *p, double *lead, double *dstate);\n"
                       "int $_rhs_many(double t, long count, const double *state, const double *p, double *dstate);\n");
    if (!m_.outputs.empty()) out += "extern const char *const $_output_names[];\nvoid $_outputs" + arguments() + ";\n";
    if (!m_.events.empty())
      out += "extern const char *const $_event_names[];\nextern const int $_event_directions[], $_event_stops[];\n"
             "void $_events" +
             arguments() + ";\nvoid $_reset" + reset_arguments() + ";\n";
    if (options_.start) out += "void $_start(double *t, double *state);\n";
    return out;
  }

  // Returns tables with the names of all quantities.
  std::string tables() const {
    std::vector<std::string> parameters;
    for (const Parameter& p : system_.model->parameters) parameters.push_back(p.name);
    return "\n/* Each ends with a null pointer. */\n" + names_table("$_parameter_names", parameters) +
           names_table("$_state_names", m_.state_names) + names_table("$_lead_names", m_.leading_names) +
           (inputs_ ? names_table("$_input_names", m_.input_names) : std::string()) +
           (m_.outputs.empty() ? "" : names_table("$_output_names", m_.output_names)) + event_tables();
  }

  std::string parameters() const {
    std::string out =
        writer_.used_sign() ? "\nstatic double $_sign(double x) { return x > 0 ? 1 : x < 0 ? -1 : 0; }\n" : "";
    out += "\nvoid $_defaults(double *p)\n{\n" + unused({{"p", !m_.parameters.empty()}}) + defaults_.text;
    if (!m_.derived.empty()) out += "  $_derived(p);\n}\n\nvoid $_derived(double *p)\n{\n" + derived_.text;
    return out + "}\n";
  }

  std::string equations() const {
    std::string out;
    if (inputs_)
      out += "\nvoid $_inputs(double t, const double *state, const double *p, double *out)\n{\n" +
             unused({{"t", formulas_.time}, {"state", formulas_.reads("state")}, {"p", formulas_.reads("p")}}) +
             formulas_.text + "}\n";
    out += "\nvoid $_residual" + arguments() + "\n{\n" + before(residual_) + residual_.text + "}\n";
    out += "\nvoid $_jacobian" + arguments() + "\n{\n  int i;\n" + before(jacobian_) +
           "  for (i = 0; i < $_UNKNOWNS * $_UNKNOWNS; ++i) out[i] = 0;\n" + jacobian_.text + "}\n";
    return out + "\nvoid $_hidden(double t, const double *state, const double *p, double *out)\n{\n" +
           unused({{"t", hidden_.time},
                   {"state", hidden_.reads("state")},
                   {"p", hidden_.reads("p")},
                   {"out", !m_.hidden.empty()}}) +
           hidden_.text + "}\n";
  }

  std::string newton() const {
    const std::vector<std::string> factor = {"$_jacobian(t, state, lead, p, a);",
                                             "status = $_factor(a, order, row, column);", "if (status) return status;"};
    std::string text = put(kNewton, "@ONCE", m_.linear ? lines(factor, "  ") : "");
    text = put(text, "@EACH", m_.linear ? "" : lines(factor, "    "));
    return put(with_inputs(text), "@SETTLED",
               m_.linear ? "length > 0.5 * before" : "(length <= 1e-8 * size && length > 0.5 * before)");
  }

  std::string event_tables() const {
    if (m_.events.empty()) return {};
    std::vector<std::string> names;
    std::string directions, stops;
    for (const Motion::Event& e : m_.events) {
      const Event& of = system_.model->events[e.index];
      names.push_back(of.name);
      directions += (directions.empty() ? "" : ", ") + std::to_string(of.direction);
      stops += (stops.empty() ? "" : ", ") + std::to_string(of.stop);
    }
    return names_table("$_event_names", names) + "const int $_event_directions[] = {" + directions +
           "};\nconst int $_event_stops[] = {" + stops + "};\n";
  }

  std::string right_side() const {
    // The start of Newton's method.
    std::string out = "\nconst double $_begin[$_UNKNOWNS + 1] = {";
    const bool guess = !m_.linear && options_.start && !options_.start->leading.empty();
    for (std::size_t j = 0; guess && j < system_.size(); ++j) out += number_text(options_.start->leading[j]) + ", ";
    out += "0};\n";
    out += with_inputs("\nint $_rhs(double t, const double *state, const double *p, double *dstate)\n{\n"
                       "  double lead[$_UNKNOWNS];\n  int j;\n"
                       "  for (j = 0; j < $_UNKNOWNS; ++j) lead[j] = $_begin[j];\n") +
           (inputs_ ? "  return $_rhs_near(t, state, p, u, lead, dstate);\n}\n"
                    : "  return $_rhs_near(t, state, p, lead, dstate);\n}\n");
    out += with_inputs("\nint $_rhs_near(double t, const double *state, const double *p, double *lead, double "
                       "*dstate)\n{\n") +
           unused({{"dstate", !m_.state.empty()}}) +
           with_inputs("  const int status = $_leading(t, state, p, lead);\n");
    for (std::size_t i = 0; i < m_.state.size(); ++i)
      out += "  dstate[" + std::to_string(i) + "] = " + rate_of_state(structure_, m_, i) + ";\n";
    return out + "  return status;\n}\n";
  }

  // Returns a function of many states. If the equations are not linear, the solution for one state is the first guess
  // for the next.
  std::string many() const {
    const std::string u = inputs_ ? ", u" : "";
    return with_inputs(
               "\nint $_rhs_many(double t, long count, const double *state, const double *p, double *dstate)\n{\n") +
           R"(  double one[$_STATE + 1], rate[$_STATE + 1], lead[$_UNKNOWNS];
  int result = 0, i;
  long k;
  for (k = 0; k < count; ++k) {
    int status;
    for (i = 0; i < $_STATE; ++i) one[i] = state[i*count + k];
    for (i = 0; i < $_UNKNOWNS; ++i) lead[i] = $_begin[i];
    status = $_rhs_near(t, one, p)" +
           u + R"(, lead, rate);
    if (status && !result) result = status;
    for (i = 0; i < $_STATE; ++i) dstate[i*count + k] = status ? NAN : rate[i];
  }
  return result;
}
)";
  }

  std::string results() const {
    std::string out;
    if (!m_.outputs.empty())
      out += "\nvoid $_outputs" + arguments() + "\n{\n" + before(outputs_) + outputs_.text + "}\n";
    if (!m_.events.empty()) out += "\nvoid $_events" + arguments() + "\n{\n" + before(events_) + events_.text + "}\n";
    return out;
  }

  std::string reset_arguments() const {
    return with_inputs("(int k, double t, double *state, const double *lead, double *p)");
  }

  // Returns the function with the assignments of events. All formulas of one event use the values before it.
  std::string resets() const {
    if (m_.events.empty()) return {};
    std::size_t most = 1;
    for (const Motion::Event& e : m_.events) most = std::max(most, e.values.size());
    std::string out = "\nvoid $_reset" + reset_arguments() + "\n{\n  double out[" + std::to_string(most) + "];\n" +
                      unused({{"t", false}, {"state", false}, {"lead", false}, {"p", false}}) +
                      (inputs_ ? "  (void)u;\n" : "") + "  (void)out;\n  switch (k) {\n";
    for (std::size_t k = 0; k < m_.events.size(); ++k) {
      const Motion::Event& e = m_.events[k];
      if (e.values.empty()) continue;
      out +=
          "  case " + std::to_string(k) + ": {\n" +
          (inputs_ && sets_[k].reads("u") ? "  double own[$_INPUTS];\n  if (!u) $_inputs(t, state, p, own), u = own;\n"
                                          : "") +
          sets_[k].text;
      for (std::size_t i = 0; i < e.targets.size(); ++i)
        out += "  " + e.targets[i] + " = out[" + std::to_string(i) + "];\n";
      out += std::string(m_.derived.empty() ? "" : "  $_derived(p);\n") + "  break;\n  }\n";
    }
    return out + "  default:\n  break;\n  }\n}\n";
  }

  std::string start() const {
    if (!options_.start) return {};
    std::string out = "\nvoid $_start(double *t, double *state)\n{\n  *t = " + number_text(options_.start->t) + ";\n";
    const std::vector<double> state = start_state(m_, *options_.start);
    for (std::size_t i = 0; i < state.size(); ++i)
      out += "  state[" + std::to_string(i) + "] = " + number_text(state[i]) + ";\n";
    return out + "}\n";
  }

  const System& system_;
  const Structure& structure_;
  const EmitOptions& options_;
  Motion m_;
  LocalNames names_;
  Writer writer_;
  bool inputs_;
  Statements residual_, jacobian_, hidden_, formulas_, defaults_, derived_, outputs_, events_;
  std::vector<Statements> sets_;  // by event
};

}  // namespace

std::string emit_c(const System& system, const Structure& structure, const EmitOptions& options) {
  return CFile(system, structure, options).text();
}

}  // namespace anholon
