#include "anholon/equations.h"

#include <algorithm>

#include "api/data.h"
#include "report/equations.h"
#include "setup/eliminate.h"

namespace anholon::v1 {

Result<Equations> derive(const Model& model, const DeriveOptions& options) {
  return guarded(model.data().source, [&]() -> Result<Equations> {
    const std::vector<std::string> known = {"auto", "none", "paper", "full", "parts"};
    if (std::find(known.begin(), known.end(), options.expand) == known.end())
      return mistake("expand: '" + options.expand + "'", "auto, none, paper, full or parts");
    const std::shared_ptr<const inner::Model> own = model.data().own_copy();
    const inner::Mechanics m = inner::mechanics(*own);
    const inner::Formulation& form = find_form(options.form, &m);
    if (options.reactions && form.unknowns == inner::Unknowns::variational)
      return mistake("the multipliers of the form '" + options.form + "' are not those of ideal reactions",
                     "derive its equations without reactions");
    const inner::Elimination e = inner::elimination_for(m, form.unknowns, {}, {}, true, 0);
    std::optional<inner::Elimination> pivots;
    if (options.reactions && form.unknowns == inner::Unknowns::multipliers)
      pivots = inner::elimination_of_reactions(m, {}, {});
    const inner::Elimination* of_reactions = !options.reactions ? nullptr : pivots ? &*pivots : &e;
    inner::Arranger arranger(options.expand);
    const std::vector<inner::Derivation> list = {inner::derivation(m, form, e, arranger, options.steps, of_reactions)};
    return Equations{form.name, inner::as_text(list), inner::as_latex(list), inner::as_mathml(list),
                     inner::as_json(list, false)};
  });
}

}  // namespace anholon::v1
