#include "cli/input.h"

#include <algorithm>
#include <cstdio>

#include "cli/say.h"
#include "modelfile/names/constant.h"
#include "motion/form_choice.h"
#include "setup/choice.h"

namespace anholon::cli {

std::vector<ShippedFile> shipped(Shipped kind) { return shipped_files(kind); }

void print_diagnostic(const Diagnostic& d, const SourceText& source) {
  std::fflush(stdout);
  say_lines(stderr, print(d, source));
}

UsageError usage_error(const Failure& f, const SourceText& source, const std::string& before) {
  Diagnostic d = f.diagnostic;
  d.message = before + d.message;
  if (d.span.line > 0) return {print(d, source)};
  return {"error: " + d.message + "\n" + (d.hint.empty() ? "" : "hint: " + d.hint + "\n")};
}

void print_outcome(const Outcome& o, const SourceText& source) {
  std::fflush(stdout);
  say(stderr, "stopped (%s): %s\n", name(o.kind), o.message.c_str());
  if (!source.name.empty()) say_lines(stderr, print_place(o.place, source));
  if (!o.hint.empty()) say(stderr, "hint: %s\n", o.hint.c_str());
}

std::vector<std::string> split(const std::vector<std::string>& words) {
  std::vector<std::string> out;
  for (const std::string& w : words) {
    int depth = 0;
    std::string part;
    for (char c : w) {
      if (c == '(' || c == '[') ++depth;
      if (c == ')' || c == ']') --depth;
      if (c == ',' && depth == 0) {
        out.push_back(part);
        part.clear();
      } else {
        part += c;
      }
    }
    if (!part.empty()) out.push_back(part);
  }
  return out;
}

Asker asker(const char* saving) {
  Asker a{"--", saving, {}};
  a.note = [](const std::string& text) { say(stderr, "note: %s\n", text.c_str()); };
  return a;
}

Rational exact(const std::string& text, const std::string& option) { return constant(text, option).value; }

Constant constant(const std::string& text, const std::string& option) {
  try {
    return read_constant(text);
  } catch (const Failure& f) {
    const std::string why = f.diagnostic.message.rfind("'" + text, 0) == 0 ? "" : ": " + f.diagnostic.message;
    throw UsageError{"error: " + option + ": '" + text + "' is not a number" + why +
                     "\nhint: a decimal such as 0.25, 1e-12, a fraction 1/3, pi/2 or a number with a unit, '30 deg'\n"};
  }
}

static std::pair<std::string, std::string> assignment(const std::string& text, const std::string& option) {
  const std::size_t equals = text.find('=');
  if (equals == std::string::npos || equals == 0 || equals + 1 == text.size())
    throw UsageError{"error: " + option + ": '" + text + "' is not of the form NAME=VALUE\n"};
  return {normal_name(text.substr(0, equals)), text.substr(equals + 1)};
}

void refuse(const MistakeInWord& m, const char* option) {
  throw UsageError{print(m.diagnostic, SourceText{m.file.empty() ? option : m.file, m.word})};
}

Reader read(const ModelCommand& o) { return read(o, model_text(o.model)); }

Reader read(const ModelCommand& o, SourceText source) {
  Reader r;
  r.source = std::move(source);
  Overrides overrides;
  for (const std::string& s : split(o.set)) {
    const auto [name, value] = assignment(s, "--set");
    if (overrides.count(name)) throw UsageError{"error: --set gives '" + name + "' twice\n"};
    overrides[name] = value;
  }
  Diagnostics diagnostics;
  auto model = open_model(r.source, diagnostics, overrides, o.cases);
  std::fflush(stdout);
  if (!model) {
    const std::size_t n =
        static_cast<std::size_t>(std::count_if(diagnostics.list().begin(), diagnostics.list().end(),
                                               [](const Diagnostic& d) { return d.severity == Severity::error; }));
    throw UsageError{diagnostics.print(r.source) + std::to_string(n) + (n == 1 ? " error\n" : " errors\n")};
  }
  say_lines(stderr, diagnostics.print(r.source));
  r.model = model->model;
  r.source = r.model->source_text;
  r.names = model->names;
  return r;
}

// Returns the name of the form that the options or the file ask for.
static std::string wanted_form(const SystemCommand& o, const Model& model) {
  return merged(o.motion, model.simulate).form.value_or("routh");
}

const Formulation& form(const SystemCommand& o, const Model& model, const Mechanics* mechanics) {
  const Formulation* f = nullptr;
  try {
    f = &named_form(wanted_form(o, model));
  } catch (Failure& e) {
    if (o.motion.form || !model.simulate.form) throw;
    e.diagnostic.span = model.simulate.form_span;
    throw UsageError{print(e.diagnostic, model.source_text)};
  }
  if (mechanics) must_apply(*f, *mechanics);
  return *f;
}

void settle_form(SystemCommand& o, const Reader& in) {
  if (wanted_form(o, *in.model) != "auto") return;
  const FormChoice choice = choose_form(in.model, state_choice(o, *in.model));
  o.motion.form = choice.form->name;
  if (!o.quiet) say(stderr, "form %s: %s\n", choice.form->name, choice.why.c_str());
}

void must_have_motions(const Reader& in, const Formulation& f) {
  if (f.unknowns == Unknowns::variational) anholon::must_have_motions(f, mechanics(*in.model));
  if (f.obstacle != no_obstacle) must_apply(f, mechanics(*in.model));
}

Outcome ready(const Reader& in, const Formulation& f, const StateChoice& choice, Scenario& s) {
  must_have_motions(in, f);
  try {
    return make_scenario(in.model, f, choice, s);
  } catch (const Failure& e) {
    throw UsageError{print(e.diagnostic, in.source)};
  }
}

void must_have_order(const Formulation& f, const Mechanics& m, unsigned order) {
  const std::string why = order_obstacle(f, m, order);
  if (why.empty()) return;
  std::string list;
  for (const Formulation* k : formulations())
    if (obstacle(*k, m).empty() && order_obstacle(*k, m, order).empty())
      list += (list.empty() ? "" : ", ") + std::string(k->name);
  throw UsageError{"error: --m " + std::to_string(order) + ": the form '" + std::string(f.name) +
                   "' does not have this order: " + why +
                   "\nhint: " + (list.empty() ? "no form has it" : "these have it: " + list) + "\n"};
}

Elimination elimination(const Reader& in, const Mechanics& m, const Formulation& f, const StateChoice& choice,
                        unsigned order) {
  try {
    return elimination_for(m, f.unknowns, choice.overrides, choice.eliminate, true, order);
  } catch (const Failure& e) {
    throw UsageError{print(e.diagnostic, in.source)};
  }
}

std::vector<Eliminations> eliminations_of(const Reader& in, const Mechanics& m, const StateChoice& choice,
                                          unsigned order) {
  try {
    std::vector<Eliminations> list;
    for (const bool solve : {true, false})
      list.push_back(
          {elimination_for(m, Unknowns::coordinates, choice.overrides, choice.eliminate, solve, order),
           elimination_for(m, Unknowns::quasi_velocities, choice.overrides, choice.eliminate, solve, order)});
    return list;
  } catch (const Failure& e) {
    throw UsageError{print(e.diagnostic, in.source)};
  }
}

StateChoice state_choice(const SystemCommand& o, const Model& model) {
  StateChoice c;
  c.open_parameters.emplace();
  for (const std::string& word : split(o.eliminate)) c.eliminate.push_back(coordinate_of(model, word, "--eliminate: "));
  if (!o.t.empty()) c.t = time_value(constant(o.t, "--t"), "--t: ");
  struct Given {
    const char* option;
    const std::vector<std::string>& words;
    unsigned order;
    bool multiplier;
  };
  for (const Given& g : {Given{"--q", o.q, 0, false}, Given{"--qdot", o.qdot, 1, false},
                         Given{"--qddot", o.qddot, 2, false}, Given{"--qdddot", o.qdddot, 3, false},
                         Given{"--lambda", o.lambda, 0, true}, Given{"--lambdadot", o.lambdadot, 1, true}})
    for (const std::string& word : split(g.words)) {
      const auto [name, value] = assignment(word, g.option);
      InitialName of = g.multiplier ? InitialName{name, g.order, true} : initial_name(name);
      if (g.order > 0) of.order = g.order;  // --qdot "x'=2" means x', too
      give(c, model, of, constant(value, g.option), std::string(g.option) + ": ");
    }
  return c;
}

}  // namespace anholon::cli
