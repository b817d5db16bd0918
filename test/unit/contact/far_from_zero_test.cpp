// Impacts in units, and at times, in which gaps are not of the size 1: the round-off of a gap depends on the size of
// positions and times.
#include <cmath>

#include <gtest/gtest.h>

#include "support/contact_motion.h"
#include "support/models.h"

namespace anholon {
namespace far_from_zero_test {

using test::contact_motion;

// x = c + (a - c) cos(w t) from a, reflected at x = 0: the hits are 2 acos(-c/(a - c))/w apart.
std::string spring(const std::string& scale, const std::string& middle, const std::string& start) {
  return R"toml(
coordinates = ["x"]
parameters = {scale = )toml" +
         scale + ", c = \"" + middle + R"toml(*scale"}
particle = [{name = "b", mass = 1, position = "x*ex"}]
force = [{on = "b", vector = "-4*(x - c)*ex"}]
contact = [{name = "wall", gap = "x", restitution = 1}]
monitor.depth = "-x"
initial = {x = "2*scale", t = )toml" +
         start + "}\n";
}

TEST(FarFromZero, NoImpactIsLostInAnyUnit) {
  for (const char* scale : {"1e-6", "1", "1e3", "1e5"})
    for (const double c : {0.1, 0.25, 0.5, 0.75, 0.9}) {
      const auto m = contact_motion(spring(scale, std::to_string(c), "0"), 20);
      ASSERT_TRUE(m.report.outcome.ok()) << m.report.outcome.message;
      const std::vector<double> hits = test::times(m, "wall.hits");
      const double half = std::acos(-c / (2 - c)) / 2;
      ASSERT_EQ(hits.size(), static_cast<std::size_t>((20 / half + 1) / 2)) << scale << ", " << c;
      for (std::size_t k = 0; k < hits.size(); ++k)
        EXPECT_NEAR(hits[k], half * (2 * static_cast<double>(k) + 1), 1e-11) << scale << ", " << c;
    }
}

// The size of the model decides whether a gap at the start is round-off.
TEST(FarFromZero, APenetrationAtTheStartIsToldInAnyUnit) {
  const auto begins = [](const std::string& scale, const std::string& depth) {
    return contact_motion("coordinates = [\"x\"]\nparameters = {scale = " + scale + ", depth = " + depth + R"toml(}
particle = [{name = "b", mass = 1, position = "x*ex"}]
contact = [{name = "wall", gap = "x - scale"}]
initial = {x = "scale*(1 - depth)"}
)toml",
                          1)
        .report.outcome.ok();
  };
  for (const char* scale : {"1e-9", "1e-6", "1e-3", "1", "1e3"}) {
    for (const char* depth : {"5", "0.5", "0.01", "1e-7"})
      if (std::stod(scale) * std::stod(depth) > 2e-12) {
        EXPECT_FALSE(begins(scale, depth)) << scale << " " << depth;
      }
    for (const char* depth : {"0", "1e-13", "5e-10"}) EXPECT_TRUE(begins(scale, depth)) << scale << " " << depth;
  }
}

TEST(FarFromZero, NoImpactIsLostLate) {
  for (const char* start : {"1e3", "1e5", "1e6"})
    for (const double c : {0.1, 0.5, 0.9}) {
      const double t = std::stod(start), half = std::acos(-c / (2 - c)) / 2;
      const auto m = contact_motion(spring("1", std::to_string(c), start), Rational(static_cast<long>(t) + 20));
      ASSERT_TRUE(m.report.outcome.ok()) << m.report.outcome.message;
      const std::vector<double> hits = test::times(m, "wall.hits");
      ASSERT_EQ(hits.size(), static_cast<std::size_t>((20 / half + 1) / 2)) << start << ", " << c;
      for (std::size_t k = 0; k < hits.size(); ++k)
        EXPECT_NEAR(hits[k], t + half * (2 * static_cast<double>(k) + 1), 1e-10 + 1e-15 * t * 20) << start << ", " << c;
    }
}

// The toy jams, slips and leaves its pole: late events that are no impacts are located as well.
TEST(FarFromZero, AWoodpeckerPecksLate) {
  std::string text = test::shipped_text("contacts/woodpecker");
  const std::size_t simulate = text.find("[simulate]");
  text.erase(simulate, text.find("[view]") - simulate);
  const auto now = contact_motion(text, Rational(3, 10));
  const std::string from = "[initial]\n";
  for (const long t : {1000, 100000}) {
    std::string late = text;
    late.replace(late.find(from), from.size(), from + "t = " + std::to_string(t) + "\n");
    const auto then = contact_motion(late, t + Rational(3, 10));
    ASSERT_TRUE(then.report.outcome.ok()) << then.report.outcome.message;
    ASSERT_EQ(then.report.events.size(), now.report.events.size());
    for (std::size_t k = 0; k < now.report.events.size(); ++k) {
      EXPECT_EQ(then.report.events[k].name, now.report.events[k].name);
      EXPECT_NEAR(then.report.events[k].t.value - static_cast<double>(t), now.report.events[k].t.value, 1e-8);
    }
  }
}

}  // namespace far_from_zero_test
}  // namespace anholon
