#include "setup/outputs/chosen_outputs.h"

#include <algorithm>

#include "formula/formula.h"
#include "modelfile/names/names.h"

namespace anholon {

namespace {

// The names of a model file. lambda.NAME is a multiplier, also that of a constraint that holds in the mode of the model;
// `lambda` alone is a name without a value.
class OutputNames final : public Names {
 public:
  OutputNames(Names& names, const std::vector<std::string>& multipliers) : names_(names), multipliers_(multipliers) {}
  Graph& graph() override { return names_.graph(); }
  Value name(const std::string& name, Span span) override {
    return name == "lambda" ? Value(InertialName{}) : names_.name(name, span);
  }
  std::optional<Value> call(const std::string& function, const std::vector<Value>& arguments,
                            const Syntax& syntax) override {
    return names_.call(function, arguments, syntax);
  }
  Value member(const Value& object, const Syntax& syntax) override {
    const auto known = std::find(multipliers_.begin(), multipliers_.end(), multiplier_path(syntax));
    return known != multipliers_.end()
               ? Value(graph().multiplier(static_cast<std::uint32_t>(known - multipliers_.begin()), 0))
               : names_.member(object, syntax);
  }
  std::vector<std::string> functions() const override { return names_.functions(); }
  std::optional<Vector> point(const BodyName& body, Span use) override { return names_.point(body, use); }
  std::optional<Rotation> frame(const BodyName& body, Span use) override { return names_.frame(body, use); }
  std::string body_name(const BodyName& body) const override { return names_.body_name(body); }
  bool declares(const std::string& name) const override { return names_.declares(name); }

 private:
  Names& names_;
  const std::vector<std::string>& multipliers_;
};

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
  OutputNames names(*open.names, open.model->names.multipliers);
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
      value = evaluate(parse_formula(FormulaText(formula, Span{1, 1, 1})), names);
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
