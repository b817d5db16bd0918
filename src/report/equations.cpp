#include "report/equations.h"

#include <algorithm>

#include "expr/normal.h"
#include "formulation/reactions.h"
#include "mechanics/notes_on_rank.h"
#include "print/arrange.h"
#include "print/print_names.h"

namespace anholon {

namespace {

class Derive {
 public:
  Derive(const Mechanics& m, const Formulation& form, const Elimination& e, Arranger& arranger)
      : m_(m), e_(e), arranger_(arranger) {
    d_.form = &form;
    d_.model = m.model;
    d_.m = form.highest_m ? e.asked : 0;
    d_.names = m.model->names;
    for (std::size_t i = 0; i < m.model->masses.size(); ++i) {
      // After the last differentiation a mass has its own name again, if it has one.
      const Expr value = m.model->masses[i].value;
      const auto named = d_.names.defined.find(value.id);
      d_.names.masses[i] = named != d_.names.defined.end()                ? named->second
                           : m.graph().node(value.id).kind == Kind::given ? print(value, d_.names, Format::text)
                                                                          : mass_name(*m.model, i);
    }
    if (e.quasi) {
      d_.names.quasi = e.free.names;
      // The quasi-velocities are symbols of the equations, not abbreviations in them.
      for (const QuasiVelocity& u : m.model->quasi) d_.names.defined.erase(u.value.id);
    }
  }

  Derivation run(bool steps, const Elimination* of_reactions) {
    if (d_.form->eliminates() || of_reactions)
      d_.notes = notes_on_rank(*d_.model, d_.form->eliminates() ? e_ : *of_reactions);
    for (std::size_t r : e_.left_out) d_.left_out.push_back(d_.model->constraints[r].name);
    const Equations q = d_.form->equations(m_, e_);
    if (steps) {
      forces();
      constraints();
      if (d_.form->eliminates()) elimination();
      quantities();
    }
    const bool all = q.left.size() == m_.q.size();
    for (std::size_t a = 0; a < q.left.size(); ++a)
      d_.equations.push_back(
          {all ? d_.model->coordinates[a].name : e_.free.names[a], finished(q.left[a]), finished(q.right[a])});
    for (std::size_t r = 0; r < m_.phi.size(); ++r)
      d_.constraints.push_back({d_.model->constraints[r].name, arranged(m_.phi[r]), m_.graph().zero()});
    rates();
    if (of_reactions) reactions(*of_reactions);
    if (arranger_.in_parts(m_.q.size())) in_parts();
    return std::move(d_);
  }

 private:
  // Returns a final equation, in which the second moments of bodies have their formulas, because their names are not
  // known to a reader.
  Expr finished(Expr e) {
    Column weights, values;
    for (std::size_t i = 0; i < d_.model->masses.size(); ++i) {
      const VaryingMass& m = d_.model->masses[i];
      if (!m.weight) continue;
      weights.push_back(m_.graph().mass(static_cast<std::uint32_t>(i)));
      values.push_back(m.value);
    }
    return arranged(put(e, weights, values));
  }
  Expr arranged(Expr e) { return arranger_.in_parts(m_.q.size()) ? e : arranger_(e, d_.names); }

  void rates() {
    for (std::size_t i = 0; i < d_.model->states.size(); ++i)
      d_.rates.push_back({d_.model->states[i].name, m_.graph().state(static_cast<std::uint32_t>(i), 1),
                          arranged(put_masses(*d_.model, d_.model->states[i].rate))});
  }

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
    add_all(d_.rates);
    for (const auto& [heading, lines] : d_.reactions) add_all(lines);
    d_.parts = name_parts(all, d_.names);
  }

  // Adds a line even if e is zero.
  void add(std::vector<Line>& lines, const Label& name, Expr e) {
    lines.push_back({name.text, std::nullopt, arranged(e), name.latex, name.mathml});
  }
  void add(std::vector<Line>& lines, const Quantities& list) {
    for (const Quantity& q : list) add(lines, q.name, q.value);
  }
  void add(std::vector<Line>& lines, const Labels& names, const Column& c) { add(lines, named(names, c)); }

