#include <gtest/gtest.h>

#include "numeric/ball.h"
#include "print/print.h"
#include "support/random_expr.h"
#include "support/value.h"
#include "tape/tape.h"

namespace anholon::machine_test {
namespace {

using test::RandomExpr;

constexpr int kOrders = 8;

// x(t), y(t), x'(t): polynomials whose Taylor coefficients are powers of 2, exact in every number type.
double coefficient_of_path(std::uint32_t coordinate, std::uint32_t order, int k) {
  if (k > 3) return 0;
  return (coordinate == 0 ? 0.375 : -0.25) * (order == 0 ? 1 : 1.5) * (k % 2 ? 1 : -0.5) / (1 << k) +
         (k == 0 ? 0.5 : 0);
}

Multi on_path(const Graph& g, NodeId id, const Multi& t) {
  const Node& n = g.node(id);
  if (n.kind == Kind::time) return t;
  Multi v(0);
  for (int k = 3; k >= 0; --k) v = v * t + Multi(coefficient_of_path(n.index, n.order, k));
  return v;
}

constexpr double kParameter = 0.75;

template <class N>
void set_inputs(Machine<N>& machine, const Graph& g, int orders) {
  for (const Input& in : machine.tape().inputs) {
    const Node& n = g.node(in.symbol);
    for (int k = 0; k <= orders; ++k)
      machine.series(in.slot)[k] =
          n.kind == Kind::time ? N(k == 1 ? 1 : 0) : N(coefficient_of_path(n.index, n.order, k));
  }
}

std::vector<Multi> reference(Expr e, int orders) {
  return test::taylor_by_differences(
      [&](const Multi& t) {
        test::Point p;
        p.set_parameters({Multi(kParameter)});
        for (NodeId id : symbols({&e, 1}))
          if (e.graph->node(id).kind != Kind::parameter) p.set(Expr{e.graph, id}, on_path(*e.graph, id, t));
        return test::value(e, p);
      },
      orders);
}

// The largest error of any coefficient, in round-offs of the largest coefficient up to it.
template <class N>
double error_in_roundoffs(Expr e, const std::vector<Multi>& expected) {
  const Tape tape = compile({&e, 1});
  Machine<N> machine(tape, kOrders, {N(kParameter)});
  set_inputs(machine, *e.graph, kOrders);
  for (int stage = 0; stage <= kOrders; ++stage) machine.sweep(stage, 0, static_cast<std::uint32_t>(tape.code.size()));
  double worst = 0;
  Multi size(1);
  for (int k = 0; k <= kOrders; ++k) {
    const Multi& c = expected[static_cast<std::size_t>(k)];
    if (abs(c) > size) size = abs(c);
    Multi found;
    if constexpr (std::same_as<N, Multi>)
      found = machine.series(tape.roots[0])[k];
    else if constexpr (std::same_as<N, Quad>)
      set_mpfr(found.raw(), machine.series(tape.roots[0])[k]);
    else
      found = Multi(static_cast<long double>(machine.series(tape.roots[0])[k]));
    worst = std::max(worst, to_double(Multi(abs(Multi(found - c)) / size)) / to_double(unit_roundoff<N>()));
  }
  return worst;
}

template <class N>
class TaylorIn : public testing::Test {
 protected:
  PrecisionScope precision{40};
  // Recurrences of up to 8 terms, some with derivatives of derivatives: a few hundred round-offs; wrong rules err by
  // 1e10 and more.
  static constexpr double kRoundoffs = 1000;
};
using NumberTypes = testing::Types<double, long double, Quad, Multi>;
TYPED_TEST_SUITE(TaylorIn, NumberTypes);

TYPED_TEST(TaylorIn, EveryElementaryFunction) {
  Graph g;
  const Expr x = g.jet(0, 0);
  int rows = 0;
  const auto check = [&](const char* name, Expr e) {
    EXPECT_LE(error_in_roundoffs<TypeParam>(e, reference(e, kOrders)), this->kRoundoffs) << name;
    ++rows;
  };
#define ROW(name, ...) check(#name, name(std::string(#name) == "acosh" ? 1 + x : x));
#include "expr/elementary.def"
#undef ROW
  EXPECT_EQ(rows, static_cast<int>(RandomExpr::kFunctions));
}

TYPED_TEST(TaylorIn, EveryOperation) {
  Graph g;
  const Expr x = g.jet(0, 0), y = g.jet(1, 0), xd = g.jet(0, 1), p = g.parameter(0), t = g.time();
  const std::pair<const char*, Expr> cases[] = {
      {"constant", g.number(Rational(2, 3))},
      {"pi", g.pi()},
      {"input", y},
      {"parameter", p},
      {"linear", 3 * x - Rational(1, 7) * y + g.pi() + g.number(Rational(5, 3))},
      {"multiply", x * y},
      {"multiply by itself derived", x * xd},
      {"scale", p * x},
      {"scale pi", g.pi() * y},
      {"square", x * x},
      {"fourth power", pow(x, 4)},
      {"seventh power", pow(x, 7)},
      {"time", t * t * x},
      {"divide", x / (2 + y)},
      {"divide constant", 1 / Rational(1) * (g.one() / (2 + y))},
      {"divide by constant", x / p},
      {"negative power", pow(2 + x, -3)},
      {"sqrt", sqrt(2 + x)},
      {"1/sqrt", pow(2 + x, {-1, 2})},
      {"3/2", pow(2 + x, {3, 2})},
      {"1/3", pow(2 + x, {1, 3})},
      {"-5/7", pow(2 + x, {-5, 7})},
      {"constant root", sqrt(p) * x},
      {"atan2", atan2(y, 1 + x)},
      {"atan2 of constant y", atan2(p, 1 + x)},
      {"atan2 of constant x", atan2(y, p)},
      {"function of constant", sin(p) * x},
      {"nested", exp(sin(cos(x)) * tanh(y)) / sqrt(1 + x * x)}};
  for (const auto& [name, e] : cases)
    EXPECT_LE(error_in_roundoffs<TypeParam>(e, reference(e, kOrders)), this->kRoundoffs) << name;
}

// The graph writes 1 + 1e-34 x as 1e-34 (1e34 + x), whose tenth power no double holds.
TYPED_TEST(TaylorIn, SumsWithFarCoefficients) {
  Graph g;
  const Expr x = g.jet(0, 0), y = g.jet(1, 0), p = g.parameter(0);
  const Expr small = g.number(Rational("1/10000000000000000000000000000000000"));
  const Expr far = 1 + small * x, digits = 1 + g.number(Rational("12345678/100000000")) * x;
  const std::pair<const char*, Expr> cases[] = {{"power", pow(far, 10)},
                                                {"digits", pow(digits, 38) / pow(2 + digits * y, 30)},
                                                {"function", sin(pow(far, 12) * y)},
                                                {"root", sqrt(pow(far, 11) + 2 * pow(far, 9) * y)},
                                                {"quotient", p * pow(far, 10) / pow(far + y * y, 20)},
                                                {"alone", far},
                                                {"nested", pow(1 + small * pow(far, 10) * y, 10) + pow(far, 10)},
                                                {"with a parameter", pow(1 + small * p, 10) * x}};
  for (const auto& [name, e] : cases)
    EXPECT_LE(error_in_roundoffs<TypeParam>(e, reference(e, kOrders)), this->kRoundoffs) << name;
}

TYPED_TEST(TaylorIn, RandomExpressions) {
  Graph g;
  const std::vector<Expr> atoms = {g.jet(0, 0), g.jet(1, 0), g.jet(0, 1), g.parameter(0), g.time()};
  for (std::uint32_t k = 1; k <= 12; ++k) {
    const Expr e = RandomExpr(g, k, atoms).make(3);
    const std::vector<Multi> expected = reference(e, kOrders);
    // Ill-conditioned samples (poles near by) lose a few digits; a wrong recurrence loses all.
    ASSERT_LE(error_in_roundoffs<TypeParam>(e, expected), 1000 * this->kRoundoffs) << print(e, {}, Format::text);
  }
}

TEST(Taylor, AWrongCoefficientIsRefuted) {
  Graph g;
  const PrecisionScope precision(30);
  const Expr x = g.jet(0, 0);
  EXPECT_GT(error_in_roundoffs<Multi>(sin(x), reference(cos(x), kOrders)), 1e20);
  std::vector<Multi> expected = reference(sin(x), kOrders);
  expected[8] = expected[8] * Multi(1.0001);
  EXPECT_GT(error_in_roundoffs<double>(sin(x), expected), 1e4);
}

// Balls of the coefficients at t, or over a whole interval around it.
std::vector<Ball> enclosed(Expr e, const Ball& t, int orders) {
  const Tape tape = compile({&e, 1});
  Machine<Ball> machine(tape, static_cast<std::size_t>(orders), {Ball(Rational(3, 4))});
  const Graph& g = *e.graph;
  for (const Input& in : tape.inputs) {
    const Node& n = g.node(in.symbol);
    // The polynomial of the path about t, by Horner's scheme.
    std::vector<Ball> c;
    for (int k = 0; k <= 3; ++k)
      c.emplace_back(n.kind == Kind::time ? Rational(k == 1 ? 1 : 0)
                                          : Rational(coefficient_of_path(n.index, n.order, k)));
    for (std::size_t i = 0; i < 3; ++i)
      for (std::size_t k = 3; k-- > i;) addmul(c[k], t, c[k + 1]);
    for (int k = 0; k <= orders; ++k) machine.series(in.slot)[k] = k <= 3 ? c[static_cast<std::size_t>(k)] : Ball(0);
  }
  for (int stage = 0; stage <= orders; ++stage) machine.sweep(stage, 0, static_cast<std::uint32_t>(tape.code.size()));
  const Ball* w = machine.series(tape.roots[0]);
  return {w, w + orders + 1};
}

TEST(MachineOfBalls, EnclosesTheCoefficientsAtAPointAndOnAnInterval) {
  const PrecisionScope precision(60);
  const BallScope balls(220);
  Graph g;
  const std::vector<Expr> atoms = {g.jet(0, 0), g.jet(1, 0), g.jet(0, 1), g.parameter(0), g.time()};
  int finite = 0;
  for (std::uint32_t k = 1; k <= 40; ++k) {
    const Expr e = RandomExpr(g, 200 + k, atoms).make(3);
    const Rational radius(1, 64);
    const std::vector<Ball> wide = enclosed(e, Ball(Rational(0), radius), kOrders);
    for (int place = -2; place <= 2; ++place) {
      const std::vector<Ball> at = enclosed(e, Ball(Rational(radius * place / 2)), kOrders);
      for (std::size_t i = 0; i < at.size(); ++i)
        if (wide[i].is_finite() && at[i].is_finite()) {
          ++finite;
          EXPECT_TRUE(wide[i].overlaps(at[i])) << k << ", order " << i << ": " << print(e, {}, Format::text);
          EXPECT_TRUE((at[i] - wide[i].center()).symmetric().overlaps(wide[i].spread()));
        }
    }
    const std::vector<Multi> expected = reference(e, kOrders);
    const std::vector<Ball> at = enclosed(e, Ball(0), kOrders);
    for (std::size_t i = 0; i < at.size(); ++i) {
      if (!at[i].is_finite() || !expected[i].finite()) continue;
      Ball near(expected[i]);  // the reference comes from differences, with some 20 right digits
      near += Ball(Rational(0), Rational(1, mpz_class("100000000000000"))) * (Ball(1) + abs(near));
      EXPECT_TRUE(near.overlaps(at[i])) << k << ", order " << i << ": " << print(e, {}, Format::text);
      EXPECT_LT(*at[i].spread().radius(),
                Rational(1, mpz_class("1000000000000000000000000000000")) * (1 + abs(*at[i].midpoint())));
    }
  }
  EXPECT_GT(finite, 1000);
}

// On a ball on which a function is not smooth, no coefficient after the first is known.
TEST(MachineOfBalls, KnowsNothingBesideAKink) {
  Graph g;
  const Expr x = g.time();
  const Ball wide(Rational(0), Rational(1, 8));
  for (const Expr e : {abs(x), sign(x), atan2(x, g.number(-1)), sqrt(x), log(x), pow(x, {1, 3}), g.one() / x}) {
    const std::vector<Ball> w = enclosed(e, wide, 3);
    for (std::size_t k = 1; k < w.size(); ++k)
      EXPECT_FALSE(w[k].is_finite()) << print(e, {}, Format::text) << ", order " << k;
    const std::vector<Ball> beside = enclosed(e, Ball(Rational(1, 4), Rational(1, 8)), 3);
    for (const Ball& b : beside) EXPECT_TRUE(b.is_finite()) << print(e, {}, Format::text);
  }
  EXPECT_TRUE(enclosed(abs(x), wide, 0)[0].is_finite());
}

// A root with lead c has, after stage s, its coefficients up to order s + c: stage 0 gives the derivative of order c.
TEST(Leads, GiveTheCoefficientsOfTheDerivative) {
  const PrecisionScope precision(50);
  Graph g;
  const std::vector<Expr> atoms = {g.jet(0, 0), g.jet(1, 0), g.parameter(0), g.time()};
  for (std::uint32_t k = 1; k <= 20; ++k) {
    RandomExpr make(g, 40 + k, atoms);
    const std::vector<Expr> es = {make.make(3), make.make(3), make.make(2)};
    const std::vector<int> leads = {2, 0, 1};
    const Tape tape = compile(es, leads);
    EXPECT_EQ(tape.largest_lead, 2);
    Machine<Multi> machine(tape, 2, {Multi(kParameter)});
    set_inputs(machine, g, 2 + tape.largest_lead);
    const auto end = static_cast<std::uint32_t>(tape.code.size());
    for (int stage = -tape.largest_lead; stage <= 0; ++stage) machine.sweep(stage, 0, end);
    for (std::size_t i = 0; i < es.size(); ++i) {
      const int lead = leads[i];
      ASSERT_EQ(tape.code[tape.roots[i]].lead, lead);
      const Expr derived = total_derivative(es[i], static_cast<unsigned>(lead));
      test::Point p;
      p.set_parameters({Multi(kParameter)});
      for (NodeId id : symbols({&derived, 1})) {
        const Node& n = g.node(id);
        if (n.kind == Kind::parameter) continue;
        if (n.kind == Kind::time) {
          p.set(Expr{&g, id}, Multi(0));
          continue;
        }
        Multi factorial(1);
        for (int j = 2; j <= n.order; ++j) factorial *= Multi(j);
        p.set(Expr{&g, id}, Multi(coefficient_of_path(n.index, 0, n.order)) * factorial);
      }
      const Multi factor(lead == 2 ? 2 : 1), found = machine.series(tape.roots[i])[lead] * factor;
      ASSERT_LE(test::distance(found, test::value(derived, p)), 1e-44) << k << ", root " << i;
    }
  }
}

TEST(Machine, AgreesWithTheDefinitionAndWithItselfInEveryNumberType) {
  const PrecisionScope precision(40);
  Graph g;
  const std::vector<Expr> atoms = {g.jet(0, 0), g.jet(1, 0), g.jet(0, 1), g.parameter(0), g.time()};
  for (std::uint32_t k = 1; k <= 100; ++k) {
    const Expr e = RandomExpr(g, 70 + k, atoms).make(4);
    const Tape tape = compile({&e, 1});
    Machine<Multi> machine(tape, 0, {Multi(kParameter)});
    set_inputs(machine, g, 0);
    machine.evaluate();
    ASSERT_LE(test::distance(machine.value(0), reference(e, 0)[0]), 1e-36);
  }
}

TEST(Partials, AreTheDerivativesByTheOperands) {
  const PrecisionScope precision(60);
  const Multi h = test::raise(Multi(10), Rational(-18));
  Graph g;
  const Expr x = g.jet(0, 0), y = g.jet(1, 0);
  for (Expr e : {x * y, x * x, x / (2 + y), pow(2 + x, {1, 3}), sin(x), atan2(y, 2 + x), g.parameter(0) * x}) {
    const Tape tape = compile({&e, 1});
    // The last slot but the alias is the operation itself.
    const std::uint32_t slot = tape.linear_terms[tape.code[tape.roots[0]].first].slot;
    const Instruction in = tape.code[slot];
    const auto run = [&](const Multi& da, const Multi& db) {
      Machine<Multi> machine(tape, 0, {Multi(kParameter)});
      set_inputs(machine, g, 0);
      machine.evaluate();
      machine.series(in.a)[0] += da;
      if (in.op != Op::power && in.op != Op::function && in.op != Op::square) machine.series(in.b)[0] += db;
      machine.sweep(0, slot, slot + 1);
      return machine.value(0).finite() ? machine.series(slot)[0] : Multi(0);
    };
    Machine<Multi> machine(tape, 0, {Multi(kParameter)});
    set_inputs(machine, g, 0);
    machine.evaluate();
    const auto partials = machine.partials(slot);
    const Multi zero(0), two_h = Multi(2) * h;
    if (in.op != Op::scale) {  // its first operand does not vary
      EXPECT_LE(test::distance(partials.a, Multi((run(h, zero) - run(-h, zero)) / two_h)), 1e-30)
          << print(e, {}, Format::text);
    }
    if (in.op == Op::multiply || in.op == Op::scale || in.op == Op::divide || in.op == Op::arctan2) {
      EXPECT_LE(test::distance(partials.b, Multi((run(zero, h) - run(zero, -h)) / two_h)), 1e-30)
          << print(e, {}, Format::text);
    }
  }
}

TEST(Compile, ADeepFormulaDoesNotOverflow) {
  Graph g;
  Expr e = g.jet(0, 0);
  for (int k = 0; k < 100000; ++k) e = g.jet(1, 0) + Rational(1, 2) * sin(e);
  const Tape tape = compile({&e, 1});
  Machine<double> machine(tape, 0, {});
  machine.series(tape.inputs[0].slot)[0] = machine.series(tape.inputs[1].slot)[0] = 0.5;
  machine.evaluate();
  double expected = 0.5;
  for (int k = 0; k < 100000; ++k) expected = 0.5 + 0.5 * std::sin(expected);
  EXPECT_NEAR(machine.value(0), expected, 1e-15);  // a contraction: round-offs do not add up
}

TEST(Compile, CommonPartsExistOnce) {
  Graph g;
  const Expr x = g.jet(0, 0), u = exp(sin(x) * cos(x));
  const Expr once[] = {u}, often[] = {u, u * u + u, 3 * u, sin(u) + u};
  EXPECT_LE(compile(often).code.size(), compile(once).code.size() + 12);
}

TEST(EvaluateParameters, MayReferToEachOtherInAnyOrder) {
  Graph g;
  const Expr values[] = {2 * g.parameter(2), g.number(3), g.parameter(1) + g.one()};
  EXPECT_EQ(evaluate_parameters<double>(g, values), (std::vector<double>{8, 3, 4}));
}

}  // namespace
}  // namespace anholon::machine_test
