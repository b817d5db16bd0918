#include "modelfile/motion/initial.h"

#include <algorithm>

#include "formula/habits.h"
#include "formula/indices.h"
#include "modelfile/names/along.h"
#include "modelfile/text/collect.h"
#include "modelfile/text/keys.h"

namespace anholon {

namespace {

class InitialReader {
 public:
  InitialReader(const Item& section, Scope& scope, Model& model, Diagnostics& diagnostics)
      : section_(section), scope_(scope), model_(model), diagnostics_(diagnostics) {}

  void run() {
    InitialData& out = model_.initial;
    for (const Item& i : section_.items)
      collect(
          diagnostics_,
          [&] {
            if (i.key == "t") {
              out.t = constant(i);
              return;
            }
            if (i.key == "conditions") return conditions(i);
            if (i.key == "guess") {
              if (i.kind != Item::Kind::table) throw Failure(i.span, "guess is a table", "guess = {theta = 0.3}");
              for (const Item& v : i.items)
                collect(
                    diagnostics_,
                    [&] {
                      if (v.kind == Item::Kind::table)
                        group(v, out.guess);
                      else
                        add(out.guess, v, symbol(v.key, v.key_span));
                    },
                    v);
              return;
            }
            if (i.key == "branch") return branch(i, "");
            if (i.kind == Item::Kind::table) return group(i, out.given);
            if (i.key == "lambda" || i.key == "lambdadot")
              throw Failure(i.span, "lambda is a table", "lambda = {NAME = 0.4}");
            add(out.given, i, symbol(i.key, i.key_span));
          },
          i);
    // For constraints of order 3 and more these are initial data; for lower orders they follow from the state.
    int highest = 0;
    for (const Constraint& c : model_.constraints) highest = std::max(highest, c.order);
    // The reaction of a mass that depends on accelerations contains their rates.
    for (const VaryingMass& m : model_.masses)
      highest = std::max(highest, jet_order(m.value) + (jet_order(m.value) > 1 ? 1 : 0));
    for (const GivenValue& v : out.given) {
      const Node& n = model_.graph->node(v.symbol.id);
      if (highest < 3 && n.kind == Kind::multiplier)
        diagnostics_.error(
            v.span, "multipliers follow from the state: they are initial data for constraints of order 3 and more",
            "velocities that lead to a multiplier: conditions = [\"lambda.NAME = 0.4\"]");
      else if (highest < 3 && n.order > 1)
        diagnostics_.error(
            v.span, "accelerations follow from the state: they are initial data for constraints of order 3 and more",
            "give positions and velocities; velocities that lead to an acceleration: conditions = [\"x'' = 1\"]; to "
            "name one of "
            "several solutions: guess = {…}");
      else if (highest >= 3 && (n.kind == Kind::multiplier ? n.order + 2 : n.order) >= highest)
        diagnostics_.error(v.span, "derivatives of this order follow from the state",
                           "give those of order " + std::to_string(highest - 1) + " and less");
    }
    for (std::size_t k = 0; k < out.given.size(); ++k)
      for (std::size_t j = 0; j < k; ++j)
        if (out.given[j].symbol == out.given[k].symbol)
          diagnostics_.error(out.given[k].span, "this initial value is given twice (also in " +
                                                    line_of(out.given[j].span, model_.source_text) + ")");
  }

 private:
  Expr constant(const Item& i) {
    const Expr e = scope_.number(i);
    for (NodeId id : symbols({&e, 1}))
      if (model_.graph->node(id).kind != Kind::parameter)
        throw Failure(i.span, "an initial value is a number or a formula of parameters",
                      "relations between unknowns stand under conditions = [\"…\"]");
    return e;
  }

  void add(std::vector<GivenValue>& list, const Item& i, Expr symbol) {
    list.push_back({symbol, constant(i), i.key_span});
  }

  std::size_t constraint(const std::string& name, Span span) {
    const std::vector<std::string>& names = model_.names.multipliers;
    const bool known = std::find(names.begin(), names.end(), name) != names.end();
    if (!known && scope_.forces.has_no_value(name)) throw silent_failure();
    return index(names, name, span, "constraint");
  }

  std::size_t index(const std::vector<std::string>& names, const std::string& name, Span span, const char* what) {
    const auto it = std::find(names.begin(), names.end(), name);
    if (it != names.end()) return static_cast<std::size_t>(it - names.begin());
    if (const std::string members = members_known(name, names); !members.empty())
      throw Failure(span, std::string("there is no ") + what + " '" + name + "'" + members);
    const auto varies = [&](const std::string& n) {
      return &names == &model_.names.coordinates && std::find(names.begin(), names.end(), n) != names.end();
    };
    if (const std::string habit = habit_of_derivative(name, varies); !habit.empty())
      throw Failure(span, std::string("there is no ") + what + " '" + name + "'", habit);
    const std::string near = did_you_mean(name, names);
    throw Failure(span, std::string("there is no ") + what + " '" + name + "'" +
                            (near.empty() ? "" : "; did you mean '" + near + "'?"));
  }