  Labels of_coordinates(const Label& of) const {
    Labels out;
    for (const Coordinate& c : d_.model->coordinates) out.push_back(indexed(of, c.name, {name_of(*d_.model, c.name)}));
    return out;
  }

  // The terms -dV/dx, called -dV_O.x in text.
  Labels of_potential(const Label& of, const std::string& text) const {
    Labels out;
    for (const Coordinate& c : d_.model->coordinates) {
      out.push_back(minus(partial(of, name_of(*d_.model, c.name))));
      out.back().text = text + "." + c.name;
    }
    return out;
  }

  void forces() {
    const Label Q = letter("Q");
    const Label omega = letter("omega"),
                omega_rate{"", "\\dot{\\omega}", derivative_name("<mi>ω</mi>", 1, Format::mathml)};
    const Label V_O = with_superscript("V_O", letter("V"), {"", "O'", "<mi>O</mi><mo>′</mo>"}),
                V_omega = with_superscript("V_omega", letter("V"), omega);
    std::vector<Line> lines;
    add(lines, of_coordinates(Q), m_.Q);
    add(lines, of_coordinates(with_superscript("QR", Q, letter("R"))), m_.QR);
    if (!d_.model->dissipation.empty()) add(lines, of_coordinates(with_superscript("QD", Q, letter("D"))), m_.QD);
    add(lines, of_coordinates(with_superscript("Qomega", Q, omega_rate)), m_.Qomega);
    if (!is_zero(m_.V_O)) add(lines, V_O, m_.V_O);
    add(lines, of_potential(V_O, "-dV_O"), m_.minus_dVO);
    if (!is_zero(m_.V_omega)) add(lines, V_omega, m_.V_omega);
    add(lines, of_potential(V_omega, "-dV_omega"), m_.minus_dVomega);
    add(lines, of_coordinates(letter("Gamma")), m_.Gamma);
    d_.steps.push_back({"generalized forces: given, reactive, of the moving observer (masses frozen)", lines});
  }

  void constraints() {
    if (m_.phi.empty()) return;
    std::vector<Line> lines;
    for (std::size_t r = 0; r < m_.phi.size(); ++r) {
      const std::string& name = d_.model->constraints[r].name;
      const Label phi = indexed(letter("phi"), name, {name_of(*d_.model, name)});
      add(lines, phi, m_.phi[r]);
      add(lines, partials({phi}, jet_labels(m_, static_cast<unsigned>(m_.order[r])), {m_.Phi[r]}));
    }
    if (!d_.form->eliminates()) add(lines, of_coordinates(letter("N")), m_.N);
    d_.steps.push_back({"constraints and their derivatives by the highest ones", lines});
  }

  void elimination() {
    std::vector<Line> lines;
    const Column top = jets(*d_.model, e_.m), next = jets(*d_.model, e_.m + 1);
    const Labels top_names = jet_labels(m_, e_.m), next_names = jet_labels(m_, e_.m + 1), free = free_labels(m_, e_);
    // A quasi-velocity of lower order than the constraints is lifted: its derivative is the free quantity.
    if (e_.quasi)
      for (std::size_t a = 0; a < free.size(); ++a) add(lines, free[a], e_.quasi->w[a]);
    for (std::size_t s = 0; s < top.size(); ++s) {
      if (!e_.solved || e_.g()[s] == top[s]) continue;
      add(lines, top_names[s], e_.g()[s]);
      add(lines, next_names[s], e_.on(next[s]));
    }
    Rows by_u = e_.g_by_u();
    for (std::size_t s = 0; s < by_u.size(); ++s)
      if (!e_.quasi && std::find(e_.dependent.begin(), e_.dependent.end(), s) == e_.dependent.end())
        by_u[s].clear();  // trivial
    add(lines, partials(top_names, free, by_u));
    std::string heading = e_.constraints.empty() ? "no constraints: nothing is eliminated" : "elimination of ";
    for (std::size_t k = 0; k < e_.dependent.size(); ++k)
      heading += (k ? ", " : "") + d_.model->coordinates[e_.dependent[k]].name;
    if (e_.m > highest_order(m_) && !e_.constraints.empty())
      heading += ", constraints lifted to order " + std::to_string(e_.m);
    if (!e_.constraints.empty() && !e_.solved)
      heading += ": the constraints are not solved, " +
                 std::string(e_.dependent.size() > 1 ? "these derivatives stand" : "its derivative stands") +
                 " for the value on the manifold";
    d_.steps.push_back({heading, lines});
  }

