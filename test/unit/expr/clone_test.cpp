#include <gtest/gtest.h>

#include "base/assert.h"
#include "expr/diff.h"
#include "expr/expr.h"

namespace anholon::clone_test {
namespace {

StepFunction step_function() { return {"s", {Rational(0)}, {Rational(1), Rational(2)}}; }

struct Subject {
  Graph g;
  Expr x = g.jet(0, 0), y = g.jet(1, 0), e = sin(x * y) + 3 * x;
};

TEST(FrozenGraph, FindsWhatItHas) {
  Subject s;
  const Expr rate = total_derivative(s.e);
  s.g.add_step_function(step_function());
  const std::size_t size = s.g.size();
  s.g.freeze();
  EXPECT_TRUE(s.g.frozen());
  EXPECT_EQ(sin(s.x * s.y) + 3 * s.x, s.e);
  EXPECT_EQ(total_derivative(s.e), rate);
  EXPECT_EQ(s.g.number(1), s.g.one());
  EXPECT_EQ(s.g.add_step_function(step_function()), 0U);
  EXPECT_EQ(s.g.size(), size);
}

TEST(FrozenGraph, RefusesToGrow) {
  Subject s;
  s.g.freeze();
  EXPECT_THROW(static_cast<void>(cos(s.x)), InternalFault);
  EXPECT_THROW(static_cast<void>(s.x + s.y), InternalFault);
  EXPECT_THROW(static_cast<void>(s.g.jet(2, 0)), InternalFault);
  EXPECT_THROW(static_cast<void>(s.g.number(Rational(22, 7))), InternalFault);
  EXPECT_THROW(static_cast<void>(s.g.set_rate(s.x.id, s.y.id)), InternalFault);
  EXPECT_THROW(static_cast<void>(s.g.allow(1)), InternalFault);
  EXPECT_THROW(static_cast<void>(s.g.add_step_function(step_function())), InternalFault);
  EXPECT_THROW(static_cast<void>(total_derivative(s.e)), InternalFault);
}

TEST(GraphClone, HasTheSameNodesAndGrowsAlone) {
  Subject s;
  const Expr rate = total_derivative(s.e);
  s.g.freeze();
  const auto copy = s.g.clone();
  EXPECT_FALSE(copy->frozen());
  ASSERT_EQ(copy->size(), s.g.size());
  const Expr x = copy->own(s.x), y = copy->own(s.y);
  EXPECT_EQ(x.graph, copy.get());
  EXPECT_EQ(sin(x * y) + 3 * x, s.e) << "the same id";
  EXPECT_EQ(total_derivative(copy->own(s.e)), rate);
  EXPECT_EQ(copy->size(), s.g.size()) << "nothing was new";
  cos(x);
  EXPECT_EQ(copy->size(), s.g.size() + 1);
}

// Ids decide the order of sums: expressions that are built in a clone have the ids that they would have in the
// original.
TEST(GraphClone, GoesOnWithTheIdsOfTheOriginal) {
  Subject s;
  const auto copy = s.g.clone();
  const Expr here = exp(s.x) * (s.y + cos(s.e)), there = exp(copy->own(s.x)) * (copy->own(s.y) + cos(copy->own(s.e)));
  EXPECT_EQ(here.id, there.id);
  EXPECT_EQ(s.g.size(), copy->size());
}

TEST(GraphClone, MayBeAsTheGraphWas) {
  Subject s;
  const std::size_t size = s.g.size();
  total_derivative(s.e);
  const Expr later = pow(s.x, {7, 5}) + exp(s.y);
  const auto before = s.g.clone(size);
  ASSERT_EQ(before->size(), size);
  Subject anew;
  const Expr x = before->own(s.x), y = before->own(s.y);
  EXPECT_EQ(exp(y).id, exp(anew.y).id) << "ids go on from there";
  EXPECT_EQ(total_derivative(before->own(s.e)).id, total_derivative(anew.e).id) << "rates that came later are unknown";
  EXPECT_EQ((pow(x, {7, 5}) + y).id, (pow(anew.x, {7, 5}) + anew.y).id);
  EXPECT_THROW(static_cast<void>(before->own(later)), InternalFault);
}

TEST(GraphClone, OwnsNothingOfStrangers) {
  Subject s, stranger;
  const auto copy = s.g.clone();
  const auto of_copy = copy->clone();
  EXPECT_EQ(of_copy->own(s.x), s.x) << "of the graph that its original is a clone of";
  const Expr late = cos(s.x);
  EXPECT_THROW(static_cast<void>(of_copy->own(late)), InternalFault) << "newer than the clone";
  EXPECT_THROW(static_cast<void>(copy->own(stranger.x)), InternalFault);
  EXPECT_THROW(static_cast<void>(copy->own(s.x) * s.y), InternalFault) << "two graphs in one product";
}

}  // namespace
}  // namespace anholon::clone_test
