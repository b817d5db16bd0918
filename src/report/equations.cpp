#include "report/equations.h"

#include <algorithm>

#include "base/json.h"
#include "expr/arrange.h"
#include "expr/normal.h"

namespace anholon {

namespace {

class Derive {
 public:
  Derive(const Mechanics& m, const Formulation& form, const Elimination& e, Arranger& arranger) : m_(m), e_(e), arranger_(arranger) {
    d_.form = &form;
    d_.model = m.model;
    d_.names = m.model->names;
    for (std::size_t i = 0; i < m.model->masses.size(); ++i) {
      // After the last differentiation a mass stands under its own name again, if it has one.
      const auto named = d_.names.defined.find(m.model->masses[i].value.id);
      d_.names.masses[i] = named == d_.names.defined.end() ? "m_" + m.model->masses[i].name : named->second;
    }
    if (e.quasi) {
      d_.names.quasi = e.names;
      // The quasi-velocities are symbols of the equations, no abbreviations in them.
      for (const QuasiVelocity& u : m.model->quasi) d_.names.defined.erase(u.value.id);
    }
  }

  Derivation run(bool steps) {
    const Equations q = d_.form->equations(m_, e_);
    if (steps) {
      energies();
      forces();
      constraints();
      if (d_.form->eliminates()) elimination();
    }
    const bool all = q.left.size() == m_.q.size();
    for (std::size_t a = 0; a < q.left.size(); ++a)
      d_.equations.push_back({all ? d_.model->coordinates[a].name : e_.names[a], arranged(q.left[a]), arranged(q.right[a])});
    for (std::size_t r = 0; r < m_.phi.size(); ++r)
      d_.constraints.push_back({d_.model->constraints[r].name, arranged(m_.phi[r]), m_.graph().zero()});
    if (arranger_.in_parts(m_.q.size())) in_parts();
    return std::move(d_);
  }

 private:
  Expr arranged(Expr e) { return arranger_.in_parts(m_.q.size()) ? e : arranger_(e, d_.names); }

  void in_parts() {
    Column all;
    const auto add_all = [&](const std::vector<Line>& lines) {
      for (const Line& l : lines) {
        if (l.left) all.push_back(*l.left);
        all.push_back(l.right);
      }
    };
    for (const auto& [heading, lines] : d_.steps) add_all(lines);
    add_all(d_.equations);
    add_all(d_.constraints);
    d_.parts = name_parts(all, d_.names);
  }

  std::string text(Expr e) const { return print(e, d_.names, Format::text); }

  void add(std::vector<Line>& lines, const std::string& name, Expr e) {
    if (!is_zero(e)) lines.push_back({name, std::nullopt, arranged(e)});
  }

  void column(std::vector<Line>& lines, const std::string& name, const Column& c) {
    for (std::size_t a = 0; a < c.size(); ++a) add(lines, name + "." + d_.model->coordinates[a].name, c[a]);
  }

  void energies() {
    std::vector<Line> lines;
    add(lines, "T", m_.T);
    add(lines, "S", m_.S);
    add(lines, "V_O", m_.V_O);
    add(lines, "V_omega", m_.V_omega);
    d_.steps.push_back({"kinetic energy, energy of accelerations, potentials of the moving observer (masses frozen)", lines});
  }

  void forces() {
    std::vector<Line> lines;
    column(lines, "Q", m_.Q);
    column(lines, "QR", m_.QR);
    column(lines, "QD", m_.QD);
    column(lines, "Qomega", m_.Qomega);
    column(lines, "-dV_O", m_.minus_dVO);
    column(lines, "-dV_omega", m_.minus_dVomega);
    column(lines, "Gamma", m_.Gamma);
    if (!lines.empty()) d_.steps.push_back({"generalized forces: given, reactive, of the moving observer", lines});
  }

