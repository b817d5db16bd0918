#include "cli/show.h"

#include <cstdio>

#include "cli/input.h"
#include "structure/blocks.h"

namespace anholon::cli {

static void column(const char* name, const Column& c, const Scenario& s) {
  const std::vector<std::string> texts = print(c, s.model->names, Format::text);
  for (std::size_t a = 0; a < texts.size(); ++a)
    if (texts[a] != "0") std::printf("%s.%s = %s\n", name, s.model->coordinates[a].name.c_str(), texts[a].c_str());
}

static void show_mechanics(const Scenario& s) {
  const Mechanics& m = *s.mechanics;
  const SymbolNames& names = s.model->names;
  const auto one = [&](const char* name, Expr e) { std::printf("%s = %s\n", name, print(e, names, Format::text).c_str()); };
  for (std::size_t i = 0; i < s.model->masses.size(); ++i)
    std::printf("%s = %s    (frozen in what follows)\n", names.masses[i].c_str(), print(s.model->masses[i].value, names, Format::text).c_str());
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

int show(const Options& o, const Scenario& s) {
  if (o.show == "mechanics") {
    show_mechanics(s);
  } else if (o.show == "system") {
    const std::vector<std::string> texts = print(s.system.equations, s.model->names, Format::text);
    for (std::size_t i = 0; i < texts.size(); ++i)
      std::printf("%s: %s = 0\n", s.system.equation_names[i].c_str(), texts[i].c_str());
  } else if (o.show == "structure") {
    std::fputs(print(s.system, s.structure).c_str(), stdout);
    if (const std::vector<Block> list = blocks(s.structure); list.size() > 1) std::printf("\n%s", print(s.system, s.structure, list).c_str());
  } else if (o.show == "program") {
    std::fputs(print(program(s.system, s.structure)).c_str(), stdout);
  } else {
    throw UsageError{"error: --show: there is no stage '" + o.show + "'\nhint: mechanics, system, structure, program\n"};
  }
  return kOk;
}

}  // namespace anholon::cli
