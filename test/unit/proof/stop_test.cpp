// Stop requests (base/stop.h) in the prover, in a comparison and in a derivation. At whatever time the request comes,
// only proved equalities are called equal, and a stopped computation is reported as stopped.
#include <gtest/gtest.h>

#include "base/stop.h"
#include "proof/prove.h"
#include "setup/eliminate.h"
#include "support/models.h"
#include "support/published.h"

namespace anholon::stop_test {
namespace {

constexpr std::size_t kNever = ~std::size_t{0};

struct Attempt {
  Proof proof;
  std::size_t looks = 0;  // how often the request was asked
};

// Proves all forms of the model; the stop request is answered by yes from look number `at` on, counted from 0.
Attempt attempt(const std::string& name, std::size_t at) {
  const std::shared_ptr<const Model> model = test::shipped(name);
  const Mechanics m = mechanics(*model);
  std::vector<const Formulation*> forms;
  for (const Formulation* f : formulations())
    if (obstacle(*f, m).empty()) forms.push_back(f);
  std::vector<Eliminations> eliminations;
  for (const bool solve : {true, false})
    eliminations.push_back({elimination_for(m, Unknowns::coordinates, {}, {}, solve),
                            elimination_for(m, Unknowns::quasi_velocities, {}, {}, solve)});
  Attempt a;
  const StopScope scope([&] { return a.looks++ >= at; });
  a.proof = prove(m, forms, eliminations);
  return a;
}

bool rests_on_tangents(const FormProof& f) { return f.form->unknowns != Unknowns::multipliers; }

TEST(Stop, ProofThatIsStoppedAtAnyLookCallsNothingEqualThatWasNotShown) {
  const std::string name = "zoo/chaplygin-sleigh";
  const Attempt whole = attempt(name, kNever);
  ASSERT_FALSE(whole.proof.stopped);
  ASSERT_EQ(whole.proof.compared, whole.proof.forms.size());
  ASSERT_GT(whole.looks, 1000U);
  std::size_t without_tangents = 0, compared_before = 0;
  constexpr std::size_t kPlaces = 60;
  for (std::size_t k = 0; k <= kPlaces; ++k) {
    // The stops cover the whole proof, from its first look to its last one.
    const std::size_t at = (whole.looks - 1) * k / kPlaces;
    const Proof p = attempt(name, at).proof;
    ASSERT_TRUE(p.stopped) << at;
    ASSERT_EQ(p.forms.size(), whole.proof.forms.size());
    EXPECT_LE(compared_before, p.compared) << at;
    compared_before = p.compared;
    for (std::size_t a = 0; a < p.forms.size(); ++a) {
      EXPECT_EQ(p.forms[a].form, whole.proof.forms[a].form);
      const Verdict expected = a < p.compared ? whole.proof.forms[a].verdict : Verdict::unknown;
      EXPECT_EQ(p.forms[a].verdict, expected) << at << " " << p.forms[a].form->name;
      EXPECT_EQ(p.with_routh(a), rests_on_tangents(p.forms[a]) ? Verdict::unknown : expected) << at << " " << a;
      for (std::size_t b = 0; b < a; ++b)
        if (rests_on_tangents(p.forms[a]) || rests_on_tangents(p.forms[b]) || a >= p.compared || b >= p.compared) {
          EXPECT_EQ(p.between(a, b), Verdict::unknown) << at << " " << a << " " << b;
        }
    }
    without_tangents += p.compared == p.forms.size();
  }
  // Some requests come after all forms are compared and before the tangents are: with the tangents, these pairs are
  // equal.
  EXPECT_GT(without_tangents, 0U);
  std::size_t equal = 0;
  for (std::size_t a = 0; a < whole.proof.forms.size(); ++a)
    equal += rests_on_tangents(whole.proof.forms[a]) && whole.proof.between(0, a) == Verdict::proved;
  EXPECT_GT(equal, 0U);
}

TEST(Stop, FormsThatRestOnTangentsAreUnknownWhereTheseAreNotShown) {
  Proof p = attempt("zoo/chaplygin-sleigh", kNever).proof;
  std::size_t resting = 0;
  for (std::size_t a = 0; a < p.forms.size(); ++a) EXPECT_EQ(p.with_routh(a), p.forms[a].verdict) << a;
  ASSERT_FALSE(p.kernel.empty());
  p.kernel.back().verdict = Verdict::unknown;
  for (std::size_t a = 0; a < p.forms.size(); ++a) {
    const bool rests = rests_on_tangents(p.forms[a]);
    EXPECT_EQ(p.with_routh(a), rests ? Verdict::unknown : p.forms[a].verdict) << a;
    resting += rests;
  }
  EXPECT_GT(resting, 0U);
}

TEST(Stop, FirstLookEndsAProof) {
  const Attempt a = attempt("zoo/disc", 0);
  EXPECT_TRUE(a.proof.stopped);
  EXPECT_EQ(a.proof.compared, 0U);
  EXPECT_EQ(a.looks, 1U);
  for (std::size_t k = 1; k < a.proof.forms.size(); ++k) EXPECT_EQ(a.proof.between(0, k), Verdict::unknown);
}

TEST(Stop, ScopesNestAndEndWithTheirBlock) {
  bool outer = false, inner = false;
  EXPECT_NO_THROW(look_for_stop());
  {
    const StopScope a([&] { return outer; });
    {
      const StopScope b([&] { return inner; });
      EXPECT_NO_THROW(look_for_stop());
      outer = true;
      EXPECT_THROW(look_for_stop(), StopRequested);
      outer = false, inner = true;
      EXPECT_THROW(look_for_stop(), StopRequested);
    }
    EXPECT_NO_THROW(look_for_stop());
  }
  outer = true;
  EXPECT_NO_THROW(look_for_stop());
}

// A stopped comparison throws; it gives no verdict.
TEST(Stop, ComparisonThatIsStoppedHasNoVerdict) {
  std::size_t all = 0;
  const auto compared = [&](std::size_t at) -> std::optional<Verdict> {
    // The model is a new one, since derived expressions of an earlier attempt would be known.
    const OpenModel model = test::open_text(test::shipped_text("zoo/chaplygin-sleigh"));
    Subject subject(model);
    std::size_t looks = 0;
    const StopScope scope([&] { return looks++ >= at; });
    try {
      Diagnostics diagnostics;
      const auto list = subject.read({"e", "e: x'*sin(th) - y'*cos(th) = 0\n"}, diagnostics);
      const Verdict v = subject.compare(list.at(0)).verdict;
      all = looks;
      return v;
    } catch (const StopRequested&) {
      return std::nullopt;
    }
  };
  EXPECT_EQ(compared(kNever), Verdict::proved);
  const std::size_t looks = all;
  ASSERT_GT(looks, 10U);
  for (std::size_t k = 0; k <= 10; ++k) EXPECT_EQ(compared((looks - 1) * k / 10), std::nullopt) << k;
  EXPECT_EQ(compared(looks), Verdict::proved);
}

}  // namespace
}  // namespace anholon::stop_test
