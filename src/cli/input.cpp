#include "cli/input.h"

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <sstream>

#include <unistd.h>

#include "base/installed.h"
#include "cli/say.h"
#include "modelfile/names/constant.h"
#include "motion/form_choice.h"

namespace anholon::cli {

namespace fs = std::filesystem;

static std::string first_line_value(const std::string& text, const std::string& key) {
  std::istringstream in(text);
  for (std::string line; std::getline(in, line);)
    if (line.rfind(key, 0) == 0) {
      const std::size_t a = line.find('"'), b = line.rfind('"');
      if (a != std::string::npos && b > a) return line.substr(a + 1, b - a - 1);
    }
  return {};
}

constexpr const char* kTemplates = "templates";

static std::vector<ShippedModel> shipped(const char* extension, bool of_templates = false) {
  std::vector<ShippedModel> list;
  for (const fs::path& folder : data_folders("models", ANHOLON_MODELS_DIR)) {
    std::error_code error;
    if (!fs::is_directory(folder, error)) continue;
    for (const fs::directory_entry& e : fs::recursive_directory_iterator(folder, error)) {
      if (e.path().extension() != extension || (e.path().parent_path().filename() == kTemplates) != of_templates)
        continue;
      std::string text;
      read_file(e.path(), text);
      list.push_back({e.path().stem().string(), e.path().string(), first_line_value(text, "title")});
    }
    if (!list.empty()) break;
  }
  std::sort(list.begin(), list.end(), [](const ShippedModel& a, const ShippedModel& b) { return a.path < b.path; });
  return list;
}

std::vector<ShippedModel> shipped_models() { return shipped(".toml"); }
std::vector<ShippedModel> shipped_equations() { return shipped(".eq"); }
std::vector<ShippedModel> templates() { return shipped(".toml", true); }

void print_diagnostic(const Diagnostic& d, const SourceText& source) {
  std::fflush(stdout);
  say_lines(stderr, print(d, source));
}

void print_outcome(const Outcome& o) {
  std::fflush(stdout);
  say(stderr, "stopped (%s): %s\n", name(o.kind), o.message.c_str());
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

Asker asker(const Options& o) {
  Asker a{"--", !o.save.empty() ? "--save" : !o.resume.empty() ? "--continue" : "", {}};
  a.note = [](const std::string& text) { say(stderr, "note: %s\n", text.c_str()); };
  return a;
}

Rational exact(const std::string& text, const std::string& option) {
  try {
    return read_constant(text).value;
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

std::string all_text(const SourceText& source) {
  std::string text = source.text;
  for (const SourceText& s : source.others) text += s.text;
  return text;
}

Reader read(const Options& o) {
  Reader r;
  r.source.name = o.model;
  std::string why;
  if (!read_file(o.model, r.source.text, &why)) {
    bool found = false;
    std::vector<std::string> names;
    for (const ShippedModel& m : shipped_models()) {
      names.push_back(m.name);
      if (m.name != o.model || found) continue;
      found = read_file(m.path, r.source.text);
      r.source.name = m.name + ".toml";
      r.source.path = m.path;
    }
    if (!found) {
      const std::string near = did_you_mean(o.model, names);
      throw UsageError{"error: cannot read the model '" + o.model + "': " + why + "\n" +
                       (near.empty() ? "hint: a path to a .toml file, or a name that `anholon models` lists\n"
                                     : "hint: did you mean the shipped model '" + near + "'?\n")};
    }
  }
  return read(o, std::move(r.source));
}

Reader read(const Options& o, SourceText source) {
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

// Forms whose motions can be computed, or all that apply.
static std::string list_of_forms(const Mechanics& m, bool with_motions) {
  std::string list;
  for (const Formulation* f : formulations())
    if (obstacle(*f, m).empty() && !(with_motions && f->unknowns == Unknowns::variational))
      list += (list.empty() ? "" : ", ") + std::string(f->name);
  return list;
}

// Throws if the form does not apply to the model.
static void must_apply(const Formulation& f, const Mechanics& m) {
  if (const std::string why = obstacle(f, m); !why.empty())
    throw UsageError{"error: the form '" + std::string(f.name) + "' does not apply: " + why +
                     "\nhint: these do: " + list_of_forms(m, false) + "\n"};
}

// The name of the form asked for.
static std::string wanted_form(const Options& o, const Model& model) {
  return merged(o.motion, model.simulate).form.value_or("routh");
}

const Formulation& form(const Options& o, const Model& model, const Mechanics* mechanics) {
  const bool from_file = !o.motion.form && model.simulate.form;
  const std::string wanted = wanted_form(o, model);
  const Formulation* f = find_formulation(wanted);
  if (!f) {
    std::vector<std::string> names;
    std::string list;
    for (const Formulation* k : formulations()) {
      names.push_back(k->name);
      list += (list.empty() ? "" : ", ") + std::string(k->name);
    }
    const std::string near = did_you_mean(wanted, names);
    const std::string message = wanted == "auto"
                                    ? std::string("'auto' is a form for motions, to simulate, sweep and check")
                                    : "there is no form '" + wanted + "'" +
                                          (near.empty() ? "" : "; did you mean '" + near + "'?"),
                      hint = "the forms are " + list;
    if (from_file)
      throw UsageError{print({Severity::error, model.simulate.form_span, message, hint}, model.source_text)};
    throw UsageError{"error: " + message + "\nhint: " + hint + "\n"};
  }
  if (mechanics) must_apply(*f, *mechanics);
  return *f;
}

Options with_form(Options o, const Reader& in) {
  if (wanted_form(o, *in.model) != "auto") return o;
  const FormChoice choice = choose_form(in.model, state_choice(o, *in.model));
  o.motion.form = choice.form->name;
  if (!o.quiet) say(stderr, "form %s: %s\n", choice.form->name, choice.why.c_str());
  return o;
}

Outcome ready(const Reader& in, const Formulation& f, const StateChoice& choice, Scenario& s) {
  if (f.unknowns == Unknowns::variational)
    throw UsageError{"error: the form '" + std::string(f.name) +
                     "' is another mechanics: it is derived and compared, but no motion is computed with it\nhint: "
                     "these give motions: " +
                     list_of_forms(mechanics(*in.model), true) + "\n"};
  if (f.obstacle != no_obstacle) must_apply(f, mechanics(*in.model));
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

StateChoice state_choice(const Options& o, const Model& model) {
  StateChoice c;
  for (const std::string& word : split(o.eliminate)) {
    const std::string name = normal_name(word);
    const auto& names = model.names.coordinates;
    const auto it = std::find(names.begin(), names.end(), name);
    if (it == names.end()) {
      const std::string near = did_you_mean(name, names);
      throw UsageError{"error: --eliminate: there is no coordinate '" + name + "'" +
                       (near.empty() ? "" : "; did you mean '" + near + "'?") + "\n"};
    }
    c.eliminate.push_back(static_cast<std::size_t>(it - names.begin()));
  }
  if (!o.t.empty()) c.t = exact(o.t, "--t");
  unsigned highest = 2;  // derivatives of this order follow from the state
  for (const Constraint& m : model.constraints) highest = std::max(highest, static_cast<unsigned>(m.order));
  for (const auto& [list, order, option] : {std::tuple{&o.q, 0U, "--q"}, std::tuple{&o.qdot, 1U, "--qdot"},
                                            std::tuple{&o.qddot, 2U, "--qddot"}, std::tuple{&o.qdddot, 3U, "--qdddot"}})
    for (const std::string& s : split(*list)) {
      auto [name, value] = assignment(s, option);
      unsigned primes = 0;
      while (!name.empty() && name.back() == '\'') name.pop_back(), ++primes;
      const unsigned k = order == 0 ? primes : order;  // --qdot "x'=2" also means x'
      const auto it = std::find(model.names.coordinates.begin(), model.names.coordinates.end(), name);
      if (it == model.names.coordinates.end()) {
        const std::string near = did_you_mean(name, model.names.coordinates);
        throw UsageError{"error: " + std::string(option) + ": there is no coordinate '" + name + "'" +
                         (near.empty() ? "" : "; did you mean '" + near + "'?") + "\n"};
      }
      if (k >= highest)
        throw UsageError{
            "error: " + std::string(option) + ": " +
            (highest == 2 ? "accelerations follow" : "derivatives of order " + std::to_string(k) + " follow") +
            " from the state\n"};
      for (const StateOverride& before : c.overrides)
        if (before.order == k && before.coordinate == static_cast<std::size_t>(it - model.names.coordinates.begin()))
          throw UsageError{"error: " + std::string(option) + " gives '" + name + "' twice\n"};
      c.overrides.push_back({k, static_cast<std::size_t>(it - model.names.coordinates.begin()), exact(value, option)});
    }
  for (const auto& [list, order, option] :
       {std::tuple{&o.lambda, 0U, "--lambda"}, std::tuple{&o.lambdadot, 1U, "--lambdadot"}})
    for (const std::string& s : split(*list)) {
      const auto [name, value] = assignment(s, option);
      const auto& names = model.names.multipliers;
      const auto it = std::find(names.begin(), names.end(), name);
      if (it == names.end()) {
        const std::string near = did_you_mean(name, names);
        throw UsageError{"error: " + std::string(option) + ": there is no constraint '" + name + "'" +
                         (near.empty() ? "" : "; did you mean '" + near + "'?") + "\n"};
      }
      if (order + 2 >= highest)
        throw UsageError{
            "error: " + std::string(option) +
            ": multipliers follow from the state\nhint: they are initial data for constraints of order 3 and more\n"};
      const auto k = static_cast<std::size_t>(it - names.begin());
      for (const StateOverride& before : c.overrides)
        if (before.multiplier && before.order == order && before.coordinate == k)
          throw UsageError{"error: " + std::string(option) + " gives '" + name + "' twice\n"};
      c.overrides.push_back({order, k, exact(value, option), true});
    }
  return c;
}

}  // namespace anholon::cli
