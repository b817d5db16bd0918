#include "setup/outputs/chosen_outputs.h"

#include "formula/formula.h"
#include "modelfile/names/multiplier_names.h"

namespace anholon {

namespace {

// Returns the outputs of the model with this name; those of a vector are name.x, name.y, name.z.
std::vector<Monitor> own_outputs(const Model& model, const std::string& name) {
  std::vector<Monitor> list;
  for (const Monitor& m : model.monitors)
    if (m.name == name || (m.name.size() == name.size() + 2 && m.name.compare(0, name.size() + 1, name + ".") == 0))
      list.push_back(m);
  return list;
}

}  // namespace

std::shared_ptr<const Model> with_outputs(const OpenModel& open, const std::vector<ChosenOutput>& outputs) {
  auto model = std::make_shared<Model>(*open.model);
  std::vector<Monitor> list;
  for (const ChosenOutput& o : outputs) {
    const std::string& formula = o.formula.empty() ? o.name : o.formula;
    if (std::vector<Monitor> own = own_outputs(*open.model, formula); !own.empty()) {
      for (Monitor& m : own) {
        m.name = o.name + m.name.substr(formula.size());
        list.push_back(std::move(m));
      }
      continue;
    }
    Value value;
    try {
      value =
          evaluate_with_multipliers(FormulaText(formula, Span{1, 1, 1}), *open.names, open.model->names.multipliers);
    } catch (const Failure& f) {
      throw Failure({}, "output '" + o.name + "': " + f.diagnostic.message,
                    f.diagnostic.hint.empty() ? "an [output] or [monitor] of the model, or a formula in its names"
                                              : f.diagnostic.hint);
    }
    if (const Expr* number = std::get_if<Expr>(&value))
      list.push_back({o.name, *number, {}});
    else if (const Vector* v = std::get_if<Vector>(&value))
      for (std::size_t i = 0; i < 3; ++i) list.push_back({o.name + "." + "xyz" [i], (*v)[i], {}});
    else
      throw Failure({}, "output '" + o.name + "' is " + std::string(type_name(value)) + ", no number or vector");
  }
  model->monitors = std::move(list);
  return model;
}

}  // namespace anholon
