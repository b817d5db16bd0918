// Every form is proved to be equivalent to Routh's equations. A form with one changed sign is refuted by a witness,
// which other arithmetic checks. The sign is that of a summand of a side of an equation, or of a sum inside it: of all
// summands under ANHOLON_LONG=1, otherwise of one of each kind in every side of every equation.
#include <cstdlib>

#include <gtest/gtest.h>

#include "proof/checker/verify.h"
#include "proof/prove.h"
#include "setup/eliminate.h"
#include "support/manifold.h"
#include "support/models.h"

namespace anholon::form_mutants_test {
namespace {

constexpr double kZero = 1e-30;       // 60 digits, in units of the terms
constexpr double kAgreement = 1e-25;  // of the difference at a witness with the change that was made

bool at_length() { return std::getenv("ANHOLON_LONG") != nullptr; }

struct System {
  std::shared_ptr<const Model> model;
  Mechanics m;
  std::vector<Eliminations> eliminations;  // constraints solved, and not solved
  explicit System(const std::string& name) : model(test::shipped(name)), m(mechanics(*model)) {
    for (const bool solve : {true, false})
      eliminations.push_back({elimination_for(m, Unknowns::coordinates, {}, {}, solve),
                              elimination_for(m, Unknowns::quasi_velocities, {}, {}, solve)});
  }
  Graph& g() const { return *model->graph; }
};

const System& system_of(const std::string& name) {
  static std::map<std::string, std::unique_ptr<System>> known;
  std::unique_ptr<System>& s = known[name];
  if (!s) s = std::make_unique<System>(name);
  return *s;
}

// One changed sign in one equation of a form.
struct Mutant {
  bool left = true, inside = false;
  std::size_t equation = 0;
  NodeId sum = 0;  // the sum that contains the summand
  std::size_t summand = 0;

