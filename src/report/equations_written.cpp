// Derivations in the output formats.
#include <algorithm>

#include "base/escape.h"
#include "base/json.h"
#include "report/equations.h"
#include "report/math_lines.h"

namespace anholon {

namespace {

// The formula of a mass under its name in the equations.
std::string mass_text(const Derivation& d, std::size_t i, Format format) {
  SymbolNames plain = d.model->names;
  plain.defined.erase(d.model->masses[i].value.id);
  return print(d.model->masses[i].value, plain, format);
}

std::string with_order(const Derivation& d) { return d.m ? ", taken with m = " + std::to_string(d.m) : ""; }

// Both sides of lines, printed in one call.
struct Sides {
  std::vector<std::string> left, right;  // the left sides, if there are any
};
Sides printed(const Derivation& d, const std::vector<Line>& lines, Format format) {
  Column left, right;
  for (const Line& l : lines) {
    if (l.left) left.push_back(*l.left);
    right.push_back(l.right);
  }
  Sides s;
  if (!left.empty()) s.left = print(left, d.names, format);
  if (!right.empty()) s.right = print(right, d.names, format);
  return s;
}

// True if a line contains the symbol of a mass.
bool holds(const Derivation& d, std::size_t mass) {
  Column all;
  const auto add = [&](const std::vector<Line>& lines) {
    for (const Line& l : lines) {
      if (l.left) all.push_back(*l.left);
      all.push_back(l.right);
    }
  };
  for (const auto* sections : {&d.steps, &d.reactions})
    for (const Section& s : *sections) add(s.second);
  for (const auto* lines : {&d.equations, &d.constraints, &d.rates}) add(*lines);
  const std::vector<NodeId> in = symbols(all);
  return std::binary_search(in.begin(), in.end(), d.model->graph->mass(static_cast<std::uint32_t>(mass)).id);
}

// The varying masses whose formula is not their name, and the second moments that are still in the equations.
std::vector<std::pair<std::string, std::string>> masses(const Derivation& d, Format format) {
  std::vector<std::pair<std::string, std::string>> list;
  for (std::size_t i = 0; i < d.model->masses.size(); ++i) {
    const std::string& name = d.names.masses[i];
    if (name == mass_text(d, i, Format::text) || (d.model->masses[i].weight && !holds(d, i))) continue;
    list.push_back(
        {print(d.model->graph->mass(static_cast<std::uint32_t>(i)), d.names, format), mass_text(d, i, format)});
  }
  return list;
}

// The named parts: names and formulas.
std::vector<std::pair<std::string, std::string>> parts(const Derivation& d, Format format) {
  std::vector<std::pair<std::string, std::string>> list;
  const std::vector<std::string> texts = print_contents(d.parts, d.names, format);
  for (std::size_t i = 0; i < d.parts.size(); ++i) {
    const std::string& name = d.names.defined.at(d.parts[i].id);
    list.push_back({format == Format::latex    ? latex_name(name)
                    : format == Format::mathml ? mathml_name(name)
                                               : name,
                    texts[i]});
  }
  return list;
}

// "Q.x" and "Q.y", "d T/d x" and "d T/d y" belong together.
std::string family(const std::string& name) {
  const std::size_t dot = name.rfind('.'), by = name.rfind("/d ");
  if (by != std::string::npos && (dot == std::string::npos || by > dot)) return name.substr(0, by + 1);
  return dot == std::string::npos ? name : name.substr(0, dot);
}

std::string label(const Line& l, Format format) {
  switch (format) {
  case Format::text:
    return l.name;
  case Format::latex:
    return l.latex.empty() ? "\\text{" + latex_escape(l.name) + "}" : l.latex;
  case Format::mathml:
    return l.mathml.empty() ? "<mtext>" + markup_escape(l.name) + "</mtext>" : l.mathml;
  }
  return l.name;
}

using Table = std::vector<std::pair<std::string, std::string>>;  // left and right sides

// Lines as pairs of sides, with the name as the left side if there is no other.
Table rows(const Derivation& d, const std::vector<Line>& of, Format format) {
  const std::vector<Line> lines = joined(of);
  const Sides s = printed(d, lines, format);
  Table out;
  for (std::size_t i = 0; i < lines.size(); ++i) out.push_back({label(lines[i], format), s.right[i]});
  return out;
}

// The tables of a derivation in MathML: steps, equations with what belongs to them, reactions.
std::vector<Table> tables(const Derivation& d) {
  std::vector<Table> out;
  const auto add_sections = [&](const std::vector<Section>& sections) {
    for (const Section& s : sections)
      if (!s.second.empty()) out.push_back(rows(d, s.second, Format::mathml));
  };
  add_sections(d.steps);
  Table list;
  const Sides e = printed(d, d.equations, Format::mathml), c = printed(d, d.constraints, Format::mathml);
  for (std::size_t i = 0; i < d.equations.size(); ++i) list.push_back({e.left[i], e.right[i]});
  for (const std::string& left : c.left) list.push_back({left, "<mn>0</mn>"});
  const Sides r = printed(d, d.rates, Format::mathml);
  for (std::size_t i = 0; i < r.left.size(); ++i) list.push_back({r.left[i], r.right[i]});
  for (const auto& [name, text] : parts(d, Format::mathml)) list.push_back({name, text});
  for (const auto& [name, text] : masses(d, Format::mathml)) list.push_back({name, text});
  out.push_back(std::move(list));
  add_sections(d.reactions);
  return out;
}

void write_strings(JsonWriter& j, const char* key, const std::vector<std::string>& list) {
  if (list.empty()) return;
  j.key(key).open_array();
  for (const std::string& s : list) j.string(s);
  j.close();
}

}  // namespace

std::vector<Line> joined(const std::vector<Line>& lines) {
  std::vector<Line> out;
  for (std::size_t i = 0; i < lines.size(); ++i) {
    const bool goes_on = i > 0 && is_zero(lines[i].right) && is_zero(lines[i - 1].right) &&
                         family(lines[i].name) == family(lines[i - 1].name);
    if (!goes_on) {
      out.push_back(lines[i]);
      continue;
    }
    Line& together = out.back();
    together = {together.name + " = " + lines[i].name, together.left, together.right,
                label(together, Format::latex) + " = " + label(lines[i], Format::latex),
                label(together, Format::mathml) + "<mo>=</mo>" + label(lines[i], Format::mathml)};
  }
  return out;
}

std::string as_text(const std::vector<Derivation>& list) {
  const std::string& title = list[0].model->title;
  std::string out = title.empty() ? std::string() : shown(title) + "\n";
  for (const Derivation& d : list) {
    out += (list.size() > 1 && !out.empty() ? "\n" : "") + std::string(d.form->title) + ", " + citation(*d.form) +
           with_order(d) + "\n\n";
    const auto section = [&](const Section& s) {
      out += s.first + "\n";
      for (const auto& [left, right] : rows(d, s.second, Format::text)) out += "  " + left + " = " + right + "\n";
    };
    for (const Section& s : d.steps) section(s), out += "\n";
    const Sides e = printed(d, d.equations, Format::text), c = printed(d, d.constraints, Format::text);
    for (std::size_t i = 0; i < d.equations.size(); ++i)
      out += d.equations[i].name + ":  " + e.left[i] + " = " + e.right[i] + "\n";
    for (std::size_t i = 0; i < d.constraints.size(); ++i) out += d.constraints[i].name + ":  " + c.left[i] + " = 0\n";
    const Sides r = printed(d, d.rates, Format::text);
    for (std::size_t i = 0; i < d.rates.size(); ++i)
      out += d.rates[i].name + ":  " + r.left[i] + " = " + r.right[i] + "\n";
    for (const Section& s : d.reactions) out += "\n", section(s);
    if (!d.parts.empty()) out += "\nwith the parts\n";
    for (const auto& [name, text] : parts(d, Format::text)) out += "  " + name + " = " + text + "\n";
    for (const std::string& n : d.notes) out += "note: " + n + "\n";
  }
  std::string with;
  for (const auto& [name, text] : masses(list[0], Format::text)) with += "  " + name + " = " + text + "\n";
  if (!with.empty()) out += "\nwith\n" + with;
  for (const ModelNote& n : list[0].model->notes) out += "note: " + n.text + "\n";
  return out;
}

std::string as_latex(const std::vector<Derivation>& all) {
  std::string out;
  const auto align = [&](const std::vector<std::string>& lines) {
    out += "\\begin{align}\n";
    for (std::size_t i = 0; i < lines.size(); ++i) out += lines[i] + (i + 1 < lines.size() ? " \\\\\n" : "\n");
    out += "\\end{align}\n";
  };
  for (const Derivation& d : all) {
    out += "% " + (d.model->title.empty() ? std::string() : shown(d.model->title) + ": ") + d.form->title + ", " +
           citation(*d.form) + with_order(d) + "\n";
    const auto section = [&](const Section& s) {
      out += "% " + s.first + "\n";
      std::vector<std::string> list;
      for (const auto& [left, right] : rows(d, s.second, Format::latex)) list.push_back(left + " &= " + right);
      if (!list.empty()) align(list);
    };
    for (const Section& s : d.steps) section(s);
    std::vector<std::string> list;
    const Sides e = printed(d, d.equations, Format::latex), c = printed(d, d.constraints, Format::latex);
    for (std::size_t i = 0; i < d.equations.size(); ++i) list.push_back(e.left[i] + " &= " + e.right[i]);
    for (const std::string& left : c.left) list.push_back(left + " &= 0");
    const Sides r = printed(d, d.rates, Format::latex);
    for (std::size_t i = 0; i < r.left.size(); ++i) list.push_back(r.left[i] + " &= " + r.right[i]);
    for (const auto& [name, text] : parts(d, Format::latex)) list.push_back(name + " &= " + text);
    for (const auto& [name, text] : masses(d, Format::latex)) list.push_back(name + " &= " + text);
    align(list);
    for (const Section& s : d.reactions) section(s);
  }
  return out;
}

std::string as_mathml(const std::vector<Derivation>& all) {
  std::string out;
  for (const Derivation& d : all)
    for (const Table& table : tables(d)) {
      // MathML Core has no columnalign; readers of MathML 3 have no style. Chromium aligns formulas, which are blocks,
      // by -webkit-right.
      out += "<math xmlns=\"http://www.w3.org/1998/Math/MathML\" display=\"block\">\n<mtable displaystyle=\"true\" "
             "columnalign=\"right center left\">\n";
      for (const auto& [left, right] : table)
        out += "<mtr><mtd style=\"text-align:right;text-align:-webkit-right\">" + left + "</mtd><mtd><mo>=</mo></mtd>" +
               "<mtd style=\"text-align:left\">" + right + "</mtd></mtr>\n";
      out += "</mtable>\n</math>\n";
    }
  return out;
}

std::string as_html(const std::vector<Derivation>& all) {
  std::string out;
  for (const Derivation& d : all)
    for (const Table& table : tables(d)) {
      out += "<div style=\"overflow-x:auto;margin:.5em 0;text-align:left\">\n";
      for (const auto& [left, right] : table)
        out += "<div style=\"line-height:2.3;padding-left:2em;text-indent:-2em\">" + wrapping_math(left) +
               " <math><mo form=\"infix\" lspace=\"0\" rspace=\"0\">=</mo></math> " + wrapping_math(right) + "</div>\n";
      out += "</div>\n";
    }
  return out;
}

std::string as_json(const std::vector<Derivation>& list, bool as_list) {
  JsonWriter j;
  if (as_list) j.open_object().key("model").string(list[0].model->title).key("forms").open_array();
  for (const Derivation& d : list) {
    j.open_object()
        .key("model")
        .string(d.model->title)
        .key("form")
        .string(d.form->name)
        .key("title")
        .string(d.form->title);
    j.key("equation").string(d.form->equation).key("source").string(d.form->source);
    if (d.m) j.key("m").integer(d.m);
    const auto sections = [&](const char* key, const std::vector<Section>& list_of) {
      if (list_of.empty()) return;
      j.key(key).open_array();
      for (const auto& [heading, lines] : list_of) {
        j.open_object().key("heading").string(heading).key("lines").open_array();
        const Sides text = printed(d, lines, Format::text), latex = printed(d, lines, Format::latex);
        for (std::size_t i = 0; i < lines.size(); ++i) {
          j.open_object()
              .key("name")
              .string(lines[i].name)
              .key("text")
              .string(text.right[i])
              .key("latex")
              .string(latex.right[i]);
          j.key("latex_name").string(label(lines[i], Format::latex)).close();
        }
        j.close().close();
      }
      j.close();
    };
    sections("steps", d.steps);
    for (const auto& [key, lines] :
         {std::pair{"equations", &d.equations}, {"constraints", &d.constraints}, {"rates", &d.rates}}) {
      if (lines == &d.rates && lines->empty()) continue;
      j.key(key).open_array();
      const Sides text = printed(d, *lines, Format::text), latex = printed(d, *lines, Format::latex);
      for (std::size_t i = 0; i < lines->size(); ++i) {
        j.open_object()
            .key("name")
            .string((*lines)[i].name)
            .key("left")
            .string(text.left[i])
            .key("right")
            .string(text.right[i]);
        j.key("latex").string(latex.left[i] + " = " + latex.right[i]).close();
      }
      j.close();
    }
    sections("reactions", d.reactions);
    if (!d.parts.empty()) {
      const auto latex = parts(d, Format::latex);
      j.key("parts").open_array();
      for (std::size_t i = 0; const auto& [name, text] : parts(d, Format::text)) {
        j.open_object()
            .key("name")
            .string(name)
            .key("text")
            .string(text)
            .key("latex")
            .string(latex[i].first + " = " + latex[i].second)
            .close();
        ++i;
      }
      j.close();
    }
    write_strings(j, "left_out", d.left_out);
    write_strings(j, "notes", d.notes);
    j.key("masses").open_object();
    for (std::size_t i = 0; i < d.model->masses.size(); ++i)
      j.key(d.names.masses[i]).string(mass_text(d, i, Format::text));
    j.close().close();
  }
  if (as_list) j.close().close();
  return j.text() + "\n";
}

}  // namespace anholon
