// The sparse Jacobian of a chain grows with its links, has the entries of the full one, and is reported where it is
// singular.
#include <gtest/gtest.h>

#include "program/expansion.h"
#include "support/chain.h"
#include "support/models.h"

namespace anholon::sparse_jacobian_test {
namespace {

// A chain with a point at which it is expanded.
struct Chain {
  explicit Chain(int n, double mass = 0.1)
      : model(test::model_of(test::chain_text(n))), mechanics_of(mechanics(*model)),
        system(implicit_system(model, mechanics_of, *find_formulation("routh"), {})) {
    Column values;
    for (const Parameter& p : model->parameters) values.push_back(p.value);
    const std::vector<double> regular = evaluate_parameters<double>(*model->graph, values);
    if (const Outcome o = analyse(system, regular, {}, structure); !o.ok()) throw std::runtime_error(o.message);
    stepping = program(system, structure);
    parameters.assign(regular.begin(), regular.end());
    for (std::size_t k = 0; k < model->parameters.size(); ++k)
      if (model->names.parameters[k] == "m") parameters[k] = mass;
    for (int i = 0; i < n; ++i) state.push_back(0.3L + 0.01L * i), state.push_back(0.02L * (i % 5));
  }
  template <Number N>
  Expansion<N> expansion(int stages = 1) const {
    Expansion<N> e(stepping, std::vector<N>(parameters.begin(), parameters.end()), stages);
    e.load(N(0), std::vector<N>(state.begin(), state.end()), {});
    return e;
  }

