// Every form holds at every stored state of every reference system. The stored coordinates, derivatives, accelerations
// and multipliers are put into its equations; higher derivatives that are not stored are pseudo-random if they are
// free, else they follow from the constraints. Each system is used at the order of its constraints and with its
// constraints differentiated, which leaves their reactions the same; with the constraints solved if that is possible,
// and not solved; in 50 digits and in double.
#include <cstdlib>
#include <set>

#include <gtest/gtest.h>

#include "setup/eliminate.h"
#include "support/manifold.h"
#include "support/oracle.h"

namespace anholon::forms_oracle_test {
namespace {

using nlohmann::json;

constexpr double kManyDigits = 1e-25;  // the states are stored with 32 digits and more, and polished
constexpr double kDouble = 1e-12;
constexpr double kRefuted = 1e-6;  // a mutant misses by much more
constexpr int kDigits = 50;

Multi number(const json& digits) {
  Multi x;
  if (mpfr_set_str(x.raw(), digits.get<std::string>().c_str(), 10, MPFR_RNDN) != 0)
    throw std::runtime_error(digits.dump() + " is no number");
  return x;
}

// The same system with each constraint differentiated `times` times.
std::shared_ptr<const Model> lifted(const std::shared_ptr<const Model>& model, unsigned times) {
  if (times == 0) return model;
  auto copy = std::make_shared<Model>(*model);
  for (Constraint& c : copy->constraints) {
    c.phi = total_derivative(put_masses(*model, c.phi), times);
    c.order += static_cast<int>(times);
  }
  return copy;
}

struct Worst {
  double error = 0, least = 1e300;
  std::string where;
  int count = 0;
  void take(double miss, const std::string& what) {
    ++count;
    least = std::min(least, miss);
    if (!(miss <= error)) error = miss == miss ? miss : 1e300, where = what;
  }
};

class FormsOracle : public testing::TestWithParam<test::OraclePair> {
 protected:
  PrecisionScope precision{kDigits};
  std::shared_ptr<const Model> model = test::shipped(GetParam().model);
  json data = test::oracle_data(GetParam().oracle);
  Mechanics m = mechanics(*model);

  std::size_t coordinate(const std::string& name) const {
    const auto& names = model->names.coordinates;
    return static_cast<std::size_t>(std::find(names.begin(), names.end(), name) - names.begin());
  }

  // x_2 -> x'', lam1_1 -> the rate of the first multiplier.
  Expr symbol(const std::string& name) const {
    const auto [base, order] = test::split_order(name);
    if (const std::size_t a = coordinate(base); a < m.q.size())
      return m.graph().jet(static_cast<std::uint32_t>(a), order);
    if (const std::size_t a = coordinate(name); a < m.q.size()) return m.graph().jet(static_cast<std::uint32_t>(a), 0);
    if (base.rfind("lam", 0) != 0) throw std::runtime_error("unknown symbol " + name);
    return m.graph().multiplier(static_cast<std::uint32_t>(std::stoul(base.substr(3)) - 1), order);
  }

  std::vector<std::size_t> dependent() const {
    std::vector<std::size_t> out;
    for (const json& name : data["dependent"]) out.push_back(coordinate(name.get<std::string>()));
    return out;
  }
  Column of_dependent(const std::vector<std::size_t>& D, unsigned order) const {
    Column out;
    for (std::size_t b : D) out.push_back(m.graph().jet(static_cast<std::uint32_t>(b), order));
    return out;
  }