  void constraints() {
    if (m_.phi.empty()) return;
    std::vector<Line> lines;
    for (std::size_t r = 0; r < m_.phi.size(); ++r) {
      const std::string& name = d_.model->constraints[r].name;
      add(lines, "phi." + name, m_.phi[r]);
      for (std::size_t a = 0; a < m_.q.size(); ++a)
        if (!is_zero(m_.Phi[r][a]))
          add(lines, "d phi." + name + "/d " + text(m_.graph().jet(static_cast<std::uint32_t>(a), static_cast<std::uint32_t>(m_.order[r]))), m_.Phi[r][a]);
    }
    if (!d_.form->eliminates()) column(lines, "N", m_.N);
    d_.steps.push_back({"constraints and their derivatives by the highest ones", lines});
  }

  // A quasi-velocity of lower order than the constraints is lifted: its derivative is what stays free.
  std::string free_name(std::size_t a) const {
    for (const QuasiVelocity& u : d_.model->quasi)
      if (u.name == e_.names[a]) return derivative_name(u.name, e_.m - static_cast<unsigned>(u.order), Format::text);
    return e_.names[a];
  }

  void elimination() {
    std::vector<Line> lines;
    const Column top = jets(*d_.model, e_.m), next = jets(*d_.model, e_.m + 1);
    if (e_.quasi)
      for (std::size_t a = 0; a < e_.names.size(); ++a) lines.push_back({free_name(a), std::nullopt, arranged(e_.w[a])});
    for (std::size_t s = 0; s < top.size(); ++s) {
      if (!e_.solved || e_.g[s] == top[s]) continue;
      lines.push_back({text(top[s]), std::nullopt, arranged(e_.g[s])});
      lines.push_back({text(next[s]), std::nullopt, arranged(e_.on(next[s]))});
    }
    for (std::size_t s = 0; s < top.size(); ++s)
      for (std::size_t a = 0; a < e_.names.size(); ++a) {
        const bool trivial = !e_.quasi && std::find(e_.dependent.begin(), e_.dependent.end(), s) == e_.dependent.end();
        if (!trivial) add(lines, "d " + text(top[s]) + "/d " + (e_.quasi ? free_name(a) : text(e_.u[a])), e_.g_by_u()[s][a]);
      }
    std::string heading = e_.constraints.empty() ? "no constraints: nothing is eliminated" : "elimination of ";
    for (std::size_t k = 0; k < e_.dependent.size(); ++k) heading += (k ? ", " : "") + d_.model->coordinates[e_.dependent[k]].name;
    if (!e_.constraints.empty() && !e_.solved)
      heading += ": the constraints are not solved, " + std::string(e_.dependent.size() > 1 ? "these derivatives stand" : "its derivative stands") +
                 " for the value on the manifold";
    d_.steps.push_back({heading, lines});
    std::vector<Line> reduced;
    const Expr T = total_derivative(m_.T, e_.m - 1);
    add(reduced, e_.m == 1 ? "T~" : "T~^(" + std::to_string(e_.m - 1) + ")", e_.on(T));
    const Column G = e_.contract(anholon::forces(m_));
    for (std::size_t a = 0; a < G.size(); ++a) add(reduced, "G." + e_.names[a], G[a]);
    d_.steps.push_back({"on the manifold of the constraints: kinetic energy, forces along it", reduced});
  }

