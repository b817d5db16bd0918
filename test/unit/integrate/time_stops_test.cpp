// The times at which steps of methods without series have to end.
#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "integrate/states/time_stops.h"
#include "support/models.h"

namespace anholon::time_stops_test {
namespace {

// The program of a particle on a line that a force moves.
struct Line {
  std::shared_ptr<const Model> model;
  Mechanics m;
  System system;
  Structure structure;
  Program stepping;

  explicit Line(const std::string& force, const std::string& more = "")
      : model(test::model_of("coordinates = [\"x\"]\nparameters = {c = 500}\nparticle = [{name = \"p\", mass = 1, "
                             "position = \"x*ex\"}]\nforce = [{on = \"p\", vector = \"(" +
                             force + ")*ex\"}]\ninitial = {x = 0}\n" + more)),
        m(mechanics(*model)) {
    system = implicit_system(model, m, *find_formulation("routh"), {});
    const Outcome o = analyse(system, parameters(), {}, structure);
    if (!o.ok()) throw std::runtime_error(o.message);
    stepping = program(system, structure);
  }
  std::vector<double> parameters() const {
    Column values;
    for (const Parameter& p : model->parameters) values.push_back(p.value);
    return evaluate_parameters<double>(*model->graph, values);
  }
  // The middles of all stops on the way; each is passed as a method passes it.
  std::vector<double> stops(double from, double to) const {
    const TimeStops all(stepping, parameters(), 0, from, to);
    std::vector<double> middles;
    long double t = from;
    while (const auto stop = all.next(t, to)) {
      const bool forward = to > from;
      EXPECT_TRUE(forward ? stop->behind > t : stop->behind < t) << "no way on from " << static_cast<double>(t);
      EXPECT_TRUE(forward ? stop->before <= stop->behind : stop->before >= stop->behind);
      EXPECT_NEAR(stop->before, stop->behind, 1e-14 * std::max(std::abs(from), std::abs(stop->before)));
      middles.push_back((stop->before + stop->behind) / 2);
      t = stop->behind;
      if (middles.size() > 100) break;
    }
    return middles;
  }
};

void expect_near(const std::vector<double>& found, const std::vector<double>& expected, const std::string& what) {
  ASSERT_EQ(found.size(), expected.size()) << what;
  for (std::size_t i = 0; i < found.size(); ++i) EXPECT_NEAR(found[i], expected[i], 1e-9) << what;
}

TEST(TimeStops, AreWhereTheTimeDecides) {
  const auto expect = [](const std::string& force, const std::vector<double>& times) {
    expect_near(Line(force).stops(0, 1000), times, force);
  };
  expect("-x", {});
  expect("sin(t)*x + t^2", {});
  expect("piecewise(x < 1, 0, 1)", {});
  expect("piecewise(t < 500, 0, t < 510, 1, 0)", {500, 510});
  expect("piecewise(t < c, 0, 3*t < c + 1060, 1, 0)", {500, 520});
  expect("abs(t - c) + sign(2*t - 7)", {3.5, 500});
  expect("piecewise(abs(t - 500) < 5, 1, 0)", {495, 500, 505});
  expect("piecewise((t - 500)^2 < 4, 1, 0)", {498, 502});
  expect("piecewise((t - 3)*(t - 7) < 0, 1, 0)", {3, 7});
  expect("piecewise(exp(-t/c) > 0.5, 1, 0)", {500 * std::numbers::ln2, 500});  // where the exponent is -1, too
  expect("max(t, 4)*x + min(t, 9)", {4, 9});
}

TEST(TimeStops, WavesDecideAgainAndAgain) {
  expect_near(Line("sign(sin(pi*t))").stops(0, 4.5), {1, 2, 3, 4}, "sine");
  expect_near(Line("sign(sin(pi*t))").stops(4.5, 0.5), {4, 3, 2, 1}, "sine, backwards");
  expect_near(Line("piecewise(cos(pi*t) > 1/2, 1, 0)").stops(0, 2.5), {1.0 / 3, 5.0 / 3, 7.0 / 3}, "cosine");
}

TEST(TimeStops, AreKnots) {
  const std::string table = "table = [{name = \"f\", x = [0, 2, 3, 3.5, 8], y = [1, 2, 3, -1, 0], fit = \"";
  for (const std::string fit : {"hold", "linear", "monotone", "spline"}) {
    const Line line("f(t)*x", table + fit + "\"}]\n");
    expect_near(line.stops(-1, 20), {0, 2, 3, 3.5, 8}, fit);
    expect_near(line.stops(20, 2.5), {8, 3.5, 3}, fit);
  }
  expect_near(Line("f(2*t - 1)*x", table + "linear\"}]\n").stops(0, 20), {0.5, 1.5, 2, 2.25, 4.5}, "of a line");
  expect_near(Line("f(t^2)*x", table + "linear\"}]\n").stops(1, 2), {std::sqrt(2.0), std::sqrt(3.0), std::sqrt(3.5)},
              "of a square");
}

// Such a function is almost constant elsewhere.
TEST(TimeStops, ShowSmoothPulses) {
  expect_near(Line("exp(-(t - 500)^2)").stops(0, 1000), {499, 500, 501}, "Gauss");
  expect_near(Line("1/(1 + (t - 500)^2)").stops(0, 1000), {499, 500, 501}, "Lorentz");
  expect_near(Line("(1 + 100*(t - 500)^2)^(-3)").stops(0, 1000), {499.9, 500, 500.1}, "power");
  expect_near(Line("tanh(10*(t - 500))").stops(0, 1000), {499.9, 500, 500.1}, "step");
  expect_near(Line("exp(-(t - 500)^4)").stops(0, 1000), {499, 500, 501}, "fourth power");
  expect_near(Line("exp(-(t - 500)^2)").stops(1000, 500), {501}, "backwards, up to the end");
}

// Where a motion begins at a kink, there is no stop at the kink; a time of zero is like any other.
TEST(TimeStops, LieAhead) {
  const Line line("piecewise(t < 0, 0, t < 1, 1, 0)");
  expect_near(line.stops(-3, 2), {0, 1}, "through zero");
  expect_near(line.stops(2, -3), {1, 0}, "back through zero");
  expect_near(line.stops(0, 2), {1}, "from zero");
  expect_near(line.stops(0, 1), {}, "to a kink");
}

}  // namespace
}  // namespace anholon::time_stops_test
