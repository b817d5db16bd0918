#include "modelfile/names/constant.h"

#include "formula/formula.h"
#include "numeric/multi.h"
#include "tape/tape.h"

namespace anholon {

namespace {

class Constants final : public Names {
 public:
  Graph& graph() override { return graph_; }
  Value name(const std::string& name, Span span) override {
    if (name == "pi") return graph_.pi();
    throw Failure(span, "'" + name.substr(0, 40) + "' is not a number",
                  "numbers, pi, functions of these and units stand here: pi/2, 8 cm");
  }
  std::optional<Value> call(const std::string&, const std::vector<Value>&, const Syntax&) override {
    return std::nullopt;
  }
  Value member(const Value&, const Syntax& s) override {
    throw Failure(s.span, "a number has no member '" + s.text + "'");
  }
  std::vector<std::string> functions() const override { return {}; }

 private:
  Graph graph_;
};

}  // namespace

Constant read_constant(const std::string& text) {
  if (const auto r = parse_rational(text)) return {*r, std::nullopt};
  Span start;
  start.line = start.column = 1;
  Constants names;
  const Syntax s = parse_formula(FormulaText(text, start));
  const Expr e = evaluate_number(s, names);
  Constant c;
  const Syntax& number = s.op == Syntax::Op::negate ? s.args[0] : s;
  if (number.op == Syntax::Op::quantity)
    if (const auto unit = read_unit(number.text)) c.dimension = unit->dimension;
  if (is_number(e)) {
    c.value = number_value(e);
    return c;
  }
  constexpr int kDigits = 60;
  const PrecisionScope precision(kDigits + 10);
  const Tape tape = compile({&e, 1});
  Machine<Multi> machine(tape, 0, {});
  machine.evaluate();
  const auto value =
      is_finite(machine.value(0)) ? parse_rational(number_text(machine.value(0), kDigits)) : std::nullopt;
  if (!value) throw Failure(s.span, "this has no value");
  c.value = *value;
  return c;
}

std::optional<double> constant_value(const Model& model, Expr e) {
  Graph& g = *model.graph;
  const auto of_parameters = [&] {
    const std::vector<NodeId> all = symbols({&e, 1});
    return std::any_of(all.begin(), all.end(), [&](NodeId id) { return g.node(id).kind == Kind::parameter; });
  };
  for (std::size_t depth = 0; depth <= model.parameters.size() && of_parameters(); ++depth)
    e = substitute({&e, 1}, [&](NodeId id) {
      const Node& n = g.node(id);
      return n.kind == Kind::parameter ? model.parameters[n.index].value : Expr{};
    })[0];
  if (!symbols({&e, 1}).empty()) return std::nullopt;  // (a division by zero throws Failure)
  const Tape tape = compile({&e, 1});
  Machine<double> machine(tape, 0, {});
  machine.evaluate();
  return machine.value(0);
}

}  // namespace anholon