  const Mechanics& m_;
  const Elimination& e_;
  Arranger& arranger_;
  Derivation d_;
};

// What the masses are, under the names they have in the equations.
std::vector<std::pair<std::string, Expr>> masses(const Derivation& d) {
  std::vector<std::pair<std::string, Expr>> list;
  for (std::size_t i = 0; i < d.model->masses.size(); ++i) list.push_back({d.names.masses[i], d.model->masses[i].value});
  return list;
}

std::string mass_text(const Derivation& d, std::size_t i, Format format) {
  SymbolNames plain = d.model->names;
  plain.defined.erase(d.model->masses[i].value.id);
  return print(d.model->masses[i].value, plain, format);
}

// Both sides of lines, all in one go.
struct Sides {
  std::vector<std::string> left, right;  // the left sides where there are any
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

// The named parts: their names and what they are.
std::vector<std::pair<std::string, std::string>> parts(const Derivation& d, Format format) {
  std::vector<std::pair<std::string, std::string>> list;
  const std::vector<std::string> texts = print_contents(d.parts, d.names, format);
  for (std::size_t i = 0; i < d.parts.size(); ++i) {
    const std::string& name = d.names.defined.at(d.parts[i].id);
    list.push_back({format == Format::latex ? latex_name(name) : format == Format::mathml ? mathml_name(name) : name, texts[i]});
  }
  return list;
}

}  // namespace

// Equations of so many coordinates nobody reads: written out they grow with the square of their number.
constexpr std::size_t kManyCoordinates = 24;

bool Arranger::in_parts(std::size_t coordinates) const { return expand_ == "parts" || (expand_ == "auto" && coordinates > kManyCoordinates); }

Expr Arranger::operator()(Expr e, const SymbolNames& names) {
  if (expand_ == "none") return e;
  if (const auto it = known_.find(e.id); it != known_.end()) return it->second;
  Expr out = e;
  const std::optional<NormalForm> form = written_out(e);
  const std::optional<Expr> full = form ? expression(*form) : std::nullopt;
  if (expand_ == "full") {
    out = full.value_or(e);
  } else if (!full) {
    out = arranged(e, names, form);
  } else if (const auto it = of_written_out_.find(full->id); it != of_written_out_.end()) {
    out = it->second;
  } else {
    out = arranged(e, names, form);
    of_written_out_.emplace(full->id, out);
  }
  known_.emplace(e.id, out);
  return out;
}

Derivation derivation(const Mechanics& m, const Formulation& form, const Elimination& e, Arranger& arranger, bool steps) {
  return Derive(m, form, e, arranger).run(steps);
}

std::string as_text(const std::vector<Derivation>& list) {
  std::string out = shown(list[0].model->title) + "\n";
  for (const Derivation& d : list) {
    out += (list.size() > 1 ? "\n" : "") + std::string(d.form->title) + ", " + citation(*d.form) + "\n\n";
    for (const auto& [heading, lines] : d.steps) {
      out += heading + "\n";
      const Sides s = printed(d, lines, Format::text);
      for (std::size_t i = 0; i < lines.size(); ++i) out += "  " + lines[i].name + " = " + s.right[i] + "\n";
      out += "\n";
    }
    const Sides e = printed(d, d.equations, Format::text), c = printed(d, d.constraints, Format::text);
    for (std::size_t i = 0; i < d.equations.size(); ++i) out += d.equations[i].name + ":  " + e.left[i] + " = " + e.right[i] + "\n";
    for (std::size_t i = 0; i < d.constraints.size(); ++i) out += d.constraints[i].name + ":  " + c.left[i] + " = 0\n";
    if (!d.parts.empty()) out += "\nwith the parts\n";
    for (const auto& [name, text] : parts(d, Format::text)) out += "  " + name + " = " + text + "\n";
  }
  const auto with = masses(list[0]);
  if (!with.empty()) out += "\nwith\n";
  for (std::size_t i = 0; i < with.size(); ++i) out += "  " + with[i].first + " = " + mass_text(list[0], i, Format::text) + "\n";
  for (const std::string& n : list[0].model->notes) out += "note: " + n + "\n";
  return out;
}

std::string as_latex(const std::vector<Derivation>& list) {
  std::string out;
  const auto align = [&](const std::vector<std::string>& rows) {
    out += "\\begin{align}\n";
    for (std::size_t i = 0; i < rows.size(); ++i) out += rows[i] + (i + 1 < rows.size() ? " \\\\\n" : "\n");
    out += "\\end{align}\n";
  };
  for (const Derivation& d : list) {
    out += "% " + shown(d.model->title) + ": " + d.form->title + ", " + citation(*d.form) + "\n";
    for (const auto& [heading, lines] : d.steps) {
      out += "% " + heading + "\n";
      std::vector<std::string> rows;
      const Sides s = printed(d, lines, Format::latex);
      for (std::size_t i = 0; i < lines.size(); ++i) rows.push_back("\\text{" + lines[i].name + "} &= " + s.right[i]);
      if (!rows.empty()) align(rows);
    }
    std::vector<std::string> rows;
    const Sides e = printed(d, d.equations, Format::latex), c = printed(d, d.constraints, Format::latex);
    for (std::size_t i = 0; i < d.equations.size(); ++i) rows.push_back(e.left[i] + " &= " + e.right[i]);
    for (const std::string& left : c.left) rows.push_back(left + " &= 0");
    for (const auto& [name, text] : parts(d, Format::latex)) rows.push_back(name + " &= " + text);
    align(rows);
  }
  return out;
}

std::string as_mathml(const std::vector<Derivation>& list) {
  std::string out;
  const auto table = [&](const std::vector<std::pair<std::string, std::string>>& rows) {
    out += "<math xmlns=\"http://www.w3.org/1998/Math/MathML\" display=\"block\">\n<mtable displaystyle=\"true\" columnalign=\"right center left\">\n";
    for (const auto& [left, right] : rows) out += "<mtr><mtd>" + left + "</mtd><mtd><mo>=</mo></mtd><mtd>" + right + "</mtd></mtr>\n";
    out += "</mtable>\n</math>\n";
  };
  for (const Derivation& d : list) {
    for (const auto& [heading, lines] : d.steps) {
      std::vector<std::pair<std::string, std::string>> rows;
      const Sides s = printed(d, lines, Format::mathml);
      for (std::size_t i = 0; i < lines.size(); ++i) rows.push_back({"<mtext>" + lines[i].name + "</mtext>", s.right[i]});
      if (!rows.empty()) table(rows);
    }
    std::vector<std::pair<std::string, std::string>> rows;
    const Sides e = printed(d, d.equations, Format::mathml), c = printed(d, d.constraints, Format::mathml);
    for (std::size_t i = 0; i < d.equations.size(); ++i) rows.push_back({e.left[i], e.right[i]});
    for (const std::string& left : c.left) rows.push_back({left, "<mn>0</mn>"});
    for (const auto& [name, text] : parts(d, Format::mathml)) rows.push_back({name, text});
    table(rows);
  }
  return out;
}

std::string as_json(const std::vector<Derivation>& list, bool as_list) {
  JsonWriter j;
  if (as_list) j.open_object().key("model").string(list[0].model->title).key("forms").open_array();
  for (const Derivation& d : list) {
    j.open_object().key("model").string(d.model->title).key("form").string(d.form->name).key("title").string(d.form->title);
    j.key("equation").string(d.form->equation).key("source").string(d.form->source);
    if (!d.steps.empty()) {
      j.key("steps").open_array();
      for (const auto& [heading, lines] : d.steps) {
        j.open_object().key("heading").string(heading).key("lines").open_array();
        const Sides text = printed(d, lines, Format::text), latex = printed(d, lines, Format::latex);
        for (std::size_t i = 0; i < lines.size(); ++i)
          j.open_object().key("name").string(lines[i].name).key("text").string(text.right[i]).key("latex").string(latex.right[i]).close();
        j.close().close();
      }
      j.close();
    }
    for (const auto& [key, lines] : {std::pair{"equations", &d.equations}, {"constraints", &d.constraints}}) {
      j.key(key).open_array();
      const Sides text = printed(d, *lines, Format::text), latex = printed(d, *lines, Format::latex);
      for (std::size_t i = 0; i < lines->size(); ++i) {
        j.open_object().key("name").string((*lines)[i].name).key("left").string(text.left[i]).key("right").string(text.right[i]);
        j.key("latex").string(latex.left[i] + " = " + latex.right[i]).close();
      }
      j.close();
    }
    if (!d.parts.empty()) {
      const auto latex = parts(d, Format::latex);
      j.key("parts").open_array();
      for (std::size_t i = 0; const auto& [name, text] : parts(d, Format::text)) {
        j.open_object().key("name").string(name).key("text").string(text).key("latex").string(latex[i].first + " = " + latex[i].second).close();
        ++i;
      }
      j.close();
    }
    j.key("masses").open_object();
    for (std::size_t i = 0; i < d.model->masses.size(); ++i) j.key(d.names.masses[i]).string(mass_text(d, i, Format::text));
    j.close().close();
  }
  if (as_list) j.close().close();
  return j.text() + "\n";
}

}  // namespace anholon
