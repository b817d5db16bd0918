// Equal expressions built in any order have the same id.
#include <algorithm>
#include <random>

#include <gtest/gtest.h>

#include "base/diagnostic.h"
#include "expr/diff.h"
#include "support/random_expr.h"
#include "support/value.h"

namespace anholon::canonical_test {
namespace {

using test::RandomExpr;

struct Symbols {
  Graph g;
  Expr x = g.jet(0, 0), y = g.jet(1, 0), xd = g.jet(0, 1), a = g.parameter(0), t = g.time();
};

// Joins the items in a random order and with random brackets.
Expr joined(std::vector<Expr> items, std::mt19937& random, Expr (*join)(Expr, Expr)) {
  std::shuffle(items.begin(), items.end(), random);
  while (items.size() > 1) {
    const std::size_t k = random() % (items.size() - 1);
    items[k] = join(items[k], items[k + 1]);
    items.erase(items.begin() + static_cast<std::ptrdiff_t>(k) + 1);
  }
  return items[0];
}
Expr add(Expr a, Expr b) { return a + b; }
Expr multiply(Expr a, Expr b) { return a * b; }

TEST(Canonical, SumsOfUpToFortyTermsDoNotDependOnOrderAndBrackets) {
  Symbols s;
  std::vector<Expr> atoms = {s.x, s.y, s.xd, s.a, s.t, s.g.one()};
  for (std::uint32_t k = 2; k < 14; ++k)
    atoms.push_back(s.g.jet(k, 0)), atoms.push_back(sin(s.g.jet(k, 0)) * s.g.jet(k, 1));
  std::mt19937 random(1);
  for (int round = 0; round < 60; ++round) {
    RandomExpr make(s.g, 100 + static_cast<std::uint32_t>(round), atoms);
    std::vector<Expr> terms;
    for (int k = 2 + make.below(39); k > 0; --k) terms.push_back(make.coefficient() * make.atom());
    const Expr at_once = sum(terms);
    for (int order = 0; order < 10; ++order) ASSERT_EQ(joined(terms, random, add).id, at_once.id);
    terms[0] = terms[0] + s.xd;
    ASSERT_NE(joined(terms, random, add).id, at_once.id) << "mutant: one term changed";
  }
}

TEST(Canonical, ProductsOfUpToTwentyFactorsDoNotDependOnOrderAndBrackets) {
  Symbols s;
  const std::vector<Expr> atoms = {
      s.x, s.y, s.a, s.t, 1 + s.x, 2 * s.x + 4 * s.y, s.g.number(Rational(-3, 2)), -s.xd, sin(s.x), s.x * s.y};
  std::mt19937 random(2);
  for (int round = 0; round < 60; ++round) {
    RandomExpr make(s.g, 200 + static_cast<std::uint32_t>(round), atoms);
    std::vector<Expr> factors;
    for (int k = 2 + make.below(19); k > 0; --k) {
      const int exponent = make.below(7) - 3;
      factors.push_back(pow(make.atom(), exponent == 0 ? 1 : exponent));
    }
    std::vector<std::pair<Expr, Rational>> list;
    for (Expr f : factors) list.push_back({f, 1});
    const Expr at_once = s.g.product(list);
    for (int order = 0; order < 10; ++order) ASSERT_EQ(joined(factors, random, multiply).id, at_once.id);
    factors[0] = factors[0] * s.y;
    ASSERT_NE(joined(factors, random, multiply).id, at_once.id) << "mutant: one factor changed";
  }
}

TEST(Canonical, ProductsOfRootsDoNotDependOnOrderAndBrackets) {
  Symbols s;
  const std::vector<Expr> atoms = {sqrt(s.x),        sqrt(s.y),       sqrt(1 + s.x),
                                   pow(s.x, {1, 3}), sqrt(s.x * s.y), sqrt(1 + s.x * s.x)};
  std::mt19937 random(3);
  for (int round = 0; round < 60; ++round) {
    RandomExpr make(s.g, 300 + static_cast<std::uint32_t>(round), atoms);
    std::vector<Expr> factors;
    for (int k = 2 + make.below(7); k > 0; --k) factors.push_back(make.atom());
    const Expr once = joined(factors, random, multiply);
    for (int order = 0; order < 10; ++order) ASSERT_EQ(joined(factors, random, multiply).id, once.id);
  }
}

TEST(Canonical, ProductsOfRootsOfNumbersAndOfSumsWithAContentDoNotDependOnBrackets) {
  Symbols s;
  for (Expr u : {s.g.number(2), 2 * s.x + 2 * s.y}) {
    const Expr root = sqrt(u);
    EXPECT_EQ(((root * root) * root).id, pow(u, {3, 2}).id);
    EXPECT_EQ((root * root).id, u.id);
  }
}

TEST(Folding, RationalsAreExact) {
  Symbols s;
  const auto number = [&](int p, int q = 1) { return s.g.number(Rational(p, q)); };
  EXPECT_EQ(number(1, 3) + number(1, 6), number(1, 2));
  EXPECT_EQ(number(2, 3) * number(3, 2), s.g.one());
  EXPECT_EQ(pow(number(2, 3), -2), number(9, 4));
  EXPECT_EQ(sqrt(number(9, 4)), number(3, 2));
  EXPECT_EQ(s.x - s.x, s.g.zero());
  EXPECT_EQ(s.x / s.x, s.g.one());
  EXPECT_EQ(Rational(1, 10) * s.x + Rational(2, 10) * s.x, Rational(3, 10) * s.x);
  EXPECT_EQ(0 * s.x, s.g.zero());
  EXPECT_EQ(pow(s.x + s.y, 0), s.g.one());
}

TEST(Folding, RootsJoin) {
  Symbols s;
  const Expr root = sqrt(s.g.number(2));
  EXPECT_EQ(root * root, s.g.number(2));
  EXPECT_EQ(sqrt(s.x) * sqrt(s.x), s.x);
  EXPECT_EQ(sqrt(1 + s.x) * sqrt(1 + s.x), 1 + s.x);
  EXPECT_EQ(pow(sqrt(s.x), 4), s.x * s.x);
  EXPECT_NE(sqrt(s.x * s.x), s.x) << "sqrt(x^2) is |x|";
  EXPECT_NE(sqrt(s.x * s.y), sqrt(s.x) * sqrt(s.y)) << "false where both are negative";
}

TEST(Folding, SpecialValuesAndParity) {
  Symbols s;
  EXPECT_EQ(sin(s.g.zero()), s.g.zero());
  EXPECT_EQ(cos(s.g.pi()), s.g.number(-1));
  EXPECT_EQ(sin(Rational(5, 6) * s.g.pi()), s.g.number(Rational(1, 2)));
  EXPECT_EQ(cos(Rational(-7, 3) * s.g.pi()), s.g.number(Rational(1, 2)));
  EXPECT_EQ(exp(s.g.zero()), s.g.one());
  EXPECT_EQ(abs(s.g.number(-3)), s.g.number(3));
  EXPECT_EQ(atan2(s.g.zero(), s.g.one()), s.g.zero());
  for (Expr u : {s.x, s.x - s.y, s.x * s.y, Rational(2, 3) * s.x}) {
    EXPECT_EQ(sin(-u), -sin(u));
    EXPECT_EQ(cos(-u), cos(u));
    EXPECT_EQ(atanh(-u), -atanh(u));
    EXPECT_EQ(cosh(-u), cosh(u));
    EXPECT_EQ(abs(-u), abs(u));
    EXPECT_NE(exp(-u), exp(u));
    EXPECT_NE(acos(-u), -acos(u));
  }
}

TEST(Folding, EveryRationalMultipleOfPiHasTheRightSine) {
  Symbols s;
  const PrecisionScope precision(40);
  int folded = 0;
  for (int k = -24; k <= 24; ++k) {
    const Rational sixths(k, 6);
    const Expr angle = sixths * s.g.pi();
    const Multi radians = pi<Multi>() * Multi(k) / Multi(6);
    EXPECT_LE(test::distance(test::value(sin(angle), test::Point()), sin(radians)), 1e-38) << k << " pi/6";
    EXPECT_LE(test::distance(test::value(cos(angle), test::Point()), cos(radians)), 1e-38) << k << " pi/6";
    folded += is_number(sin(angle));
    const Rational quarters(k, 4);
    const Multi of_quarters = pi<Multi>() * Multi(k) / Multi(4);
    const Expr sine = sin(quarters * s.g.pi()), cosine = cos(quarters * s.g.pi());
    EXPECT_LE(test::distance(test::value(sine, test::Point()), sin(of_quarters)), 1e-38) << k << " pi/4";
    EXPECT_LE(test::distance(test::value(cosine, test::Point()), cos(of_quarters)), 1e-38) << k << " pi/4";
    EXPECT_EQ(sine * sine + cosine * cosine, s.g.one());
  }
  EXPECT_GT(folded, 30) << "two of three of these sines are rational";
}

TEST(Folding, MultiplesOfPiComeOutOfSums) {
  Symbols s;
  const Expr quarter = Rational(1, 2) * s.g.pi(), x = s.x;
  EXPECT_EQ(cos(quarter - x), sin(x));
  EXPECT_EQ(sin(quarter - x), cos(x));
  EXPECT_EQ(sin(x + s.g.pi()), -sin(x));
  EXPECT_EQ(cos(x - 3 * quarter), -sin(x));
  EXPECT_EQ(sin(x + Rational(1, 3) * s.g.pi()), cos(x - Rational(1, 6) * s.g.pi()));
  EXPECT_NE(sin(x + Rational(1, 8) * s.g.pi()), sin(x));
  for (const int quarters : {-3, -1, 1, 3, 5}) {
    const Expr u = x + Rational(quarters, 4) * s.g.pi(), w = Rational(quarters, 4) * s.g.pi() - x;
    EXPECT_EQ(sin(-u), -sin(u));
    EXPECT_EQ(cos(-u), cos(u));
    EXPECT_EQ(sin(u + s.g.pi()), -sin(u));
    EXPECT_EQ(cos(-w), cos(w));
  }
  const PrecisionScope precision(40);
  test::Point point;
  point.set(x, Multi(3) / Multi(7));
  for (int k = -60; k <= 60; ++k) {
    const Expr angle = 2 * x + Rational(k, 20) * s.g.pi();
    const Multi radians = Multi(6) / Multi(7) + pi<Multi>() * Multi(k) / Multi(20);
    EXPECT_LE(test::distance(test::value(sin(angle), point), sin(radians)), 1e-37) << k << " pi/20";
    EXPECT_LE(test::distance(test::value(cos(angle), point), cos(radians)), 1e-37) << k << " pi/20";
  }
}

// A point of a chain is the previous point and one link: x_i = x_(i-1) + l cos(q_i).
std::size_t operations_of_a_chain(std::uint32_t links) {
  Graph g;
  Expr x = g.zero();
  Column positions;
  for (std::uint32_t i = 0; i < links; ++i) positions.push_back(x = x + g.parameter(0) * cos(g.jet(i, 0)));
  std::size_t operands = 0;
  for (NodeId id : reachable(positions)) operands += g.summands(id).size();
  return operands;
}

TEST(Summands, PositionsOfAChainCostLinearWork) {
  const std::size_t at100 = operations_of_a_chain(100), at200 = operations_of_a_chain(200),
                    at400 = operations_of_a_chain(400);
  const double first = static_cast<double>(at200 - at100), second = static_cast<double>(at400 - at200);
  EXPECT_NEAR(second / first, 2, 0.1) << "linear beyond the first few links: " << at100 << ", " << at200 << ", "
                                      << at400;
  EXPECT_LE(at200, 200U * 8) << "a cosine, a product and two terms per link, not 200 terms";
}

TEST(Summands, TheShortWayHasTheValueOfTheFlatTerms) {
  Graph g;
  const PrecisionScope precision(40);
  std::vector<Expr> atoms;
  for (std::uint32_t k = 0; k < 30; ++k) atoms.push_back(g.jet(k, 0));
  RandomExpr make(g, 4, atoms);
  Expr e = g.one();
  int short_ways = 0;
  for (int k = 0; k < 200; ++k) {
    e = make.coefficient() * e + make.coefficient() * make.atom();
    const test::Point at(7);
    const Multi flat = test::value(e, at);
    Multi by_short_way(0);
    for (const Term& t : g.summands(e.id))
      by_short_way += Multi(g.rational(t.weight)) * test::value(Expr{&g, t.node}, at);
    if (g.summands(e.id).size() < g.terms(e.id).size()) ++short_ways;
    ASSERT_LE(test::distance(flat, by_short_way), 1e-35);
  }
  EXPECT_GT(short_ways, 10) << "otherwise this test shows nothing";
}

// A long sum is one term of another sum, also if it is scaled: as a factor it keeps its content.
TEST(Summands, LongSumsWithAContentAreFactors) {
  Graph g;
  g.allow(1'000'000);
  std::vector<std::pair<Rational, Expr>> terms;
  for (std::uint32_t k = 0; k < 100; ++k) terms.push_back({6, g.jet(k, 0)});
  const Expr e = g.sum(terms);
  const Expr x = g.jet(0, 1), inverse = pow(e, Rational(-1));
  EXPECT_EQ(x * inverse * e, x);
  EXPECT_EQ((x / (Rational(1, 3) * e)) * e, 3 * x);
}

TEST(Budget, StopsWhatUnfoldsWithoutEnd) {
  Graph g;
  g.allow(10'000);
  Expr e = g.jet(0, 0) + g.jet(1, 0);
  EXPECT_NO_THROW(for (int k = 0; k < 10; ++k) e = 1 + e * sin(e););
  EXPECT_THROW(e = total_derivative(e * exp(e), 20), Failure);
  // With more operations allowed, the derivation continues.
  g.allow(1'000'000);
  EXPECT_NO_THROW(total_derivative(e));
}

TEST(Budget, LongNumbersCostMore) {
  Graph g;
  g.allow(100'000);
  Expr e = g.number(Rational(3, 7));
  EXPECT_THROW(for (int k = 0; k < 60; ++k) e = e * e + g.number(Rational(1, 3)), Failure);
  EXPECT_LT(number_value(e).bits(), 1'000'000U);
}

TEST(Rates, OfSharedPartsAreMadeOnce) {
  Graph g;
  Expr p = g.zero();
  std::uint64_t spent = 0;
  for (std::uint32_t k = 0; k < 200; ++k) {
    p = p + sin(g.jet(k, 0));
    const std::uint64_t before = g.work();
    (void)total_derivative(p);
    if (k == 100) spent = g.work() - before;
    if (k == 199) {
      EXPECT_LE(g.work() - before, 2 * spent + 10) << "one more link each time, not all of them";
    }
  }
}

// References to a number, a node or its terms are read while the graph grows.
TEST(Canonical, WhatAGraphGivesNeverMoves) {
  Symbols s;
  const Expr e = 3 + Rational(22, 7) * s.x + s.y * s.a;
  const Node& node = s.g.node(e.id);
  const Rational& weight = s.g.rational(s.g.terms(e.id)[0].weight);
  const std::span<const Term> terms = s.g.terms(e.id);
  Expr growing = s.x;
  for (int k = 1; k < 5'000; ++k) growing = sin(growing) + Rational(k, 5'001) * s.t;
  EXPECT_EQ(&node, &s.g.node(e.id));
  EXPECT_EQ(&weight, &s.g.rational(s.g.terms(e.id)[0].weight));
  EXPECT_EQ(terms.data(), s.g.terms(e.id).data());
  EXPECT_EQ(terms.size(), s.g.terms(e.id).size());
}

}  // namespace
}  // namespace anholon::canonical_test
