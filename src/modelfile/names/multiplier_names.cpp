#include "modelfile/names/multiplier_names.h"

#include <algorithm>

#include "modelfile/names/names.h"

namespace anholon {

namespace {

class MultiplierNames final : public Names {
 public:
  MultiplierNames(Names& names, const std::vector<std::string>& multipliers)
      : names_(names), multipliers_(multipliers) {}

  Graph& graph() override { return names_.graph(); }
  Value name(const std::string& name, Span span) override {
    if (name != "lambda") return names_.name(name, span);
    return multipliers_.size() == 1 ? Value(graph().multiplier(0, 0)) : Value(kMultipliers);
  }
  std::optional<Value> call(const std::string& function, const std::vector<Value>& arguments,
                            const Syntax& syntax) override {
    return names_.call(function, arguments, syntax);
  }
  // Without multipliers, the file knows why there is none of this name.
  Value member(const Value& object, const Syntax& syntax) override {
    const std::string path = multiplier_path(syntax);
    if (path.empty() || multipliers_.empty()) return names_.member(object, syntax);
    for (std::size_t r = 0; r < multipliers_.size(); ++r)
      if (multipliers_[r] == path) return graph().multiplier(static_cast<std::uint32_t>(r), 0);
    for (const std::string& name : multipliers_)
      if (name.starts_with(path + ".")) return kMultipliersOfVector;  // of a vector equation: a component follows
    const std::string near = did_you_mean(path, multipliers_);
    throw Failure(syntax.span,
                  "there is no constraint '" + path + "'" + (near.empty() ? "" : "; did you mean '" + near + "'?"));
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

}  // namespace

Value evaluate_with_multipliers(const FormulaText& formula, Names& names, const std::vector<std::string>& multipliers) {
  const Syntax syntax = parse_formula(formula);
  MultiplierNames known(names, multipliers);
  const Value value = evaluate(syntax, known);
  if (!is_incomplete(value) || syntax.op != Syntax::Op::name || syntax.text != "lambda") return value;
  if (multipliers.empty()) throw Failure(syntax.span, "the model has no constraints, and so no multipliers");
  throw Failure(syntax.span, "there are " + std::to_string(multipliers.size()) + " multipliers",
                "lambda." + multipliers[0]);
}

bool holds_multiplier(Expr formula) {
  const std::vector<NodeId> ids = symbols({&formula, 1});
  return std::any_of(ids.begin(), ids.end(),
                     [&](NodeId id) { return formula.graph->node(id).kind == Kind::multiplier; });
}

}  // namespace anholon
