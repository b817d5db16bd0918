#include <cstdio>

#include "base/json.h"
#include "cli/input.h"
#include "cli/show.h"
#include "expr/arrange.h"
#include "expr/normal.h"

namespace anholon::cli {

namespace {

// As the user wrote it (none), written out (full), or as a person would write it: never longer than these.
Column arranged(const Column& es, const SymbolNames& names, const std::string& expand) {
  if (expand == "none") return es;
  Column out;
  for (Expr e : es) out.push_back(expand == "full" ? expanded(e).value_or(e) : anholon::arranged(e, names));
  return out;
}

}  // namespace

int derive(const Options& o) {
  const Reader in = read(o);
  const Model& model = *in.model;
  if (o.format != "text" && o.format != "latex" && o.format != "mathml")
    throw UsageError{"error: --format: '" + o.format + "' is not written yet\nhint: text, latex or mathml; --json for text and latex\n"};
  if (o.expand != "auto" && o.expand != "none" && o.expand != "paper" && o.expand != "full")
    throw UsageError{"error: --expand: '" + o.expand + "'\nhint: auto, none, paper or full\n"};
  const Mechanics m = mechanics(model);
  const Formulation& f = form(o, model, &m);
  if (!o.show.empty()) {
    Scenario s;
    make_scenario(in.model, f, state_choice(o, model), s);
    return show(o, s);
  }
  const Equations e = f.equations(m);
  SymbolNames names = model.names;
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
    const auto list = [&](const char* key, const Column& l, const Column& r, const std::vector<std::string>& labels) {
      const auto lt = texts(l, Format::text), rt = texts(r, Format::text), ll = texts(l, Format::latex), rl = texts(r, Format::latex);
      j.key(key).open_array();
      for (std::size_t i = 0; i < labels.size(); ++i)
        j.open_object().key("name").string(labels[i]).key("left").string(lt[i]).key("right").string(rt[i]).key("latex").string(ll[i] + " = " + rl[i]).close();
      j.close();
    };
    std::vector<std::string> coordinates, constraints;
    for (const Coordinate& c : model.coordinates) coordinates.push_back(c.name);
    for (const Constraint& c : model.constraints) constraints.push_back(c.name);
    list("equations", left, right, coordinates);
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
  for (std::size_t a = 0; a < l.size(); ++a) std::printf("%s:  %s = %s\n", model.coordinates[a].name.c_str(), l[a].c_str(), r[a].c_str());
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
