#include <cstdio>
#include <filesystem>

#include "base/json.h"
#include "cli/input.h"
#include "cli/show.h"
#include "expr/arrange.h"
#include "expr/normal.h"
#include "program/emit.h"

namespace anholon::cli {

namespace {

// As the user wrote it (none), written out (full), or as a person would write it: never longer than these.
Column arranged(const Column& es, const SymbolNames& names, const std::string& expand) {
  if (expand == "none") return es;
  Column out;
  for (Expr e : es) out.push_back(expand == "full" ? expanded(e).value_or(e) : anholon::arranged(e, names));
  return out;
}

// Programs do not solve for what enters nonlinearly, and do not start from more than positions and velocities.
std::optional<Diagnostic> not_written(const Model& model, const Mechanics& m) {
  if (auto d = not_integrated(model)) return d;
  const std::vector<ConstraintClass> classes = classify(m);
  for (std::size_t r = 0; r < model.constraints.size(); ++r) {
    const Constraint& c = model.constraints[r];
    if (c.order > 2 || (c.order == 2 && classes[r].kind == "nonlinear"))
      return Diagnostic{Severity::error, c.span,
                        "a program is not written yet for the constraint '" + c.name + "' of order " + std::to_string(c.order) + " (" + classes[r].kind + ")",
                        "anholon simulate integrates it; programs are written for orders 0 and 1, and 2 where it is linear in the accelerations"};
  }
  return std::nullopt;
}

// The motion as a program in C or Python.
int write_program(const Options& o, const Reader& in, const Mechanics& m, const Formulation& f) {
  if (o.json) throw UsageError{"error: --format " + o.format + " is not JSON\nhint: leave one of --json and --format out\n"};
  if (const auto d = not_written(*in.model, m)) {
    print_diagnostic(*d, in.source);
    return kBadInput;
  }
  Scenario s;
  const Outcome outcome = ready(in, f, state_choice(o, *in.model), s);
  if (!outcome.ok()) {
    print_outcome(outcome);
    return kStopped;
  }
  EmitOptions options;
  options.name = std::filesystem::path(o.model).stem().string();
  options.made_by = "anholon derive " + o.model + " --format " + o.format + (o.form_given ? " --form " + o.form : "");
  for (const std::string& set : o.set) options.made_by += " --set " + set;
  options.start = {s.state.t, s.state.q, s.state.qd};
  try {
    std::fputs((o.format == "c" ? emit_c : emit_python)(s.system, s.structure, options).c_str(), stdout);
  } catch (const Failure& failure) {
    print_diagnostic(failure.diagnostic, in.source);
    return kBadInput;
  }
  return kOk;
}

}  // namespace

int derive(const Options& o) {
  const Reader in = read(o);
  const Model& model = *in.model;
  if (o.format != "text" && o.format != "latex" && o.format != "mathml" && o.format != "c" && o.format != "python")
    throw UsageError{"error: --format: '" + o.format + "' is not written yet\nhint: text, latex or mathml, --json for text and latex; c or python\n"};
  if (o.expand != "auto" && o.expand != "none" && o.expand != "paper" && o.expand != "full")
    throw UsageError{"error: --expand: '" + o.expand + "'\nhint: auto, none, paper or full\n"};
  const Mechanics m = mechanics(model);
  const Formulation& f = form(o, model, &m);
  if (!o.show.empty()) {
    Scenario s;
    ready(in, f, state_choice(o, model), s);
    return show(o, s);
  }
  if (o.format == "c" || o.format == "python") return write_program(o, in, m, f);
  const Elimination elim = elimination(in, m, f, state_choice(o, model));
  const Equations e = f.equations(m, elim);
  SymbolNames names = model.names;
  if (elim.quasi) names.quasi = elim.names;
  std::vector<std::string> labels = elim.names;
  if (e.left.size() == model.coordinates.size()) labels = model.names.coordinates;
  for (std::size_t i = 0; i < model.masses.size(); ++i) {
    // After the last differentiation a mass stands under its own name again, if it has one.
    const auto named = names.defined.find(model.masses[i].value.id);
    if (named == names.defined.end()) names.masses[i] = "m_" + model.masses[i].name;
    else names.masses[i] = named->second;
  }
  const Column left = arranged(e.left, names, o.expand), right = arranged(e.right, names, o.expand), phi = arranged(m.phi, names, o.expand);
  const auto texts = [&](const Column& c, Format format) { return print(c, names, format); };

  if (o.json) {
    JsonWriter j;
    j.open_object();
    j.key("model").string(model.title).key("form").string(f.name).key("title").string(f.title);
    j.key("equation").string(f.equation).key("source").string(f.source);
    const auto list = [&](const char* key, const Column& l, const Column& r, const std::vector<std::string>& of) {
      const auto lt = texts(l, Format::text), rt = texts(r, Format::text), ll = texts(l, Format::latex), rl = texts(r, Format::latex);
      j.key(key).open_array();
      for (std::size_t i = 0; i < of.size(); ++i)
        j.open_object().key("name").string(of[i]).key("left").string(lt[i]).key("right").string(rt[i]).key("latex").string(ll[i] + " = " + rl[i]).close();
      j.close();
    };
    std::vector<std::string> constraints;
    for (const Constraint& c : model.constraints) constraints.push_back(c.name);
    list("equations", left, right, labels);
    list("constraints", phi, Column(phi.size(), m.graph().zero()), constraints);
    j.key("masses").open_object();
    for (std::size_t i = 0; i < model.masses.size(); ++i) j.key(names.masses[i]).string(print(model.masses[i].value, model.names, Format::text));
    j.close().close();
    std::printf("%s\n", j.text().c_str());
    return kOk;
  }
  const Format format = o.format == "latex" ? Format::latex : o.format == "mathml" ? Format::mathml : Format::text;
  const auto l = texts(left, format), r = texts(right, format), c = texts(phi, format);
  if (format == Format::latex) {
    std::printf("%% %s: %s, %s\n\\begin{align}\n", model.title.c_str(), f.title, f.equation);
    for (std::size_t a = 0; a < l.size(); ++a) std::printf("%s &= %s%s\n", l[a].c_str(), r[a].c_str(), a + 1 < l.size() + c.size() ? " \\\\" : "");
    for (std::size_t k = 0; k < c.size(); ++k) std::printf("%s &= 0%s\n", c[k].c_str(), k + 1 < c.size() ? " \\\\" : "");
    std::printf("\\end{align}\n");
    return kOk;
  }
  if (format == Format::mathml) {
    const auto write = [](const std::string& left_side, const std::string& right_side) {
      std::printf("<mtr><mtd>%s</mtd><mtd><mo>=</mo></mtd><mtd>%s</mtd></mtr>\n", left_side.c_str(), right_side.c_str());
    };
    std::printf("<math xmlns=\"http://www.w3.org/1998/Math/MathML\" display=\"block\">\n<mtable displaystyle=\"true\" columnalign=\"right center left\">\n");
    for (std::size_t a = 0; a < l.size(); ++a) write(l[a], r[a]);
    for (const std::string& phi_k : c) write(phi_k, "<mn>0</mn>");
    std::printf("</mtable>\n</math>\n");
    return kOk;
  }
  std::printf("%s\n%s, %s of %s\n\n", model.title.c_str(), f.title, f.equation, f.source);
  for (std::size_t a = 0; a < l.size(); ++a) std::printf("%s:  %s = %s\n", labels[a].c_str(), l[a].c_str(), r[a].c_str());
  for (std::size_t k = 0; k < c.size(); ++k) std::printf("%s:  %s = 0\n", model.constraints[k].name.c_str(), c[k].c_str());
  if (!model.masses.empty()) std::printf("\nwith\n");
  for (std::size_t i = 0; i < model.masses.size(); ++i) {
    SymbolNames plain = model.names;
    plain.defined.erase(model.masses[i].value.id);
    std::printf("  %s = %s\n", names.masses[i].c_str(), print(model.masses[i].value, plain, Format::text).c_str());
  }
  for (const std::string& n : model.notes) std::printf("note: %s\n", n.c_str());
  return kOk;
}

}  // namespace anholon::cli
