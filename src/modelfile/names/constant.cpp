#include "modelfile/names/constant.h"

#include <algorithm>

#include "formula/formula.h"
#include "formula/functions.h"
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

Dimension dimension_of(const Syntax& s);

Dimension dimension_of_product(const Syntax& s) {
  Dimension d = dimension_of(s.args[0]);
  for (std::size_t k = 1; k < s.args.size(); ++k) {
    const Dimension factor = dimension_of(s.args[k]);
    const bool divides = s.operators[k - 1].op == Syntax::Op::divide;
    for (std::size_t i = 0; i < d.size(); ++i) d[i] += divides ? Rational(-factor[i]) : factor[i];
  }
  return d;
}

Dimension dimension_of_sum(const Syntax& s) {
  const Dimension first = dimension_of(s.args[0]);
  for (std::size_t k = 1; k < s.args.size(); ++k)
    if (const Dimension next = dimension_of(s.args[k]); next != first)
      throw Failure(s.operators[k - 1].span, "the two sides are " + describe(first) + " and " + describe(next));
  return first;
}

Dimension power_of(Dimension d, const Rational& exponent) {
  for (Rational& k : d) k *= exponent;
  return d;
}

Dimension dimension_of_call(const Syntax& s) {
  const auto row = std::find_if(function_table().begin(), function_table().end(),
                                [&](const FunctionRow& r) { return r.name == s.text; });
  if (row == function_table().end() || s.args.empty()) return {};
  switch (row->dimension) {
  case DimensionRule::same:
  case DimensionRule::alike:
    return dimension_of(s.args[0]);
  case DimensionRule::root:
    return power_of(dimension_of(s.args[0]), {1, 2});
  case DimensionRule::choice:
  case DimensionRule::cases:
    return dimension_of(s.args.back());
  default:
    return {};  // other functions of numbers are pure numbers
  }
}

// Returns the dimension of an expression of numbers with and without units.
Dimension dimension_of(const Syntax& s) {
  using Op = Syntax::Op;
  if (s.op == Op::quantity) {
    const auto unit = read_unit(s.text);
    return unit ? unit->dimension : Dimension{};
  }
  if (s.op == Op::negate) return dimension_of(s.args[0]);
  if (s.op == Op::multiply) return dimension_of_product(s);
  if (s.op == Op::add) return dimension_of_sum(s);
  if (s.op == Op::call) return dimension_of_call(s);
  if (s.op != Op::power) return {};
  Constants names;
  const Expr exponent = evaluate_number(s.args[1], names);
  return power_of(dimension_of(s.args[0]), is_number(exponent) ? number_value(exponent) : Rational(0));
}

}  // namespace

Constant read_constant(const std::string& text) {
  if (const auto r = parse_rational(text)) return {*r, std::nullopt};
  Span start;
  start.line = start.column = 1;
  Constants names;
  const Syntax s = parse_formula(FormulaText(text, start));
  const Expr e = evaluate_number(s, names);
  Constant c;
  if (has_unit(s)) c.dimension = dimension_of(s);
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
