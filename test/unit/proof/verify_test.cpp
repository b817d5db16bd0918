#include <chrono>
#include <cmath>
#include <functional>
#include <set>

#include <gtest/gtest.h>

#include "numeric/ball.h"
#include "proof/checker/modular.h"
#include "proof/checker/modular_program.h"
#include "proof/checker/real.h"
#include "proof/checker/verify.h"

namespace anholon::verify_test {
namespace {

using Index = Certificate::Index;
using Operation = Certificate::Operation;
using Kind = Certificate::ClaimKind;

// Builds certificates by hand from plain nodes; nothing is simplified.
struct Builder {
  Certificate c;
  struct Expr {
    Builder* b;
    Index node;
  };
  Expr add(Certificate::Node n) {
    c.nodes.push_back(std::move(n));
    return {this, static_cast<Index>(c.nodes.size() - 1)};
  }
  Expr number(const Rational& r) { return add({Operation::number, r, 0, "", {}}); }
  Expr pi() { return add({Operation::pi, 0, 0, "", {}}); }
  Expr symbol(const std::string& name) {
    c.symbols.push_back(name);
    return add({Operation::symbol, 0, static_cast<Index>(c.symbols.size() - 1), "", {}});
  }
  Expr function(const std::string& name, Expr u) { return add({Operation::function, 0, 0, name, {{1, u.node}}}); }
  void zero(Expr left, std::vector<Certificate::Pair> right = {}, Kind kind = Kind::agree) {
    c.claims.push_back({kind, "a", "b", "x", left.node, std::move(right), {}});
  }
  void nonzero(Expr left, Certificate::Witness w, Kind kind = Kind::differ) {
    c.claims.push_back({kind, "a", "b", "x", left.node, {}, std::move(w)});
  }
};
using Expr = Builder::Expr;

Expr operator*(const Rational& k, Expr a) { return a.b->add({Operation::sum, 0, 0, "", {{k, a.node}}}); }
Expr operator+(Expr a, Expr b) { return a.b->add({Operation::sum, 0, 0, "", {{1, a.node}, {1, b.node}}}); }
Expr operator-(Expr a, Expr b) { return a.b->add({Operation::sum, 0, 0, "", {{1, a.node}, {-1, b.node}}}); }
Expr operator-(Expr a, int k) { return a - a.b->number(k); }
Expr operator+(Expr a, int k) { return a + a.b->number(k); }
Expr operator*(Expr a, Expr b) { return a.b->add({Operation::product, 0, 0, "", {{1, a.node}, {1, b.node}}}); }
Expr operator/(Expr a, Expr b) { return a.b->add({Operation::product, 0, 0, "", {{1, a.node}, {-1, b.node}}}); }
Expr pow(Expr a, const Rational& k) { return a.b->add({Operation::product, 0, 0, "", {{k, a.node}}}); }
Expr sqrt(Expr a) { return pow(a, Rational(1, 2)); }
#define ROW(name, ...)                                                                                                 \
  [[maybe_unused]] Expr name(Expr u) { return u.b->function(#name, u); }
#include "expr/elementary.def"
#undef ROW
Expr atan2(Expr y, Expr x) { return y.b->add({Operation::atan2, 0, 0, "", {{1, y.node}, {1, x.node}}}); }

using Formula = std::function<Expr(Expr, Expr, Expr)>;

ClaimFinding check(const Formula& f, VerifyOptions options = {}) {
  Builder b;
  const Expr x = b.symbol("x"), y = b.symbol("y"), z = b.symbol("z");
  b.zero(f(x, y, z));
  // The certificate is written and read, so that the written text is checked.
  return verify(read_certificate(to_json(b.c)), options).claims[0];
}

struct Law {
  const char* name;
  Formula zero, mutant;
};

const std::vector<Law>& laws() {
  static const Rational half(1, 2), third(1, 3);
  static const std::vector<Law> all{
      {"a number", [](Expr x, Expr, Expr) { return x - x + 0; }, [](Expr x, Expr, Expr) { return x - x + 1; }},
      {"(x+y)^2", [](Expr x, Expr y, Expr) { return pow(x + y, 2) - (pow(x, 2) + Rational(2) * (x * y) + pow(y, 2)); },
       [](Expr x, Expr y, Expr) { return pow(x + y, 2) - (pow(x, 2) + Rational(2) * (x * y) - pow(y, 2)); }},
      {"partial fractions",
       [](Expr x, Expr y, Expr) { return pow(x, -1) / (x + y) - pow(y, -1) * (pow(x, -1) - pow(x + y, -1)); },
       [](Expr x, Expr y, Expr) { return pow(x, -1) / (x + y) - pow(y, -1) * (pow(x, -1) - pow(x - y, -1)); }},
      {"Pythagoras", [](Expr x, Expr, Expr) { return pow(sin(x), 2) + pow(cos(x), 2) - 1; },
       [](Expr x, Expr, Expr) { return pow(sin(x), 2) - pow(cos(x), 2) - 1; }},
      {"sin(x+y)", [](Expr x, Expr y, Expr) { return sin(x + y) - (sin(x) * cos(y) + cos(x) * sin(y)); },
       [](Expr x, Expr y, Expr) { return sin(x + y) - (sin(x) * cos(y) - cos(x) * sin(y)); }},
      {"half angles", [](Expr x, Expr, Expr) { return cos(x) - (pow(cos(half * x), 2) - pow(sin(half * x), 2)); },
       [](Expr x, Expr, Expr) { return cos(x) - (pow(cos(third * x), 2) - pow(sin(third * x), 2)); }},
      {"cos 3x",
       [](Expr x, Expr, Expr) { return cos(Rational(3) * x) - (Rational(4) * pow(cos(x), 3) - Rational(3) * cos(x)); },
       [](Expr x, Expr, Expr) { return cos(Rational(3) * x) - (Rational(4) * pow(cos(x), 3) - Rational(2) * cos(x)); }},
      {"tan", [](Expr x, Expr, Expr) { return Rational(1) * tan(x) - sin(x) / cos(x); },
       [](Expr x, Expr, Expr) { return tan(x) - cos(x) / sin(x); }},
      {"tan(x-y)", [](Expr x, Expr y, Expr) { return tan(x - y) * (tan(x) * tan(y) + 1) - (tan(x) - tan(y)); },
       [](Expr x, Expr y, Expr) { return tan(x - y) * (tan(x) * tan(y) - 1) - (tan(x) - tan(y)); }},
      {"quarter turns", [](Expr x, Expr, Expr) { return sin(x + half * x.b->pi()) - cos(x); },
       [](Expr x, Expr, Expr) { return sin(x - half * x.b->pi()) - cos(x); }},
      {"cos(pi/4), cos(pi/12)",
       [](Expr x, Expr, Expr) {
         const Expr pi = x.b->pi(), two = x.b->number(2), six = x.b->number(6);
         return (cos(Rational(1, 4) * pi) - pow(two, Rational(-1, 2))) +
                (cos(Rational(1, 12) * pi) - Rational(1, 4) * (sqrt(six) + sqrt(two)));
       },
       [](Expr x, Expr, Expr) { return cos(Rational(1, 4) * x.b->pi()) + pow(x.b->number(2), Rational(-1, 2)); }},
      {"a tenth of pi and a rest",
       [](Expr x, Expr, Expr) { return sin(Rational(7, 10) * x.b->pi() + x) - cos(Rational(1, 5) * x.b->pi() + x); },
       [](Expr x, Expr, Expr) { return sin(Rational(7, 10) * x.b->pi() + x) - cos(Rational(2, 5) * x.b->pi() + x); }},
      {"angles with numbers inside",
       [](Expr x, Expr, Expr) { return sin(x + 1) - (sin(x) * cos(x.b->number(1)) + cos(x) * sin(x.b->number(1))); },
       [](Expr x, Expr, Expr) { return sin(x + 1) - (sin(x) * cos(x.b->number(1)) + cos(x) * sin(x.b->number(2))); }},
      {"a product as angle",
       [](Expr x, Expr y, Expr) { return cos(x.b->number(2) * (x * y)) - (Rational(2) * pow(cos(y * x), 2) - 1); },
       [](Expr x, Expr y, Expr) { return cos(x.b->number(2) * (x * y)) - (Rational(2) * pow(cos(x * x), 2) - 1); }},
      {"a function inside an angle",
       [](Expr x, Expr y, Expr) { return sin(sin(x + y) + x) - (sin(sin(y + x)) * cos(x) + sin(x) * cos(sin(y + x))); },
       [](Expr x, Expr y, Expr) {
         return sin(sin(x + y) + x) - (sin(sin(y - x)) * cos(x) + sin(x) * cos(sin(y - x)));
       }},
      {"roots of products", [](Expr x, Expr y, Expr) { return sqrt(x) * sqrt(y) - sqrt(x * y); },
       [](Expr x, Expr y, Expr) { return sqrt(x) * sqrt(y) - sqrt(x + y); }},
      {"a speed",
       [](Expr x, Expr y, Expr) {
         const Expr v2 = pow(x, 2) + pow(y, 2);
         return sqrt(v2) - v2 * pow(v2, Rational(-1, 2));
       },
       [](Expr x, Expr y, Expr) {
         const Expr v2 = pow(x, 2) + pow(y, 2);
         return sqrt(v2) - v2 * pow(v2, Rational(-3, 2));
       }},
      {"roots of numbers", [](Expr x, Expr, Expr) { return sqrt(x.b->number(2)) * sqrt(x.b->number(18)) - 6; },
       [](Expr x, Expr, Expr) { return sqrt(x.b->number(2)) * sqrt(x.b->number(18)) + 6; }},
      {"a root that few primes have", [](Expr x, Expr, Expr) { return pow(sqrt(x.b->number(53 * 59)), 2) - 53 * 59; },
       [](Expr x, Expr, Expr) { return pow(sqrt(x.b->number(53 * 59)), 2) - 53 * 61; }},
      {"cube roots",
       [](Expr x, Expr y, Expr) { return pow(pow(x, third), 2) * pow(y, third) - pow(pow(x, 2) * y, third); },
       [](Expr x, Expr y, Expr) { return pow(pow(x, third), 2) * pow(y, third) - pow(x * y, third); }},
      {"a quarter power and a nested root",
       [](Expr x, Expr, Expr) {
         return pow(x, Rational(1, 4)) - sqrt(sqrt(x)) + (pow(sqrt(sqrt(x) + 1), 2) - (sqrt(x) + 1));
       },
       [](Expr x, Expr, Expr) {
         return pow(x, Rational(1, 4)) - sqrt(sqrt(x)) + (pow(sqrt(sqrt(x) + 1), 2) - (sqrt(x) - 1));
       }},
      {"x where its root exists", [](Expr x, Expr, Expr) { return sqrt(pow(x, 2)) * sqrt(x) - x * sqrt(x); },
       [](Expr x, Expr, Expr) { return sqrt(pow(x, 2)) - x; }},
      {"absolute values", [](Expr x, Expr y, Expr) { return abs(x * y) - abs(x) * (y * sign(y)); },
       [](Expr x, Expr y, Expr) { return abs(x * y) - x * y; }},
      {"the absolute value as a root", [](Expr x, Expr, Expr) { return abs(x) - sqrt(pow(x, 2)); },
       [](Expr x, Expr, Expr) { return abs(x) + sqrt(pow(x, 2)); }},
      {"exp of sums", [](Expr x, Expr y, Expr) { return exp(x + half * y) - exp(x) * exp(half * y); },
       [](Expr x, Expr y, Expr) { return exp(x + half * y) - exp(x) * exp(third * y); }},
      {"roots of exp", [](Expr x, Expr y, Expr) { return sqrt(exp(x)) * exp(-1 * y) - exp(half * x - y); },
       [](Expr x, Expr y, Expr) { return sqrt(exp(x)) * exp(-1 * y) - exp(half * x + y); }},
      {"cosh^2 - sinh^2", [](Expr x, Expr, Expr) { return pow(cosh(x), 2) - pow(sinh(x), 2) - 1; },
       [](Expr x, Expr, Expr) { return pow(cosh(x), 2) + pow(sinh(x), 2) - 1; }},
      {"tanh of exp",
       [](Expr x, Expr, Expr) { return tanh(x) - (exp(Rational(2) * x) - 1) / (exp(Rational(2) * x) + 1); },
       [](Expr x, Expr, Expr) { return tanh(x) - (exp(x) - 1) / (exp(x) + 1); }},
      {"signs of numbers",
       [](Expr x, Expr, Expr) { return abs(x.b->number(-53)) - 53 + (sign(x.b->number(Rational(-59, 61))) + 1); },
       [](Expr x, Expr, Expr) { return abs(x.b->number(-53)) + 53; }},
      {"functions of equal arguments",
       [](Expr x, Expr y, Expr) { return log(pow(x + y, 2)) - log(pow(x, 2) + pow(y, 2) + Rational(2) * (x * y)); },
       [](Expr x, Expr y, Expr) { return log(pow(x + y, 2)) - log(pow(x, 2) + pow(y, 2) + x * y); }},
      {"odd functions", [](Expr x, Expr y, Expr) { return atan(x - y) + atan(y - x) + asinh(x) + asinh(-1 * x); },
       [](Expr x, Expr y, Expr) { return atan(x - y) - atan(y - x); }},
      {"acos and asin", [](Expr x, Expr, Expr) { return acos(x) + asin(x) - half * x.b->pi(); },
       [](Expr x, Expr, Expr) { return acos(x) - asin(x) - half * x.b->pi(); }},
      {"an angle of two arguments",
       [](Expr x, Expr y, Expr z) { return pow(sin(atan2(y, x) + z), 2) + pow(cos(z + atan2(y + x - x, x)), 2) - 1; },
       [](Expr x, Expr y, Expr z) { return pow(sin(atan2(y, x) + z), 2) + pow(cos(z + atan2(x, y)), 2) - 1; }},
  };
  return all;
}

TEST(VerifyZero, IdentitiesAreConfirmed) {
  for (const Law& law : laws()) {
    const ClaimFinding f = check(law.zero);
    EXPECT_EQ(f.finding, Finding::confirmed) << law.name << ": " << f.detail;
    EXPECT_LE(f.log2_chance, -40) << law.name;
    EXPECT_FALSE(f.proved);
  }
}

TEST(VerifyZero, MutantsAreContradicted) {
  for (const Law& law : laws()) {
    const ClaimFinding f = check(law.mutant);
    EXPECT_EQ(f.finding, Finding::contradicted) << law.name << ": " << f.detail;
    EXPECT_NE(f.detail.find("the difference is"), std::string::npos) << law.name;
  }
}

// Finite fields alone distinguish the mutants from identities, for any seed.
TEST(VerifyZero, TheTestModuloPrimesStandsAlone) {
  for (int seed = 0; seed < 5; ++seed)
    for (const Law& law : laws()) {
      for (const bool mutant : {false, true}) {
        Builder b;
        const Expr x = b.symbol("x"), y = b.symbol("y"), z = b.symbol("z");
        b.zero((mutant ? law.mutant : law.zero)(x, y, z));
        verification::Work work;
        const auto found = verification::test_zero(b.c, hash_key(std::to_string(seed)), 2, work)[0];
        using Is = verification::ModularFinding::Is;
        EXPECT_EQ(found.is, mutant ? Is::nonzero : Is::zero) << law.name << ' ' << found.detail;
      }
    }
}

// A formula without a rule is not confirmed, and as no real point shows a difference, it is not contradicted.
TEST(VerifyZero, WhatHasNoRuleIsLeftOpen) {
  for (const Formula& f :
       std::vector<Formula>{[](Expr x, Expr y, Expr) { return log(x * y) - log(x) - log(y); },
                            [](Expr x, Expr, Expr) { return sin(asin(x)) - x; },
                            [](Expr x, Expr, Expr) { return sqrt(pow(pow(x, 2) + 1, 2)) - (pow(x, 2) + 1); }}) {
    const ClaimFinding found = check(f);
    EXPECT_EQ(found.finding, Finding::unchecked);
    EXPECT_NE(found.detail.find("not zero by the rules"), std::string::npos) << found.detail;
  }
  EXPECT_EQ(check([](Expr x, Expr, Expr) { return (x - x) / (x - x); }).detail,
            "no point was found where it is defined");
  EXPECT_EQ(check([](Expr x, Expr, Expr) { return sqrt(x) + sqrt(-1 * x) - sqrt(x) - sqrt(-1 * x); }).detail,
            "no point was found where it is defined and its roots exist");
}

// A multiple of the known primes vanishes modulo each of them, but not at real points.
TEST(VerifyZero, NumbersMadeForThePrimesAreContradicted) {
  Rational product = 1;
  for (const auto p : verification::kPrimes) product *= Rational(p);
  const ClaimFinding f = check([&](Expr x, Expr, Expr) { return product * x; });
  EXPECT_EQ(f.finding, Finding::contradicted);
}

// At a prime without a small non-residue, the choice of signs must agree with that of real numbers.
TEST(VerifyZero, SignsThatOnlyAPrimeChoosesAreContradicted) {
  const ClaimFinding f = check(
      [](Expr x, Expr, Expr) { return sqrt(pow(x, 2)) / x + sqrt(pow(Rational(53) * x, 2)) / (Rational(53) * x); });
  EXPECT_EQ(f.finding, Finding::contradicted);
}

TEST(VerifyZero, TheBoundFollowsTheDegree) {
  const auto power = [](int n) { return [n](Expr x, Expr y, Expr) { return pow(x + y, n) * pow(x + y, -n) - 1; }; };
  const double low = check(power(2)).log2_chance, high = check(power(1000)).log2_chance;
  EXPECT_LT(low, high);
  EXPECT_LE(high, -40);
  EXPECT_LT(check(power(2), {12, 0}).log2_chance, low);
  // The degree of x^(1000^7) saturates, and does not wrap around.
  const ClaimFinding none = check([](Expr x, Expr, Expr) {
    Expr t = x, s = x;
    for (int i = 0; i < 7; ++i) t = pow(t, 1000), s = pow(s, 1000);
    return t - s;
  });
  EXPECT_EQ(none.finding, Finding::unchecked);
  EXPECT_NE(none.detail.find("degree is too high"), std::string::npos);
}

TEST(VerifyZero, CombinationsAndKernels) {
  // Φ = (−x, 1), B = (1, x): Φ B = 0, and x·(y/x) is y.
  const auto build = [](int sign, bool swap) {
    Builder b;
    const Expr x = b.symbol("x"), y = b.symbol("y"), one = b.number(1), minus = Rational(sign) * x, q = y / x;
    b.zero(minus * one + one * x, {}, Kind::kernel);
    b.zero(y, {{swap ? q.node : x.node, q.node}});
    b.zero(b.number(0), {{minus.node, one.node}, {one.node, x.node}}, Kind::kernel);
    return verify(b.c);
  };
  EXPECT_TRUE(build(-1, false).all_confirmed());
  const Verification v = build(1, true);
  for (const ClaimFinding& f : v.claims) EXPECT_EQ(f.finding, Finding::contradicted);
  EXPECT_FALSE(Verification{}.all_confirmed()) << "an empty certificate confirms nothing";
}

// A claim with a root of x must not keep another claim from the points at which x is no square.
TEST(VerifyZero, ClaimsDoNotHelpEachOther) {
  Builder b;
  const Expr x = b.symbol("x");
  b.zero(sqrt(x) - sqrt(x));
  b.zero(sqrt(pow(x, 2)) - x);
  b.zero(abs(x) - x);
  b.zero(pow(x - x, -1));
  b.zero(x - x);
  const Verification v = verify(b.c);
  EXPECT_EQ(v.claims[0].finding, Finding::confirmed);
  EXPECT_EQ(v.claims[1].finding, Finding::contradicted);
  EXPECT_EQ(v.claims[2].finding, Finding::contradicted);
  EXPECT_EQ(v.claims[3].finding, Finding::unchecked);
  EXPECT_EQ(v.claims[4].finding, Finding::confirmed) << v.claims[4].detail;
}

// Every change of one node of a true certificate is noticed, unless the function stays the same.
TEST(VerifyZero, TamperedNodesAreNoticed) {
  Builder b;
  const Expr x = b.symbol("x"), y = b.symbol("y");
  b.zero((sin(x + y) - (sin(x) * cos(y) + cos(x) * sin(y))) * pow(x, 2) + pow(x + y, 2) -
         (pow(x, 2) + Rational(2) * (x * y) + pow(y, 2)));
  ASSERT_TRUE(verify(b.c).all_confirmed());
  int noticed = 0;
  for (std::size_t i = 0; i < b.c.nodes.size(); ++i)
    for (std::size_t k = 0; k < b.c.nodes[i].terms.size(); ++k) {
      if (b.c.nodes[i].operation == Operation::function) continue;
      for (const Rational& by : {Rational(1), Rational(-2), Rational(1, 3)}) {
        Certificate c = b.c;
        c.nodes[i].terms[k].weight += by;
        const ClaimFinding f = verify(c).claims[0];
        // A change of the factor x², or of the factor that is zero itself, leaves the claim true, unless the latter
        // becomes 1/0.
        if (f.finding == Finding::confirmed) continue;
        ++noticed;
        if (f.detail == "no point was found where it is defined") continue;
        EXPECT_EQ(f.finding, Finding::contradicted) << "node " << i << ", term " << k << ": " << f.detail;
      }
    }
  EXPECT_GT(noticed, 60);
}

TEST(VerifyZero, TheSameTextGivesTheSameAnswer) {
  Builder b;
  const Expr x = b.symbol("x"), y = b.symbol("y");
  b.zero(sin(x) - y);
  const std::string first = verify(b.c).claims[0].detail;
  EXPECT_EQ(verify(b.c).claims[0].detail, first);
  EXPECT_NE(verify(b.c, {6, 1}).claims[0].detail, first) << "the seed chooses other points";
  b.c.meaning = "another";
  EXPECT_NE(verify(b.c).claims[0].detail, first) << "so does the text";
}

// A chain of doublings is small as a certificate, but its numbers are enormous.
TEST(Verify, HostileCertificatesEnd) {
  const auto start = std::chrono::steady_clock::now();
  for (const int kind : {0, 1, 2, 3}) {
    Builder b;
    Expr x = b.symbol("x");
    for (int i = 0; i < 400; ++i) {
      if (kind == 0) x = pow(x, 1'000'000'000);
      if (kind == 1) x = x + sin(Rational(1, 1'000'003 + i) * x);
      if (kind == 2 && i < 40) x = sqrt(x + 1);
      if (kind == 3) x = Rational(mpz_class(1) << 2000, mpz_class("3")) * exp(x);
    }
    b.zero(x);
    b.zero(x - x);
    b.nonzero(x, {{{0, Rational(3)}}, {}, {}});
    verify(b.c);
  }
  EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::seconds(60));
}

// Not zero

struct Witnessed {
  Builder b;
  Expr x = b.symbol("x"), y = b.symbol("y");
};

TEST(VerifyNonzero, AtARationalPoint) {
  Witnessed w;
  const Certificate::Witness at{{{0, Rational(1, 2)}, {1, Rational(-1, 3)}}, {}, {}};
  w.b.nonzero(sin(w.x) - w.y, at);
  w.b.nonzero(w.x + Rational(3, 2) * w.y, at, Kind::pivot);
  w.b.nonzero(pow(sin(w.x), 2) + pow(cos(w.x), 2) - 1, at);
  w.b.nonzero(log(w.y), at);
  const Verification v = verify(w.b.c);
  EXPECT_EQ(v.claims[0].finding, Finding::confirmed);
  EXPECT_TRUE(v.claims[0].proved);
  EXPECT_NE(v.claims[1].finding, Finding::confirmed) << "1/2 + 3/2 (−1/3) = 0";
  EXPECT_EQ(v.claims[2].finding, Finding::unchecked) << v.claims[2].detail;
  EXPECT_EQ(v.claims[3].detail, "it is not defined at the witness");
  w.b.c.claims[0].witness->values.pop_back();
  EXPECT_EQ(verify(w.b.c).claims[0].detail, "the witness has no value of 'y'");
}

TEST(VerifyNonzero, WithAsManyDigitsAsItTakes) {
  Witnessed w;
  mpz_class huge;
  mpz_ui_pow_ui(huge.get_mpz_t(), 10, 400);
  w.b.nonzero(pow(sin(w.x), 2) + pow(cos(w.x), 2) - w.b.number(Rational(huge + 1, huge)),
              {{{0, Rational(1, 2)}}, {}, {}});
  VerifyOptions options;
  EXPECT_EQ(verify(w.b.c, options).claims[0].finding, Finding::unchecked);
  options.digits = 500;
  EXPECT_EQ(verify(w.b.c, options).claims[0].finding, Finding::confirmed);
}

// x² + y² = 2, x = y·tan(π/4 …) at (1, 1): the constraint, moved off, must not be believed.
TEST(VerifyNonzero, AtARootOfConstraints) {
  Witnessed w;
  const Expr circle = pow(w.x, 2) + pow(w.y, 2) - 2, line = exp(w.x - w.y) - 1,
             tiny = w.x - sqrt(w.x.b->number(Rational(1000001, 1000000)));
  const auto at = [&](const Rational& x, const Rational& y, const Rational& radius) {
    return Certificate::Witness{{}, {{0, x, radius}, {1, y, radius}}, {circle.node, line.node}};
  };
  const Rational small(1, 1000);
  w.b.nonzero(w.x + w.y, at(1, 1, small));
  w.b.nonzero(tiny, at(1, 1, small));
  w.b.nonzero(w.x + w.y, at(-1, -1, small));
  w.b.nonzero(w.x + w.y, at(Rational(11, 10), 1, small));
  w.b.nonzero(w.x + w.y, at(Rational(999, 1000), 1, small));
  w.b.nonzero(w.x - w.y, at(1, 1, small));
  w.b.nonzero(w.x + w.y, at(0, 0, 2));
  const Verification v = verify(w.b.c);
  EXPECT_EQ(v.claims[0].finding, Finding::confirmed) << v.claims[0].detail;
  EXPECT_EQ(v.claims[1].finding, Finding::confirmed) << "the root is known better than the box: " << v.claims[1].detail;
  EXPECT_EQ(v.claims[2].finding, Finding::confirmed) << v.claims[2].detail;
  EXPECT_EQ(v.claims[3].finding, Finding::contradicted) << v.claims[3].detail;
  EXPECT_EQ(v.claims[4].finding, Finding::unchecked) << "the root is on the edge: " << v.claims[4].detail;
  EXPECT_EQ(v.claims[5].finding, Finding::unchecked) << "zero at the root: " << v.claims[5].detail;
  EXPECT_EQ(v.claims[6].finding, Finding::unchecked) << "two roots: " << v.claims[6].detail;
}

TEST(VerifyNonzero, ADoubleRootIsNoWitness) {
  Witnessed w;
  const Expr square = pow(w.x - 1, 2);
  w.b.nonzero(w.x, {{}, {{0, Rational(1), Rational(1, 100)}}, {square.node}});
  EXPECT_EQ(verify(w.b.c).claims[0].detail, "no root of the witness's equations could be proved in its box");
}

// Derivatives are compared with difference quotients, for all functions.
TEST(RealProgram, DerivativesAreThoseOfTheValues) {
  const BallScope precision(256);
  for (const std::string& name : Certificate::functions()) {
    Builder b;
    const Expr x = b.symbol("x"), y = b.symbol("y");
    const Rational at = name == "acosh" ? Rational(7, 4) : Rational(2, 5);
    const Expr f = pow(b.function(name, x * y), 3) * pow(y, Rational(-3, 2)) + atan2(y, x);
    b.zero(f);
    verification::RealProgram program(b.c, {&b.c.claims[0]});
    const auto value = [&](const Rational& dx, const Rational& dy) {
      program.evaluate({Ball(Rational(at + dx)), Ball(Rational(1 + dy))});
      return program.value(f.node);
    };
    const Rational h(1, mpz_class(1) << 60);
    const Ball by_x = (value(h, 0) - value(-h, 0)) * Ball(Rational(1 / (2 * h))),
               by_y = (value(0, h) - value(0, -h)) * Ball(Rational(1 / (2 * h)));
    value(0, 0);
    const std::vector<Ball> gradient = program.jacobian({f.node}, {0, 1});
    const Ball allowance(Rational(0), Rational(1, mpz_class(1) << 80));
    EXPECT_TRUE((gradient[0] - by_x + allowance).contains_zero()) << name;
    EXPECT_TRUE((gradient[1] - by_y + allowance).contains_zero()) << name;
    EXPECT_FALSE((gradient[0] + by_x + allowance).contains_zero()) << name;
  }
}

// The fields

TEST(VerifyModular, ThePrimesAreSafeAndSmallPrimesAreSquares) {
  std::set<std::uint64_t> distinct;
  for (const std::uint64_t p : verification::kPrimes) {
    const mpz_class prime(std::to_string(p)), r = (prime - 1) / 2;
    EXPECT_GT(mpz_probab_prime_p(prime.get_mpz_t(), 40), 0) << p;
    EXPECT_GT(mpz_probab_prime_p(r.get_mpz_t(), 40), 0) << p;
    EXPECT_LT(prime, mpz_class(1) << 61);
    EXPECT_GT(prime, (mpz_class(1) << 61) - (mpz_class(1) << 30)) << "what Field::multiply needs";
    for (const int small : {2, 3, 5, 7, 11, 13, 17, 19, 23, 29, 31, 37, 41, 43, 47})
      EXPECT_TRUE(verification::Field(p).is_square(small)) << small;
    EXPECT_FALSE(verification::Field(p).is_square(p - 1));
    distinct.insert(p);
  }
  EXPECT_EQ(distinct.size(), 16u);
}

TEST(VerifyModular, MultiplicationIsThatOfIntegers) {
  const HashKey key = hash_key("multiplication");
  for (const std::uint64_t p : verification::kPrimes) {
    const verification::Field f(p);
    for (std::uint64_t i = 0; i < 200; ++i) {
      const std::array<std::uint64_t, 1> one{2 * i}, two{2 * i + 1};
      const std::uint64_t a = i < 3 ? p - 1 - i : siphash(key, one) % p, b = i < 2 ? p - 1 : siphash(key, two) % p;
      const mpz_class exact =
          mpz_class(std::to_string(a)) * mpz_class(std::to_string(b)) % mpz_class(std::to_string(p));
      EXPECT_EQ(std::to_string(f.multiply(a, b)), exact.get_str());
      EXPECT_EQ(f.multiply(a, f.inverse(a)), a == 0 ? 0u : 1u);
    }
    EXPECT_EQ(f.multiply(*f.from(Rational(-22, 7)), 7), p - 22);
    EXPECT_FALSE(f.from(Rational(1, mpz_class(std::to_string(p)))));
  }
}

}  // namespace
}  // namespace anholon::verify_test