  Expr changed(Expr e) const {
    Graph& g = *e.graph;
    const Term t = g.terms(sum)[summand];
    const Expr term = g.is_number(t.node) ? g.number(g.rational(t.weight) * g.value(t.node))
                                          : g.rational(t.weight) * Expr{&g, t.node};
    const Expr whole{&g, sum};
    return replace_nodes({&e, 1}, {{sum, whole - 2 * term}})[0];
  }
  Equations of(Equations q) const {
    Expr& e = (left ? q.left : q.right)[equation];
    e = changed(e);
    return q;
  }
};

// For each side of each equation, the mutants of at most `most` of its summands and of as many summands of sums inside
// it.
std::vector<Mutant> mutants_of(const Equations& q, std::size_t most) {
  std::vector<Mutant> out;
  const auto some = [&](std::vector<Mutant> list) {
    const std::size_t step = std::max<std::size_t>(1, list.size() / most);
    for (std::size_t k = 0; k < list.size() && k / step < most; k += step) out.push_back(list[k]);
  };
  for (const bool left : {true, false})
    for (std::size_t i = 0; i < q.left.size(); ++i) {
      const Expr e = (left ? q.left : q.right)[i];
      if (is_zero(e)) continue;
      Graph& g = *e.graph;
      std::vector<Mutant> top, inside;
      for (NodeId id : reachable({&e, 1})) {
        if (g.node(id).kind != Kind::sum) continue;
        for (std::size_t k = 0; k < g.terms(id).size(); ++k)
          (id == e.id ? top : inside).push_back({left, id != e.id, i, id, k});
      }
      some(top);
      some(inside);
    }
  return out;
}

// The terms that the change adds to the equations that are compared with Routh's.
Column expected(const System& s, const Formulation& form, const Elimination& e, const Equations& right,
                const Equations& wrong) {
  const Column delta = (wrong.left - wrong.right) - (right.left - right.right);
  const bool along = form.unknowns != Unknowns::multipliers && delta.size() == s.m.q.size() && !e.constraints.empty();
  return along ? e.contract(delta) : delta;
}

double largest(const std::vector<Multi>& values) {
  double l = 0;
  for (const Multi& v : values) l = std::max(l, std::abs(to_double(v)));
  return l;
}

bool vanishes(const System& s, const Elimination& e, const Column& column) {
  for (std::uint64_t seed = 1; seed <= 2; ++seed) {
    const std::optional<test::Point> at = test::manifold_point(*s.model, e, seed);
    if (!at || largest(test::values(column, *at)) > kZero) return false;
  }
  return true;
}

// Sets the point of a witness: its rational values, and the root in its box, which Newton's method finds anew.
::testing::AssertionResult point_of(const WitnessPoint& w, test::Point& at) {
  Column unknowns;
  for (const auto& [symbol, value] : w.values) at.set(symbol, Multi(value));
  for (const WitnessPoint::Enclosed& x : w.enclosed) {
    at.set(x.symbol, Multi(x.midpoint));
    unknowns.push_back(x.symbol);
  }
  if (unknowns.empty()) return ::testing::AssertionSuccess();
  if (!test::solve_for(at, w.equations, unknowns)) return ::testing::AssertionFailure() << "no root near the witness";
  for (const WitnessPoint::Enclosed& x : w.enclosed) {
    const Multi off = abs(Multi(test::value(x.symbol, at) - Multi(x.midpoint)));
    if (off > Multi(x.radius) + Multi(1e-50)) return ::testing::AssertionFailure() << "the root lies outside its box";
  }
  return ::testing::AssertionSuccess();
}

// At the witness the difference is not zero and equals the terms that the change adds.
void expect_witness(const Difference& d, Expr change, const std::string& what) {
  ASSERT_TRUE(d.witness) << what;
  test::Point at(1);
  ASSERT_TRUE(point_of(*d.witness, at)) << what;
  const Multi have = test::value(d.expression(), at), want = test::value(change, at);
  EXPECT_GT(std::abs(to_double(have)), kZero) << what;
  EXPECT_LE(test::distance(have, want), kAgreement) << what;
  EXPECT_GT(std::abs(to_double(want)), kZero) << what;
}

struct Case {
  std::string model, form;
};
void PrintTo(const Case& c, std::ostream* out) { *out << c.model << ", " << c.form; }

std::vector<Case> cases() {
  std::vector<Case> list;
  const char* const with_ideal_reactions[] = {"papers/luo-zhao-example-2", "zoo/rheonomic-order-1",
                                              "zoo/second-order-linear",   "zoo/rheonomic-order-2",
                                              "zoo/third-order-linear",    "zoo/rheonomic-order-3"};
  // Variational mechanics agrees if the constraints are holonomic.
  const char* const holonomic[] = {"zoo/double-pendulum-cartesian", "zoo/fourbar"};
  for (const Formulation* form : formulations()) {
    const bool variational = form->unknowns == Unknowns::variational;
    for (const std::string name :
         variational ? std::span<const char* const>(holonomic) : std::span<const char* const>(with_ideal_reactions)) {
      // The inverses of this combination, written out, take seconds.
      if (!at_length() && form->name == std::string("udwadia-kalaba") && name == "zoo/rheonomic-order-1") continue;
      if (form->obstacle(system_of(name).m).empty()) list.push_back({name, form->name});
    }
  }
  return list;
}

class FormMutants : public testing::TestWithParam<Case> {};

TEST_P(FormMutants, AreRefutedAndTheFormIsProved) {
  const PrecisionScope precision(60);
  const System& s = system_of(GetParam().model);
  const Formulation& form = *find_formulation(GetParam().form);
  const std::size_t most = at_length() ? SIZE_MAX : 1;
  const FormProof whole = prove_form(s.m, form, form.equations, s.eliminations);
  EXPECT_EQ(whole.verdict, Verdict::proved);
  const Eliminations& used = s.eliminations[whole.elimination];
  const Elimination& e = used.of(form);
  const Equations right = form.equations(s.m, e);
  int refuted = 0, neutral = 0;
  for (const Mutant& mutant : mutants_of(right, most)) {
    const Equations wrong = mutant.of(right);
    const std::string what = std::string(mutant.left ? "left" : "right") + " side of equation " +
                             std::to_string(mutant.equation) +
                             (mutant.inside ? ", inside, node " + std::to_string(mutant.sum) : "") + ", summand " +
                             std::to_string(mutant.summand);
    const Column change = expected(s, form, e, right, wrong);
    const bool zero = vanishes(s, e, change);
    const FormProof p = prove_form(s.m, form, [&](const Mechanics&, const Elimination&) { return wrong; }, {used});
    if (zero) {
      ++neutral;
      EXPECT_NE(p.verdict, Verdict::refuted) << what;
      continue;
    }
    ++refuted;
    EXPECT_EQ(p.verdict, Verdict::refuted) << what;
    ASSERT_EQ(p.differences.size(), change.size());
    for (std::size_t i = 0; i < change.size(); ++i)
      if (p.differences[i].verdict == Verdict::refuted) expect_witness(p.differences[i], change[i], what);
  }
  EXPECT_GE(refuted, 2);
  RecordProperty("refuted", refuted);
  RecordProperty("neutral", neutral);
}

INSTANTIATE_TEST_SUITE_P(Form, FormMutants, testing::ValuesIn(cases()), [](const auto& p) {
  return test::test_name(p.param.form + "_" + p.param.model.substr(p.param.model.find('/') + 1));
});

// ---- certificates
// -------------------------------------------------------------------------------------------------------------

class Certificates : public testing::TestWithParam<const char*> {};

TEST_P(Certificates, VerifyAndTamperedOnesDoNot) {
  const System& s = system_of(GetParam());
  std::vector<const Formulation*> forms;
  for (const char* name : {"routh", "nielsen", "maggi", "chaplygin", "mac-millan", "micevic-rusov-reduced", "kane"})
    if (find_formulation(name)->obstacle(s.m).empty()) forms.push_back(find_formulation(name));
  Proof proof = prove(s.m, forms, s.eliminations);
  // The form contains a mistake, so that one claim is a difference.
  const Formulation& form = *find_formulation("maggi");
  const std::vector<Eliminations> used = {s.eliminations[proof.forms[2].elimination]};
  const Equations right = form.equations(s.m, used[0].of(form));
  const Mutant mutant = mutants_of(right, 1).front();
  const Equations wrong = mutant.of(right);
  proof.forms.push_back(prove_form(s.m, form, [&](const Mechanics&, const Elimination&) { return wrong; }, used));
  ASSERT_EQ(proof.forms.back().verdict, Verdict::refuted);

  const Certificate c = read_certificate(to_json(certificate(s.m, proof, s.eliminations.front(), "test", "0")));
  VerifyOptions quick;
  quick.points = 2;
  const Verification good = verify(c, quick);
  EXPECT_TRUE(good.all_confirmed());
  ASSERT_EQ(good.claims.size(), c.claims.size());

  int agree = 0, differ = 0;
  for (std::size_t k = 0; k < c.claims.size(); ++k) {
    if (c.claims[k].kind == Certificate::ClaimKind::agree && !c.claims[k].right.empty() && agree < 3) {
      ++agree;
      // The last part of the combination is left out.
      Certificate tampered = c;
      tampered.claims = {c.claims[k]};
      tampered.claims[0].right.pop_back();
      EXPECT_FALSE(verify(tampered, quick).all_confirmed()) << c.claims[k].a << ", " << c.claims[k].component;
      // The left side is another one.
      tampered.claims = {c.claims[k]};
      tampered.claims[0].left = tampered.claims[0].right[0].node;
      tampered.claims[0].right.push_back({tampered.claims[0].left, tampered.claims[0].left});
      EXPECT_FALSE(verify(tampered, quick).all_confirmed()) << c.claims[k].a << ", " << c.claims[k].component;
    }
    if (c.claims[k].kind != Certificate::ClaimKind::differ) continue;
    ++differ;
    // The opposite is claimed.
    Certificate tampered = c;
    tampered.claims = {c.claims[k]};
    tampered.claims[0].kind = Certificate::ClaimKind::agree;
    tampered.claims[0].witness.reset();
    EXPECT_FALSE(verify(tampered, quick).all_confirmed()) << c.claims[k].component;
    // An equality is claimed to be a difference at the same witness.
    for (const Certificate::Claim& equal : c.claims)
      if (equal.kind == Certificate::ClaimKind::agree) {
        tampered.claims = {equal};
        tampered.claims[0].kind = Certificate::ClaimKind::differ;
        tampered.claims[0].witness = c.claims[k].witness;
        EXPECT_FALSE(verify(tampered, quick).all_confirmed()) << equal.a << ", " << equal.component;
        break;
      }
  }
  EXPECT_EQ(agree, 3);
  EXPECT_GE(differ, 1);
}

INSTANTIATE_TEST_SUITE_P(Model, Certificates,
                         testing::Values("papers/luo-zhao-example-2", "zoo/rheonomic-order-1",
                                         "zoo/second-order-linear", "zoo/rheonomic-order-2", "zoo/third-order-linear",
                                         "zoo/rheonomic-order-3"),
                         [](const auto& p) {
                           return test::test_name(std::string(p.param).substr(std::string(p.param).find('/') + 1));
                         });

}  // namespace
}  // namespace anholon::form_mutants_test