  std::shared_ptr<const Model> model;
  Mechanics mechanics_of;
  System system;
  Structure structure;
  Program stepping;
  std::vector<long double> parameters, state;
};

TEST(SparseJacobian, OfAChainGrowsWithItsLinks) {
  std::vector<double> entries, terms;
  for (const int n : {128, 256, 512}) {
    const Chain chain(n);
    Expansion<double> e = chain.expansion<double>();
    ASSERT_TRUE(e.prepare().ok());
    ASSERT_TRUE(e.system_jacobian().is_sparse());
    entries.push_back(static_cast<double>(e.system_jacobian().sparse().entries()) / n);
    terms.push_back(static_cast<double>(e.system_jacobian().sparse().partials().size()) / n);
  }
  // Sums of many links are trees of blocks: the number of entries of a link grows with their depth, the logarithm of
  // the number of links.
  constexpr double kBlocks = 1.1;
  EXPECT_LE(terms[2], kBlocks * terms[0]) << terms[0] << ", " << terms[1] << ", " << terms[2];
  EXPECT_LE(entries[2] - entries[1], kBlocks * (entries[1] - entries[0]))
      << entries[0] << ", " << entries[1] << ", " << entries[2];
  EXPECT_LE(entries[2], 200) << "a full matrix has 512 a link";
}

// If the links lie in a line, many pivots of the usual order are small, and other pivots would fill the factors.
TEST(SparseJacobian, OfAHorizontalChainHasAsFewEntries) {
  constexpr std::size_t kLinks = 600;
  Chain chain(kLinks);
  Expansion<double> bent = chain.expansion<double>();
  ASSERT_TRUE(bent.prepare().ok());
  for (std::size_t i = 0; i < kLinks; ++i) chain.state[2 * i] = 1.57L + 0.001L * (i % 7);
  Expansion<double> horizontal = chain.expansion<double>();
  ASSERT_TRUE(horizontal.prepare().ok());
  ASSERT_TRUE(horizontal.system_jacobian().is_sparse());
  EXPECT_LE(horizontal.system_jacobian().sparse().entries(), bent.system_jacobian().sparse().entries() * 5 / 4);
}

TEST(SparseJacobian, IsThatOfFewUnknownsWrittenDown) {
  const Chain chain(20);
  Expansion<double> e = chain.expansion<double>();
  ASSERT_TRUE(e.prepare().ok());
  EXPECT_FALSE(e.system_jacobian().is_sparse());
}

template <class N>
class SparseJacobianOf : public testing::Test {};
using Numbers = testing::Types<double, long double>;
TYPED_TEST_SUITE(SparseJacobianOf, Numbers);

TYPED_TEST(SparseJacobianOf, HasTheNumbersOfTheFullOne) {
  using N = TypeParam;
  const Chain chain(80);
  Expansion<N> e = chain.template expansion<N>();
  ASSERT_TRUE(e.prepare().ok());
  const SystemJacobian<N>& j = e.system_jacobian();
  ASSERT_TRUE(j.is_sparse());
  Sensitivity<N> sensitivity(chain.stepping);
  Matrix<N> full(80, 80);
  sensitivity.take(e.machine()), sensitivity.jacobian(e.machine(), full);
  const Matrix<N> written = j.matrix();
  const N round_offs = unit_roundoff<N>() * N(1000);
  Lu<N> lu;
  ASSERT_TRUE(lu.factor(full));
  std::vector<N> x(80), image, sizes, b(80), by_sparse, by_full, direction, other;
  for (std::size_t i = 0; i < 80; ++i) {
    N largest(0);
    x[i] = N(static_cast<int>(i % 11) - 5), b[i] = N(static_cast<int>(i % 7) - 3);
    for (std::size_t k = 0; k < 80; ++k) {
      EXPECT_LE(abs(N(written(i, k) - full(i, k))), round_offs * abs(full(i, k)));
      if (N v = abs(full(i, k)); v > largest) largest = v;
    }
    EXPECT_LE(abs(N(j.largest(i) - largest)), N(1e-12) * largest);
  }
  j.multiply(x, image), j.sparse().multiply_sizes(x, sizes);
  for (std::size_t i = 0; i < 80; ++i) {
    N moved(0), product(0);
    for (std::size_t k = 0; k < 80; ++k) product += full(i, k) * x[k], moved += abs(N(full(i, k) * x[k]));
    EXPECT_LE(abs(N(product - image[i])), round_offs * moved);
    EXPECT_GE(sizes[i], moved * (N(1) - round_offs)) << "no cancellation is taken for small terms";
    EXPECT_LE(sizes[i], N(2) * moved) << "sines and cosines of a difference of angles are what cancels";
  }
  j.solve(b, by_sparse), lu.solve(b, by_full);
  N most(0);
  for (const N& v : by_full)
    if (abs(v) > most) most = abs(v);
  for (std::size_t k = 0; k < 80; ++k) EXPECT_LE(abs(N(by_sparse[k] - by_full[k])), N(100) * round_offs * most);
  const N sparse_sigma = j.smallest_singular_value(direction), sigma = lu.smallest_singular_value(other);
  EXPECT_LE(abs(N(sparse_sigma - sigma)), N(1e-6) * sigma) << "an estimate of the same number";
}

TYPED_TEST(SparseJacobianOf, IsAdoptedByWiderNumbers) {
  using N = TypeParam;
  const Chain chain(80);
  Expansion<N> e = chain.template expansion<N>();
  ASSERT_TRUE(e.prepare().ok());
  Expansion<long double> wide = chain.expansion<long double>();
  wide.evaluate();
  wide.adopt_jacobian(e.system_jacobian());
  ASSERT_TRUE(wide.system_jacobian().is_sparse());
  EXPECT_FALSE(wide.system_jacobian().factored()) << "factors are not adopted";
  for (std::size_t i = 0; i < 80; ++i)
    EXPECT_EQ(static_cast<double>(wide.system_jacobian().largest(i)), to_double(e.system_jacobian().largest(i)));
}

TEST(SparseJacobian, OfAChainWithoutMassIsSingular) {
  EXPECT_TRUE(Chain(80).expansion<double>().prepare().ok()) << "a mutant without singular matrices passes no test";
  const Chain massless(80, 0);
  Expansion<double> e = massless.expansion<double>();
  const Outcome o = e.prepare();
  EXPECT_EQ(o.kind, OutcomeKind::singular) << o.message;
  EXPECT_FALSE(e.system_jacobian().is_sparse()) << "the full matrix has the last word";
}

// Sparse and dense factors give the same series; in quadruple precision J is always dense.
TEST(SparseJacobian, LeadsToTheSameSeries) {
  const Chain chain(80);
  constexpr int kStages = 12;
  Expansion<double> e = chain.expansion<double>(kStages);
  Expansion<Quad> reference = chain.expansion<Quad>(kStages);
  for (const Outcome& o :
       {e.prepare(), e.solve(), e.extend(), reference.prepare(), reference.solve(), reference.extend()})
    ASSERT_TRUE(o.ok()) << o.message;
  ASSERT_TRUE(e.system_jacobian().is_sparse());
  ASSERT_FALSE(reference.system_jacobian().is_sparse());
  for (int k = 2; k <= kStages + 2; ++k) {
    double most = 0, gap = 0;
    for (std::size_t j = 0; j < 80; ++j) {
      const double x = to_double(reference.coefficient(j, k));
      most = std::max(most, std::abs(x)), gap = std::max(gap, std::abs(x - e.coefficient(j, k)));
    }
    EXPECT_LE(gap, 1e-11 * most) << "order " << k;
  }
}

}  // namespace
}  // namespace anholon::sparse_jacobian_test
