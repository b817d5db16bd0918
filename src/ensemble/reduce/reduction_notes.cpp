#include "ensemble/reduce/reduction_notes.h"

#include "setup/notes_on_multipliers.h"

namespace anholon {

std::vector<std::string> notes_of_formulas(const Scenario& s, const Reductions& reductions) {
  std::vector<NamedFormula> all = formulas_with_multipliers(*s.model);
  for (const Reduction& r : reductions.list) {
    if (r.of_event()) continue;
    const Expr e = r.kind == Reduction::Kind::last ? reductions.ends[r.of] : reductions.formulas[r.of];
    all.push_back({"reduction '" + r.name + "'", e});
  }
  std::vector<std::string> list;
  for (const NamedFormula& f : all)
    if (const std::string text = note_of_formula(*s.model, s.undetermined, s.state, f); !text.empty())
      list.push_back(text);
  return list;
}

}  // namespace anholon
