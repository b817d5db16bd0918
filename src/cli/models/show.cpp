#include "cli/models/show.h"

#include <cmath>
#include <cstdio>

#include "base/json.h"
#include "cli/say.h"
#include "motion/form_choice.h"
#include "structure/blocks.h"

namespace anholon::cli {

static void column(const char* name, const Column& c, const Scenario& s) {
  const std::vector<std::string> texts = print(c, s.model->names, Format::text);
  for (std::size_t a = 0; a < texts.size(); ++a)
    if (texts[a] != "0") say(stdout, "%s.%s = %s\n", name, s.model->coordinates[a].name.c_str(), texts[a].c_str());
}

static void show_mechanics(const Scenario& s) {
  const Mechanics& m = *s.mechanics;
  const SymbolNames& names = s.model->names;
  const auto one = [&](const char* name, Expr e) {
    say(stdout, "%s = %s\n", name, print(e, names, Format::text).c_str());
  };
  for (std::size_t i = 0; i < s.model->masses.size(); ++i)
    say(stdout, "%s = %s    (frozen in what follows)\n", names.masses[i].c_str(),
        print(s.model->masses[i].value, names, Format::text).c_str());
  one("T", m.T);
  one("S", m.S);
  one("V_O", m.V_O);
  one("V_omega", m.V_omega);
  column("Q", m.Q, s);
  column("QR", m.QR, s);
  if (!s.model->dissipation.empty()) column("QD", m.QD, s);
  column("Qomega", m.Qomega, s);
  column("-dV_O", m.minus_dVO, s);
  column("-dV_omega", m.minus_dVomega, s);
  column("Gamma", m.Gamma, s);
  for (std::size_t r = 0; r < m.phi.size(); ++r) {
    const std::string& name = s.model->constraints[r].name;
    one(("phi." + name).c_str(), m.phi[r]);
    column(("Phi." + name).c_str(), m.Phi[r], s);
  }
  column("N", m.N, s);
}

int show(const SystemCommand& o, const Scenario& s, const Outcome& outcome) {
  // A system that does not determine its motion has no structure and no program.
  if ((o.show == "structure" || o.show == "program") && s.structure.transversal.empty() && !outcome.ok()) {
    print_outcome(outcome);
    return kStopped;
  }
  if (o.show == "mechanics") {
    show_mechanics(s);
  } else if (o.show == "system") {
    const std::vector<std::string> texts = print(s.system.equations, s.model->names, Format::text);
    for (std::size_t i = 0; i < texts.size(); ++i)
      say(stdout, "%s: %s = 0\n", s.system.equation_names[i].c_str(), texts[i].c_str());
  } else if (o.show == "structure") {
    hand_out(print(s.system, s.structure));
    if (const std::vector<Block> list = blocks(s.structure); list.size() > 1)
      hand_out("\n" + print(s.system, s.structure, list));
  } else if (o.show == "program") {
    hand_out(print(program(s.system, s.structure)));
  } else {
    throw UsageError{"error: --show: there is no stage '" + o.show +
                     "'\nhint: mechanics, system, structure, program; of check also cost\n"};
  }
  return kOk;
}

static void cost_json(const FormChoice& c) {
  JsonWriter j;
  j.open_object().key("forms").open_array();
  for (const FormCost& f : c.costs) {
    j.open_object().key("form").string(f.form->name);
    if (f.writings.empty()) j.key("reason").string(f.why);
    j.key("writings").open_array();
    for (const WritingCost& w : f.writings) {
      j.open_object()
          .key("writing")
          .string(name(w.writing))
          .key("products")
          .integer(static_cast<long long>(w.work.products));
      j.key("sums")
          .integer(static_cast<long long>(w.work.sums))
          .key("solve")
          .integer(static_cast<long long>(w.work.solve));
      j.key("operations").number(number_text(std::round(w.work.operations))).key("waits").integer(w.work.waits);
      j.key("cost").number(number_text(std::round(w.work.total))).key("after_steps");
      w.after ? j.integer(static_cast<long long>(*w.after)) : j.null();
      if (!w.velocities.empty()) {
        j.key("velocities").open_array();
        for (const std::string& p : w.velocities) j.string(p);
        j.close();
      }
      j.close();
    }
    j.close().close();
  }
  j.close().key("auto").string(c.form->name).key("reason").string(c.why).close();
  hand_out(j.text() + "\n");
}

int show_cost(const SystemCommand& o, const Reader& in) {
  const FormChoice c = choose_form(in.model, state_choice(o, *in.model), Costs::all);
  if (o.json) return cost_json(c), kOk;
  say(stdout, "one expansion at tolerance 1e-12\n\n");
  say(stdout, "%-8s  %-9s  %8s  %6s  %6s  %10s  %5s  %8s  taken\n", "form", "writing", "products", "sums", "solve",
      "operations", "waits", "cost");
  for (const FormCost& f : c.costs) {
    if (f.writings.empty()) say(stdout, "%-8s  no kernel: %s\n", f.form->name, f.why.c_str());
    for (const WritingCost& w : f.writings) {
      const std::string taken = !w.after        ? ""
                                : *w.after == 0 ? "at once"
                                                : "after " + std::to_string(*w.after) + " steps";
      say(stdout, "%-8s  %-9s  %8zu  %6zu  %6zu  %10.0f  %5d  %8.0f%s%s\n", f.form->name, name(w.writing),
          w.work.products, w.work.sums, w.work.solve, w.work.operations, w.work.waits, w.work.total,
          taken.empty() ? "" : "  ", taken.c_str());
    }
  }
  say(stdout,
      "\nwaits: of a stage, one operation after the other; cost: operations, and for each stage five for each wait\n");
  for (const FormCost& f : c.costs)
    for (const WritingCost& w : f.writings) {
      if (w.velocities.empty()) continue;
      say(stdout, "quasi: in velocities that make the kinetic energy a sum of squares,\n");
      for (std::size_t i = 0; i < w.velocities.size(); ++i)
        say(stdout, "  p%zu = %s\n", i + 1, w.velocities[i].c_str());
    }
  say(stdout, "--form auto takes %s: %s\n", c.form->name, c.why.c_str());
  return kOk;
}

}  // namespace anholon::cli