  // Reads the symbol "x", "x'" or "D(x,3)".
  Expr symbol(std::string key, Span span) {
    unsigned order = 0;
    if (key.rfind("D(", 0) == 0 && key.back() == ')') {
      const std::size_t comma = key.rfind(',');
      std::string digits = comma == std::string::npos ? std::string() : key.substr(comma + 1, key.size() - comma - 2);
      std::erase(digits, ' ');
      if (digits.empty() || digits.find_first_not_of("0123456789") != std::string::npos)
        throw Failure(span, "'" + key.substr(0, 40) + "' is not a derivative of a coordinate", "D(x,3)");
      if (digits.size() > 2 || std::stoi(digits) > 20) throw Failure(span, "a derivative of order above 20");
      order = static_cast<unsigned>(std::stoi(digits));
      key = key.substr(2, comma - 2);
    } else {
      while (!key.empty() && key.back() == '\'') key.pop_back(), ++order;
      if (order > 20) throw Failure(span, "a derivative of order above 20");
    }
    return model_.graph->jet(static_cast<std::uint32_t>(index(model_.names.coordinates, key, span, "coordinate")),
                             order);
  }

  void group(const Item& i, std::vector<GivenValue>& list) {
    for (const auto& [key, order] : {std::pair{"q", 0U}, {"qdot", 1U}, {"qddot", 2U}, {"qdddot", 3U}})
      if (i.key == key) {
        for (const Item& v : i.items)
          collect(
              diagnostics_,
              [&] {
                add(list, v,
                    model_.graph->jet(
                        static_cast<std::uint32_t>(index(model_.names.coordinates, v.key, v.key_span, "coordinate")),
                        order));
              },
              v);
        return;
      }
    for (const auto& [key, order] : {std::pair{"lambda", 0U}, {"lambdadot", 1U}})
      if (i.key == key) return multipliers(i, "", order, list);
    throw Failure(i.key_span, "unknown key '" + i.key + "' in [initial]",
                  "q, qdot, qddot, qdddot, lambda, lambdadot are tables");
  }

  void multipliers(const Item& i, const std::string& prefix, unsigned order, std::vector<GivenValue>& list) {
    for (const Item& v : i.items)
      collect(
          diagnostics_,
          [&] {
            if (v.kind == Item::Kind::table) return multipliers(v, prefix + v.key + ".", order, list);
            const std::size_t k = constraint(prefix + v.key, v.key_span);
            add(list, v, model_.graph->multiplier(static_cast<std::uint32_t>(k), order));
          },
          v);
  }

  // Reads branch = {rolling = "lambda > 0"}.
  void branch(const Item& i, const std::string& prefix) {
    if (i.kind != Item::Kind::table) throw Failure(i.span, "branch is a table", "branch = {NAME = \"lambda > 0\"}");
    for (const Item& v : i.items)
      collect(
          diagnostics_,
          [&] {
            if (v.kind == Item::Kind::table) return branch(v, prefix + v.key + ".");
            const std::size_t k = constraint(prefix + v.key, v.key_span);
            std::string text;
            for (char c : v.text())
              if (c != ' ') text += c;
            if (text != "lambda>0" && text != "lambda<0")
              throw Failure(v.span, "a branch is named by the sign of the multiplier",
                            "\"lambda > 0\" or \"lambda < 0\"");
            model_.initial.branches.push_back({k, text == "lambda>0", v.key_span});
          },
          v);
  }

  void conditions(const Item& list) {
    if (list.kind != Item::Kind::array)
      throw Failure(list.span, "conditions is a list of equations", "conditions = [\"x' = 1\"]");
    for (const Item& c : list.items)
      collect(diagnostics_, [&] {
        const std::vector<Syntax> sides = scope_.equation(c);
        const ForcesInFormulas::Allowed allowed(scope_.forces);
        const Value left = as_point(evaluate(sides[0], scope_), scope_, sides[0].span),
                    right = as_point(evaluate(sides[1], scope_), scope_, sides[1].span);
        const auto push = [&](Expr residual, const std::string& suffix) {
          if (is_zero(residual)) return;
          const std::vector<NodeId> all = symbols({&residual, 1});
          const bool unknown = std::any_of(all.begin(), all.end(), [&](NodeId id) {
            const Kind kind = model_.graph->node(id).kind;
            return kind == Kind::jet || kind == Kind::multiplier;
          });
          if (!unknown) throw Failure(c.formula.whole(), "no unknown occurs in this condition");
          model_.initial.conditions.push_back({residual, equation_text(c.formula, sides) + suffix, c.formula.whole()});
        };
        for (const Value* side : {&left, &right})
          if (is_incomplete(*side))
            throw Failure(sides[side == &right].span, "this is not a number or vector",
                          "a multiplier is lambda.NAME, NAME being the constraint");
        if (is_scalar(left) && is_scalar(right)) return push(std::get<Expr>(left) - std::get<Expr>(right), "");
        const auto side = [&](const Value& v, const Syntax& s, const Syntax& other) {
          if (const Vector* a = std::get_if<Vector>(&v)) return *a;
          if (const Expr* e = std::get_if<Expr>(&v); e && is_zero(*e)) return zero_vector(*model_.graph);
          throw Failure(s.span, std::string("one side of the condition is a vector, the other is ") + type_name(v),
                        is_scalar(v) ? hint_for_component(other, scope_) : "");
        };
        const Vector residual = side(left, sides[0], sides[1]) - side(right, sides[1], sides[0]);
        for (int i = 0; i < 3; ++i)
          if (!is_zero(residual[i])) push(residual[i], std::string(" (") + "xyz"[i] + ")");
      });
  }

  const Item& section_;
  Scope& scope_;
  Model& model_;
  Diagnostics& diagnostics_;
};

}  // namespace

void read_initial(const Item& root, Scope& scope, Model& model, Diagnostics& diagnostics) {
  const Item* section = root.find("initial");
  if (!section) return;
  if (section->kind != Item::Kind::table) {
    diagnostics.error(section->span, "'initial' is a section", "write [initial]");
    return;
  }
  InitialReader(*section, scope, model, diagnostics).run();
}

}  // namespace anholon
