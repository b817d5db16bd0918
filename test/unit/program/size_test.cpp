// Equations and stepping program of an n-link chain grow linearly: common parts exist once, and no matrix is inverted
// symbolically.
#include <gtest/gtest.h>

#include "program/program.h"
#include "support/chain.h"
#include "support/models.h"

namespace anholon::size_test {
namespace {

ProgramSize size_of_chain(int n) {
  const auto model = test::model_of(test::chain_text(n));
  const Mechanics m = mechanics(*model);
  const System system = implicit_system(model, m, *find_formulation("routh"), {});
  Column values;
  for (const Parameter& p : model->parameters) values.push_back(p.value);
  Structure structure;
  const Outcome o = analyse(system, evaluate_parameters<double>(*model->graph, values), {}, structure);
  if (!o.ok()) throw std::runtime_error(o.message);
  EXPECT_EQ(structure.state_dimension, 2 * n);
  return size(program(system, structure));
}

TEST(ProgramSize, OfAChainIsLinearInItsLinks) {
  // The line through 64 and 128 links must hold at 256. Sums of fewer links are so short that they are written out;
  // longer sums are made of blocks, whose ends are not those of the chain.
  constexpr double kBlocks = 1.02;
  const ProgramSize at64 = size_of_chain(64), at128 = size_of_chain(128), at256 = size_of_chain(256);
  const auto expect_line = [](const char* what, std::size_t a, std::size_t b, std::size_t c) {
    EXPECT_GT(b, a) << what;
    EXPECT_LE(static_cast<double>(c), kBlocks * static_cast<double>(b + 2 * (b - a)))
        << what << ": " << a << ", " << b << ", " << c;
  };
  expect_line("slots", at64.slots, at128.slots, at256.slots);
  expect_line("products", at64.products, at128.products, at256.products);
  expect_line("functions", at64.functions, at128.functions, at256.functions);
  expect_line("tainted", at64.tainted, at128.tainted, at256.tainted);
  EXPECT_LE(at256.slots, 256U * 60) << "sixty operations per link and its equation are plenty";
}

std::size_t nodes_of_chain(int n) {
  const auto model = test::model_of(test::chain_text(n));
  const Equations e = find_formulation("routh")->equations(mechanics(*model), {});
  Column both = e.left;
  both.insert(both.end(), e.right.begin(), e.right.end());
  return reachable(both).size();
}

TEST(EquationSize, OfAChainIsLinearInItsLinks) {
  const std::size_t at64 = nodes_of_chain(64), at128 = nodes_of_chain(128), at256 = nodes_of_chain(256),
                    at512 = nodes_of_chain(512);
  // Sums of few links are written out, those of many are made of blocks: growth is linear for the latter.
  const double first = static_cast<double>(at128 - at64), second = static_cast<double>(at256 - at128),
               third = static_cast<double>(at512 - at256);
  EXPECT_NEAR(second / first, 2, 0.1) << at64 << ", " << at128 << ", " << at256;
  EXPECT_NEAR(third / second, 2, 0.05) << at128 << ", " << at256 << ", " << at512;
  EXPECT_LE(at512, 512U * 32) << "some thirty nodes per link and its equation are plenty";
}

}  // namespace
}  // namespace anholon::size_test
