// Names for formulas without a model: numbers x, y (coordinates 0, 1), z (2), a, b (parameters 0, 1), m (mass 0), f
// (given 0), lambda.c (multiplier 0), vectors u and v, a rotation R, t and pi.
#pragma once
#include "formula/formula.h"
#include "print/print.h"

namespace anholon::test {

struct PlainNames final : Names {
  Graph g;

  Graph& graph() override { return g; }
  Value name(const std::string& name, Span span) override {
    if (name == "t") return g.time();
    if (name == "pi") return g.pi();
    if (name.size() == 1 && name[0] >= 'x' && name[0] <= 'z')
      return g.jet(static_cast<std::uint32_t>(name[0] - 'x'), 0);
    if (name == "a" || name == "b") return g.parameter(static_cast<std::uint32_t>(name[0] - 'a'));
    if (name == "m") return g.mass(0);
    if (name == "f") return g.given(0, 0);
    if (name == "lambda") return InertialName{};
    if (name == "u") return Vector{g.jet(0, 0), g.jet(1, 0), g.zero()};
    if (name == "v") return Vector{g.one(), g.zero(), g.parameter(0)};
    if (name == "R") return turn(2, g.jet(0, 0));
    if (name == "B") return BodyName{0};
    throw Failure(span, "unknown name '" + name + "'");
  }
  std::optional<Value> call(const std::string&, const std::vector<Value>&, const Syntax&) override {
    return std::nullopt;
  }
  Value member(const Value& object, const Syntax& s) override {
    if (std::holds_alternative<InertialName>(object)) return g.multiplier(0, 0);
    if (const Vector* v = std::get_if<Vector>(&object)) return (*v)[s.text[0] - 'x'];
    throw Failure(s.span, "no member");
  }
  std::vector<std::string> functions() const override { return {}; }

  Value value(const std::string& text) { return evaluate(parse_formula(FormulaText(text, Span{1, 1, 1})), *this); }
  Expr number(const std::string& text) {
    return evaluate_number(parse_formula(FormulaText(text, Span{1, 1, 1})), *this);
  }
  Failure failure(const std::string& text) {
    try {
      value(text);
    } catch (const Failure& f) {
      return f;
    }
    return Failure(Span{0, 0, 0}, "no failure");
  }
};

inline SymbolNames plain_symbol_names() { return {{"x", "y", "z"}, {"a", "b"}, {"m"}, {"c"}, {"f"}, {}, {}, {}, {}}; }

}  // namespace anholon::test