  // The point of a stored state, corrected slightly until first the constraints and then the equations of motion hold.
  // Independent derivatives that are not stored are pseudo-random, up to order `highest`. Throws if a stored value
  // would change by more than 1e-26.
  test::Point point(const json& stored, const std::vector<std::size_t>& D, unsigned highest) const {
    Graph& g = m.graph();
    test::Point at = test::random_point(*model, 1);
    at.set(g.time(), number(stored["t"]));
    std::set<NodeId> known;
    for (const char* part : {"state", "solution"})
      for (const auto& [name, value] : stored[part].items()) {
        const Expr s = symbol(name);
        at.set(s, number(value));
        known.insert(s.id);
      }
    Column phi;
    for (Expr e : m.phi) phi.push_back(put_masses(*model, e));
    const Column motion = put_masses(*model, lagrange_operator(m) - right_side(m));
    const auto solve = [&](const Column& equations, const Column& unknowns, const char* what) {
      const std::vector<Multi> before = test::values(unknowns, at);
      if (!test::solve_for(at, equations, unknowns)) throw std::runtime_error(std::string("no solution for ") + what);
      const std::vector<Multi> after = test::values(unknowns, at);
      for (std::size_t i = 0; i < after.size(); ++i)
        if (known.count(unknowns[i].id) && test::distance(before[i], after[i]) > 1e-26)
          throw std::runtime_error(std::string("the stored state does not satisfy ") + what);
    };
    const int order = m.order.empty() ? 0 : *std::max_element(m.order.begin(), m.order.end());
    for (int r : m.order)
      if (r != order) throw std::runtime_error("constraints of different orders");
    const auto level = [&](unsigned k) { return total_derivative_of(phi, static_cast<int>(k) - order); };
    for (unsigned k = static_cast<unsigned>(order); k < 2; ++k)
      if (!phi.empty()) solve(level(k), of_dependent(D, k), "the constraints");
    if (order <= 2) {
      Column equations = motion, unknowns = m.qdd;
      const Column last = level(2);
      equations.insert(equations.end(), last.begin(), last.end());
      unknowns.insert(unknowns.end(), m.lambda.begin(), m.lambda.end());
      solve(equations, unknowns, "the equations of motion");
    } else if (known.count(g.multiplier(0, 1).id)) {  // linear in the third derivatives: lambda is part of the state
      solve(motion, m.qdd, "the equations of motion");
      solve(phi, of_dependent(D, 3), "the constraints");
    } else {
      Column equations = motion, unknowns = jets(*model, 3);
      equations.insert(equations.end(), phi.begin(), phi.end());
      unknowns.insert(unknowns.end(), m.lambda.begin(), m.lambda.end());
      solve(equations, unknowns, "the equations of motion");
    }
    for (unsigned k = static_cast<unsigned>(std::max(order, 2)) + 1; k <= highest; ++k)
      if (!phi.empty()) solve(level(k), of_dependent(D, k), "the constraints");
    return at;
  }
  static Column total_derivative_of(Column c, int times) {
    for (; times > 0; --times) c = total_derivative(c);
    return c;
  }

  // One form to be evaluated: its residual, the summands of its sides, and their program.
  struct Prepared {
    Column residual, parts;
    std::vector<std::size_t> first;  // index of the first part of equation i
    Tape tape;
  };
  static Prepared prepare(const Model& of, const Elimination& e, const Equations& q) {
    Prepared p;
    const Column left = put_masses(of, e.in_coordinates(q.left)), right = put_masses(of, e.in_coordinates(q.right));
    p.residual = left - right;
    for (std::size_t i = 0; i < left.size(); ++i) {
      p.first.push_back(p.parts.size());
      for (Expr side : {left[i], right[i]}) {
        Graph& g = *side.graph;
        if (g.node(side.id).kind != Kind::sum)
          p.parts.push_back(side);
        else
          for (const Term& t : g.summands(side.id))
            p.parts.push_back(g.is_number(t.node) ? g.number(g.rational(t.weight) * g.value(t.node))
                                                  : g.rational(t.weight) * Expr{&g, t.node});
      }
    }
    p.first.push_back(p.parts.size());
    Column all = p.residual;
    all.insert(all.end(), p.parts.begin(), p.parts.end());
    p.tape = compile(all);
    return p;
  }