  void quantities() {
    if (!d_.form->quantities) return;
    std::vector<Line> lines;
    add(lines, d_.form->quantities(m_, e_));
    d_.steps.push_back({"what the equations are made of (masses frozen)", lines});
  }

  void reactions(const Elimination& pivots) {
    const Model& model = *d_.model;
    const ReactionFormulas r = reaction_formulas(m_, *d_.form, pivots);
    if (!m_.phi.empty()) {
      std::vector<Line> lines;
      for (std::size_t k = 0; k < r.multipliers.size(); ++k)
        if (r.multipliers[k].graph) {
          const std::string name = multiplier_name(model, k);
          const Expr lambda = m_.lambda[k];
          add(lines, {name, print(lambda, model.names, Format::latex), print(lambda, model.names, Format::mathml)},
              r.multipliers[k]);
        }
      std::string heading = "multipliers";
      for (std::size_t b = 0; b < pivots.dependent.size(); ++b)
        heading += (b == 0 ? ", from the equations of " : ", ") + model.coordinates[pivots.dependent[b]].name;
      std::string redundant;
      for (std::size_t k = 0; k < m_.phi.size(); ++k)
        if (r.multipliers[k].graph &&
            std::find(pivots.constraints.begin(), pivots.constraints.end(), k) == pivots.constraints.end())
          redundant += (redundant.empty() ? "" : ", ") + multiplier_name(model, k);
      if (!redundant.empty())
        heading += "; a choice, as constraints follow from others: " + redundant + " could have any value";
      d_.reactions.push_back({heading, lines});
    }
    std::vector<Line> lines;
    add(lines, of_coordinates(letter("N")), r.by_multipliers);
    d_.reactions.push_back({"generalized reactions, by the multipliers", lines});
    lines.clear();
    add(lines, of_coordinates(letter("N")), r.by_motion);
    d_.reactions.push_back({"generalized reactions, by the motion: inertia less forces", lines});
    lines.clear();
    for (std::size_t b = 0; b < model.bodies.size(); ++b) {
      const std::string& name = model.bodies[b].name;
      const bool turns = !model.bodies[b].axes.empty();
      for (const bool torque : {false, true})
        for (int i = 0; i < 3 && (turns || !torque); ++i) {
          const std::string axis(1, "xyz"[i]);
          Label of = indexed(letter(torque ? "tau" : "R"), axis, {name_of(model, name), letter(axis)});
          of.text = (torque ? "reaction_torque(" : "reaction(") + name + ")." + axis;  // the call in formulas
          add(lines, of, (torque ? r.loads[b].torque : r.loads[b].force)[i]);
        }
    }
    const bool without_place = !model.potentials.empty() || !model.dissipation.empty() ||
                               std::any_of(model.forces.begin(), model.forces.end(),
                                           [](const Force& f) { return f.kind == Force::Kind::generalized; });
    d_.reactions.push_back(
        {std::string("reactions on the bodies, by Newton's law: force, and torque about the mass centre") +
             (without_place ? "; forces that have no place (potentials, dissipation, generalized) are among them" : ""),
         lines});
  }

  const Mechanics& m_;
  const Elimination& e_;
  Arranger& arranger_;
  Derivation d_;
};

}  // namespace

// Equations of more coordinates are too long to read: expanded, they grow with the square of that number.
constexpr std::size_t kManyCoordinates = 24;

bool Arranger::in_parts(std::size_t coordinates) const {
  return expand_ == "parts" || (expand_ == "auto" && coordinates > kManyCoordinates);
}

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

Derivation derivation(const Mechanics& m, const Formulation& form, const Elimination& e, Arranger& arranger, bool steps,
                      const Elimination* of_reactions) {
  return Derive(m, form, e, arranger).run(steps, of_reactions);
}

}  // namespace anholon
