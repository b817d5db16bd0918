#include "anholon/equations.h"

#include <algorithm>

#include "api/data.h"
#include "print/print_names.h"
#include "report/equations.h"
#include "setup/eliminate.h"

namespace anholon::v1 {

Result<Equations> derive(const Model& model, const DeriveOptions& options) {
  return guarded(model.data().source, [&]() -> Result<Equations> {
    model.data().without_contacts("derive");
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
    return Equations{form.name,
                     inner::as_text(list),
                     inner::as_latex(list),
                     inner::as_mathml(list),
                     inner::as_json(list, false),
                     inner::as_html(list)};
  });
}

Symbol symbol(const std::string& name, const Model* model) {
  const std::size_t end = name.find_last_not_of('\'') + 1;
  const auto order = static_cast<unsigned>(name.size() - end);
  const std::string base = name.substr(0, end);
  std::string latex = inner::latex_name(base), mathml = inner::mathml_name(base);
  if (model) {
    const auto& notation = model->data().model->names.notation;
    if (const auto chosen = notation.find(base); chosen != notation.end())
      latex = chosen->second.latex, mathml = chosen->second.mathml;
  }
  return {inner::derivative_name(latex, order, inner::Format::latex),
          inner::derivative_name(mathml, order, inner::Format::mathml)};
}

}  // namespace anholon::v1