  // |residual| in units of the largest part of its equation, or of 1.
  template <Number N>
  double miss(const Prepared& p, const test::Point& at) const {
    Column es;
    for (const Parameter& x : model->parameters) es.push_back(x.value);
    Machine<N> machine(p.tape, 0, evaluate_parameters<N>(m.graph(), es));
    for (const Input& in : p.tape.inputs) {
      const Multi v = at(m.graph(), in.symbol);
      if constexpr (std::same_as<N, Multi>)
        machine.series(in.slot)[0] = v;
      else
        machine.series(in.slot)[0] = to_double(v);
    }
    machine.evaluate();
    double worst = 0;
    for (std::size_t i = 0; i < p.residual.size(); ++i) {
      double scale = 1;
      for (std::size_t k = p.first[i]; k < p.first[i + 1]; ++k)
        scale = std::max(scale, std::abs(to_double(machine.value(p.residual.size() + k))));
      const double off = std::abs(to_double(machine.value(i))) / scale;
      if (!(off <= worst)) worst = off == off ? off : 1e300;
    }
    return worst;
  }
  static double to_double(const Multi& x) { return anholon::to_double(x); }
  static double to_double(double x) { return x; }

  Elimination eliminate(const Mechanics& of, Unknowns unknowns, bool solved) const {
    // Takes the reference's dependent coordinates, unless they are unsuitable at the start.
    try {
      return elimination_for(of, unknowns, {}, dependent(), solved);
    } catch (const Failure&) {
      return elimination_for(of, unknowns, {}, {}, solved);
    }
  }

  static bool holonomic(const Mechanics& of) {
    return std::all_of(of.order.begin(), of.order.end(), [](int r) { return r == 0; });
  }

  // Evaluates all forms that apply, with the constraints differentiated `times` times. Udwadia-Kalaba, which solves for
  // the accelerations, is evaluated for times = 0 only, since differentiation adds nothing new to it; variational
  // mechanics has these reactions only if the constraints are holonomic.
  void judge(unsigned times, bool solved, Worst& multi, Worst& real,
             const std::function<Equations(const Formulation&, Equations)>& mutant = {}) {
    const std::shared_ptr<const Model> at_order = lifted(model, times);
    const Mechanics here = mechanics(*at_order);
    unsigned highest = 2;
    for (int r : here.order) highest = std::max(highest, static_cast<unsigned>(r));
    std::vector<test::Point> points;
    const std::vector<std::size_t> D = dependent();
    for (const json& stored : data["states"]) points.push_back(point(stored, D, highest + 1));
    for (const Formulation* form : formulations()) {
      if (!form->obstacle(here).empty() || (form->unknowns == Unknowns::variational && !holonomic(here))) continue;
      if (times > 0 && std::string(form->name) == "udwadia-kalaba") continue;
      const Elimination e = eliminate(here, form->unknowns, solved);
      const Equations q = form->equations(here, e);
      const Prepared p = prepare(*at_order, e, mutant ? mutant(*form, q) : q);
      for (std::size_t k = 0; k < points.size(); ++k) {
        const std::string where =
            std::string(form->name) + ", lifted " + std::to_string(times) + " times, state " + std::to_string(k);
        multi.take(miss<Multi>(p, points[k]), where);
        real.take(miss<double>(p, points[k]), where);
      }
    }
  }
};

class FormsOracleAtOrder : public FormsOracle {
 protected:
  // The order of the equations is that of the constraints, at least 1.
  unsigned native() const { return m.order.empty() ? 1U : static_cast<unsigned>(std::max(1, m.order[0])); }
  void expect_at(unsigned order, bool solved) {
    const unsigned times = order == native() || m.order.empty() ? 0U : order - static_cast<unsigned>(m.order[0]);
    Worst multi, real;
    judge(times, solved, multi, real);
    EXPECT_LE(multi.error, kManyDigits) << multi.where;
    EXPECT_LE(real.error, kDouble) << real.where;
    EXPECT_GE(multi.count, static_cast<int>(data["states"].size()) * (order > 1 ? 18 : 25));
  }
};

TEST_P(FormsOracleAtOrder, OfTheConstraints) { expect_at(native(), true); }

INSTANTIATE_TEST_SUITE_P(Model, FormsOracleAtOrder, testing::ValuesIn(test::oracle_pairs()),
                         [](const auto& p) { return test::test_name(p.param.model); });

// The systems whose constraints have at most the order `highest`; systems without constraints are left out.
std::vector<test::OraclePair> with_constraints(int highest) {
  std::vector<test::OraclePair> pairs;
  for (const test::OraclePair& p : test::oracle_pairs()) {
    int order = -1;
    const auto stored = test::oracle_data(p.oracle);
    for (const auto& c : stored.at("constraints")) order = std::max(order, c.at("order").get<int>());
    if (order >= 0 && order <= highest) pairs.push_back(p);
  }
  return pairs;
}

class FormsOracleOneHigher : public FormsOracleAtOrder {};

TEST_P(FormsOracleOneHigher, Holds) { expect_at(native() + 1, false); }

INSTANTIATE_TEST_SUITE_P(Model, FormsOracleOneHigher, testing::ValuesIn(with_constraints(99)),
                         [](const auto& p) { return test::test_name(p.param.model); });

// The systems whose constraints have at most order 1, to be lifted to order 3 (FormsOracleOneHigher lifts those of
// order 2): all if ANHOLON_LONG is set, else some quick ones.
std::vector<test::OraclePair> lifted_to_three() {
  const std::set<std::string> quick = {
      "zoo/chaplygin-sleigh", "zoo/rheonomic-order-1", "zoo/double-pendulum-cartesian", "zoo/appell-hamel",
      "zoo/vertical-disc",    "zoo/isokinetic",        "papers/luo-zhao-example-1"};
  std::vector<test::OraclePair> pairs = with_constraints(1);
  if (!std::getenv("ANHOLON_LONG"))
    std::erase_if(pairs, [&](const test::OraclePair& p) { return !quick.count(p.model); });
  return pairs;
}

class FormsOracleAtThree : public FormsOracleAtOrder {};

TEST_P(FormsOracleAtThree, Holds) { expect_at(3, true); }

INSTANTIATE_TEST_SUITE_P(Model, FormsOracleAtThree, testing::ValuesIn(lifted_to_three()),
                         [](const auto& p) { return test::test_name(p.param.model); });

// Mutants: an equation that differs from the form's, and a system that differs from the stored one.
class FormsOracleMutant : public FormsOracle {};

TEST_P(FormsOracleMutant, IsRefuted) {
  for (const unsigned times : {0U, 1U}) {
    Worst multi, real;
    judge(times, true, multi, real, [](const Formulation&, Equations q) {
      q.left.back() = Rational(2) * q.left.back();
      return q;
    });
    EXPECT_GT(multi.least, kRefuted);
    EXPECT_GT(real.least, kRefuted);
  }
  const std::string mass = GetParam().model == "zoo/third-order-linear" ? "m" : "m0";
  model = test::model_of(test::shipped_text(GetParam().model), {{mass, "2*(1 + 1e-22)"}});
  m = mechanics(*model);
  EXPECT_THROW(point(data["states"][0], dependent(), 3), std::runtime_error);
  model = test::model_of(test::shipped_text(GetParam().model), {{mass, "2"}});
  m = mechanics(*model);
  EXPECT_NO_THROW(point(data["states"][0], dependent(), 3));
}

INSTANTIATE_TEST_SUITE_P(Model, FormsOracleMutant,
                         testing::Values(test::OraclePair{"zoo/rheonomic-order-1", "s17_generic_rheonomic_m1"},
                                         test::OraclePair{"zoo/rheonomic-order-2", "s18_generic_rheonomic_m2"},
                                         test::OraclePair{"zoo/third-order-linear", "s13_third_order_linear"}),
                         [](const auto& p) { return test::test_name(p.param.model); });

}  // namespace
}  // namespace anholon::forms_oracle_test
