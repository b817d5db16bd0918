// Results must not depend on choices: of coordinates, of the dependent ones among them, of quasi-velocities, of the way
// in which a constraint is written. Residuals of two derivations of one system are compared at the same motion; only
// the last part solves equations of motion.
#include <map>

#include <gtest/gtest.h>

#include "observe/evaluate.h"
#include "support/generic_system.h"
#include "support/manifold.h"
#include "support/models.h"

namespace anholon::invariance_test {
namespace {

constexpr double kExact = 1e-24;   // 40 digits, less those that inverses and high derivatives lose
constexpr double kRefuted = 1e-6;  // a mutant misses by much more
constexpr int kPoints = 2;
constexpr unsigned kJets = 6;  // derivatives carried from one system of coordinates to another

struct System {
  std::shared_ptr<const Model> model;
  Mechanics m;
  explicit System(std::shared_ptr<const Model> from) : model(std::move(from)), m(mechanics(*model)) {}
  explicit System(const std::string& text) : System(test::model_of(text)) {}
};

// One form of a system's equations, to be evaluated at points.
struct Derived {
  const System& s;
  Elimination e;
  Column residual;
  Rows u_by_top;  // du/dq^(m), or the identity for n equations

  Derived(const System& system, const Formulation& form, const std::vector<std::size_t>& wanted, bool solve)
      : s(system), e(elimination_for(s.m, form.unknowns, {}, wanted, solve)) {
    const Equations q = form.equations(s.m, e);
    residual = put_masses(*s.model, e.in_coordinates(q.left - q.right));
    const Column top = jets(*s.model, e.m);
    if (residual.size() == s.m.q.size() && !(form.eliminates() && e.phi.empty())) return;
    const Column u = e.quasi
                         ? Column(e.quasi->w.begin(), e.quasi->w.begin() + static_cast<std::ptrdiff_t>(e.free.u.size()))
                         : e.I(top);
    for (Expr x : u) u_by_top.push_back(gradient(x, top));
  }
  // dq/du on the manifold, or the identity for n equations.
  Matrix<Multi> directions(const test::Point& at) const {
    if (!u_by_top.empty()) return test::tangents(*s.model, e, at);
    Matrix<Multi> one(s.m.q.size(), s.m.q.size());
    for (std::size_t i = 0; i < one.rows; ++i)
      for (std::size_t j = 0; j < one.cols; ++j) one(i, j) = Multi(i == j ? 1 : 0);
    return one;
  }
  Matrix<Multi> rows(const test::Point& at) const {
    return u_by_top.empty() ? directions(at) : test::values_of(u_by_top, at);
  }
};

Matrix<Multi> operator*(const Matrix<Multi>& a, const Matrix<Multi>& b) {
  Matrix<Multi> c(a.rows, b.cols);
  for (std::size_t i = 0; i < a.rows; ++i)
    for (std::size_t j = 0; j < b.cols; ++j) {
      Multi sum(0);
      for (std::size_t k = 0; k < a.cols; ++k) sum += a(i, k) * b(k, j);
      c(i, j) = sum;
    }
  return c;
}

enum class Rule { covector, transposed, unchanged };

// |r' - X^T r| in units of its terms.
double miss(const std::vector<Multi>& r_new, const std::vector<Multi>& r, const Matrix<Multi>& X, Rule rule) {
  double worst = 0;
  for (std::size_t a = 0; a < r_new.size(); ++a) {
    double scale = std::max(1.0, std::abs(to_double(r_new[a])));
    Multi want(0);
    for (std::size_t b = 0; b < r.size(); ++b) {
      const Multi factor = rule == Rule::unchanged ? Multi(a == b ? 1 : 0) : rule == Rule::covector ? X(b, a) : X(a, b);
      want += factor * r[b];
      scale = std::max(scale, std::abs(to_double(Multi(factor * r[b]))));
    }
    const double off = std::abs(to_double(Multi(r_new[a] - want))) / scale;
    if (!(off <= worst)) worst = off == off ? off : 1e300;
  }
  return worst;
}

// ---- other coordinates
// --------------------------------------------------------------------------------------------------------

struct Change {
  const char* name;
  const char* model;
  std::string coordinates;
  std::vector<std::pair<std::string, std::string>> old_ones;  // as functions of the new ones and time
};

// Names are for gtest's output.
void PrintTo(const Change& c, std::ostream* out) { *out << c.name; }

// The text of the model with its coordinates defined by new ones. Its initial values are left out; the first of the new
// coordinates starts at 1, since polar coordinates are singular at r = 0.
std::string changed_text(const Change& c) {
  std::string text = test::shipped_text(c.model), defines;
  text = text.substr(0, text.find("\n[initial]") + 1);
  const std::size_t list = text.find("\ncoordinates = ") + 1;
  text.replace(list, text.find('\n', list) - list, "coordinates = [" + c.coordinates + "]");
  for (const auto& [name, value] : c.old_ones) defines += name + " = \"" + value + "\"\n";
  const std::size_t at = text.find("\n[define]\n");
  text = at == std::string::npos ? text + "[define]\n" + defines : text.insert(at + 10, defines);
  return text + "[initial]\n" + c.coordinates[1] + " = 1\n";
}

std::vector<Change> changes() {
  const std::vector<std::pair<std::string, std::string>> bent = {
      {"x", "X + t*Y/2"}, {"y", "Y + X^2/5"}, {"w", "W + X*t/3"}};
  return {{"PolarSleigh",
           "zoo/chaplygin-sleigh",
           "\"r\", \"p\", \"s\"",
           {{"x", "r*cos(p)"}, {"y", "r*sin(p)"}, {"th", "p + s/2"}}},
          {"TurningSleigh",
           "zoo/chaplygin-sleigh",
           "\"X\", \"Y\", \"H\"",
           {{"x", "X*cos(t) - Y*sin(t)"}, {"y", "X*sin(t) + Y*cos(t) + t^2/2"}, {"th", "H + t"}}},
          {"BentOrder1", "zoo/rheonomic-order-1", "\"X\", \"Y\", \"W\"", bent},
          {"BentOrder2", "zoo/rheonomic-order-2", "\"X\", \"Y\", \"W\"", bent},
          {"BentLinearOrder2",
           "zoo/second-order-linear",
           "\"X\", \"Y\", \"H\"",
           {{"x", "X + t*Y/2"}, {"y", "Y + X^2/5"}, {"th", "H - X"}}},
          {"BentOrder3", "zoo/rheonomic-order-3", "\"X\", \"Y\", \"W\"", bent},
          {"BentLinearOrder3",
           "zoo/third-order-linear",
           "\"X\", \"Y\", \"Z\"",
           {{"x", "X + t*Y/2"}, {"y", "Y + X^2/5"}, {"z", "Z - X*t"}}}};
}

class OtherCoordinates : public testing::TestWithParam<Change> {
 protected:
  System old_system{test::shipped(GetParam().model)}, new_system{changed_text(GetParam())};
  std::shared_ptr<const Model> probe = test::model_of(text_of_places());
  Column places = find_places();

  // The text of a model whose constraints are the old coordinates as functions of the new ones, as the reader makes
  // them.
  std::string text_of_places() const {
    std::string text = changed_text(GetParam());
    text = text.substr(0, text.find("[initial]"));
    for (const auto& [name, value] : GetParam().old_ones)
      text += "[[constraint]]\nname = \"place_" + name + "\"\nequation = \"" + name + " = 0\"\n";
    return text;
  }
  Column find_places() const {
    Column out;
    for (std::size_t i = probe->constraints.size() - GetParam().old_ones.size(); i < probe->constraints.size(); ++i)
      out.push_back(probe->constraints[i].phi);
    return out;
  }
  // Copies time, coordinates, multipliers and their derivatives to the same symbols of another model.
  static void carry(const Model& from, const test::Point& at, const Model& to, test::Point& there) {
    there.set(to.graph->time(), test::value(from.graph->time(), at));
    for (std::uint32_t a = 0; a < from.coordinates.size(); ++a)
      for (unsigned k = 0; k <= kJets; ++k) there.set(to.graph->jet(a, k), test::value(from.graph->jet(a, k), at));
    for (std::uint32_t r = 0; r < from.constraints.size(); ++r)
      for (unsigned k = 0; k <= kJets; ++k)
        there.set(to.graph->multiplier(r, k), test::value(from.graph->multiplier(r, k), at));
  }
  test::Point probe_point(const test::Point& at) const {
    test::Point there = test::random_point(*probe, 1);
    carry(*new_system.model, at, *probe, there);
    return there;
  }
  // The same motion in the old coordinates.
  test::Point old_point(const test::Point& at) const {
    test::Point p = test::random_point(*old_system.model, 1);
    const test::Point there = probe_point(at);
    carry(*new_system.model, at, *old_system.model, p);
    Column c = places;
    for (unsigned k = 0; k <= kJets; ++k) {
      const std::vector<Multi> v = test::values(c, there);
      for (std::uint32_t a = 0; a < v.size(); ++a) p.set(old_system.model->graph->jet(a, k), v[a]);
      if (k < kJets) c = total_derivative(c);
    }
    return p;
  }
  // d old/d new
  Matrix<Multi> jacobian(const test::Point& at) const {
    Rows rows;
    for (Expr c : places) rows.push_back(gradient(c, jets(*probe, 0)));
    return test::values_of(rows, probe_point(at));
  }

  // The largest misses, by rule of transformation.
  std::map<Rule, double> misses(const Formulation& form, bool solve) const {
    const PrecisionScope precision(40);
    const Derived old_one(old_system, form, {}, solve), new_one(new_system, form, {}, solve);
    std::map<Rule, double> worst;
    for (std::uint64_t seed = 1; seed <= kPoints; ++seed) {
      const std::optional<test::Point> at = test::manifold_point(*new_system.model, new_one.e, seed);
      if (!at) return {{Rule::covector, 1e300}};
      const test::Point old_at = old_point(*at);
      const Matrix<Multi> X = old_one.rows(old_at) * (jacobian(*at) * new_one.directions(*at));
      const std::vector<Multi> r_new = test::values(new_one.residual, *at), r = test::values(old_one.residual, old_at);
      for (const Rule rule : {Rule::covector, Rule::transposed, Rule::unchanged})
        worst[rule] = std::max(worst[rule], miss(r_new, r, X, rule));
    }
    return worst;
  }
};

TEST_P(OtherCoordinates, ResidualsAreCovectors) {
  int compared = 0, refuted = 0;
  for (const Formulation* form : formulations()) {
    if (!form->obstacle(old_system.m).empty()) continue;
    const bool by_inverses = std::string(form->name) == "udwadia-kalaba";
    if (by_inverses && std::string(GetParam().name).find("Sleigh") == std::string::npos) continue;  // takes seconds
    ++compared;
    const std::map<Rule, double> solved = misses(*form, true);
    EXPECT_LE(solved.at(Rule::covector), kExact) << form->name;
    refuted += solved.at(Rule::unchanged) > kRefuted && solved.at(Rule::transposed) > kRefuted;
    if (form->eliminates() && !by_inverses) {
      EXPECT_LE(misses(*form, false).at(Rule::covector), kExact) << form->name << ", unsolved";
    }
  }
  EXPECT_GE(compared, 19);
  // The sleigh's frame turns only, so the matrix between two pairs of independent coordinates may be symmetric.
  if (std::string(GetParam().name) == "TurningSleigh")
    EXPECT_GE(refuted, 9);
  else
    EXPECT_EQ(refuted, compared);
}

INSTANTIATE_TEST_SUITE_P(Change, OtherCoordinates, testing::ValuesIn(changes()),
                         [](const auto& p) { return p.param.name; });

// ---- other dependent coordinates, other quasi-velocities
// ----------------------------------------------------------------------

std::vector<std::vector<std::size_t>> subsets(std::size_t n, std::size_t k) {
  std::vector<std::vector<std::size_t>> all;
  for (std::size_t bits = 0; bits < (std::size_t{1} << n); ++bits) {
    std::vector<std::size_t> which;
    for (std::size_t a = 0; a < n; ++a)
      if (bits >> a & 1) which.push_back(a);
    if (which.size() == k) all.push_back(which);
  }
  return all;
}

// For B' = B X, the residuals r' of b are X^T r of those of a.
std::map<Rule, double> misses_between(const Derived& a, const Derived& b) {
  const PrecisionScope precision(40);
  std::map<Rule, double> worst;
  for (std::uint64_t seed = 1; seed <= kPoints; ++seed) {
    const std::optional<test::Point> at = test::manifold_point(*a.s.model, a.e, seed);
    if (!at) return {{Rule::covector, 1e300}};
    const Matrix<Multi> X = a.rows(*at) * b.directions(*at);
    const std::vector<Multi> r_new = test::values(b.residual, *at), r = test::values(a.residual, *at);
    for (const Rule rule : {Rule::covector, Rule::transposed, Rule::unchanged})
      worst[rule] = std::max(worst[rule], miss(r_new, r, X, rule));
  }
  return worst;
}

struct Choices {
  const char* name;
  std::string text, initial;  // a state at which every choice can be eliminated
  std::size_t admissible;     // choices of dependent coordinates
};
void PrintTo(const Choices& c, std::ostream* out) { *out << c.name; }

std::vector<Choices> choices() {
  const std::string generic = "t = 0.5\nx = 0.7\ny = -0.4\nz = 0.6\nw = 0.9\n\"x'\" = 0.3\n\"y'\" = 0.5\n";
  return {{"Sleigh", test::shipped_text("zoo/chaplygin-sleigh"), "th = 0.5\n", 2},
          {"VerticalDisc", test::shipped_text("zoo/vertical-disc"), "", 3},
          {"RheonomicOrder1", test::shipped_text("zoo/rheonomic-order-1"),
           "t = 0.5\nx = 0.5\ny = -0.25\nw = 0.2\n\"x'\" = 0.2\n\"y'\" = 0.5\n", 3},
          {"RheonomicOrder2", test::shipped_text("zoo/rheonomic-order-2"), "", 3},
          {"GenericOrder1", test::generic_system(1, test::Shape::linear), generic, 6},
          {"AffineOrder2", test::generic_system(2, test::Shape::affine), generic + "\"z'\" = -0.7\n\"w'\" = 0.6\n", 6}};
}

class OtherDependents : public testing::TestWithParam<Choices> {
 protected:
  System s{text()};
  static std::string text() {
    const Choices& c = GetParam();
    return c.initial.empty() ? c.text : c.text.substr(0, c.text.find("\n[initial]")) + "\n[initial]\n" + c.initial;
  }
  std::vector<std::vector<std::size_t>> admissible() const {
    std::vector<std::vector<std::size_t>> out;
    for (const auto& which : subsets(s.m.q.size(), s.m.phi.size())) {
      try {
        elimination_for(s.m, Unknowns::coordinates, {}, which);
        out.push_back(which);
      } catch (const Failure&) {
      }
    }
    return out;
  }
};

TEST_P(OtherDependents, TurnResidualsByARegularMatrix) {
  const auto all = admissible();
  EXPECT_EQ(all.size(), GetParam().admissible);
  ASSERT_GE(all.size(), 2U);
  const bool diagonal = std::string(GetParam().name) == "Sleigh";  // x for y, and th stays: X is its own transpose
  int compared = 0, refuted = 0;
  for (const Formulation* form : formulations()) {
    if (form->unknowns != Unknowns::coordinates || !form->obstacle(s.m).empty() ||
        std::string(form->name) == "udwadia-kalaba")
      continue;
    const Derived first(s, *form, all[0], true);
    for (std::size_t k = 1; k < all.size(); ++k) {
      const Derived other(s, *form, all[k], k % 2 == 0);
      ++compared;
      const std::map<Rule, double> found = misses_between(first, other);
      EXPECT_LE(found.at(Rule::covector), kExact) << form->name << ", choice " << k;
      refuted += found.at(Rule::unchanged) > kRefuted && (diagonal || found.at(Rule::transposed) > kRefuted);
    }
  }
  EXPECT_GE(compared, 10);
  EXPECT_EQ(refuted, compared);
}

INSTANTIATE_TEST_SUITE_P(Model, OtherDependents, testing::ValuesIn(choices()),
                         [](const auto& p) { return p.param.name; });

// Compares the quasi-velocities of one text with those of another, on the same constraints.
void compare_quasi(const std::string& text, const std::string& one, const std::string& another) {
  const System a(text + "[quasi]\n" + one), b(text + "[quasi]\n" + another);
  int compared = 0, refuted = 0;
  for (const Formulation* form : formulations()) {
    if (form->unknowns != Unknowns::quasi_velocities || !form->obstacle(a.m).empty()) continue;
    const PrecisionScope precision(40);
    const Derived first(a, *form, {}, true), other(b, *form, {}, true);
    ++compared;
    for (std::uint64_t seed = 1; seed <= kPoints; ++seed) {
      // The two models have two graphs: the same jets get the same values.
      const std::optional<test::Point> at = test::manifold_point(*a.model, first.e, seed);
      ASSERT_TRUE(at);
      test::Point there = test::random_point(*b.model, seed);
      there.set(b.model->graph->time(), test::value(a.model->graph->time(), *at));
      for (std::uint32_t i = 0; i < a.m.q.size(); ++i)
        for (unsigned k = 0; k <= kJets; ++k)
          there.set(b.model->graph->jet(i, k), test::value(a.model->graph->jet(i, k), *at));
      const Matrix<Multi> X = first.rows(*at) * other.directions(there);
      const std::vector<Multi> r = test::values(first.residual, *at), r_new = test::values(other.residual, there);
      EXPECT_LE(miss(r_new, r, X, Rule::covector), kExact) << form->name;
      refuted += miss(r_new, r, X, Rule::transposed) > kRefuted;
      refuted += miss(r_new, r, X, Rule::unchanged) > kRefuted;
    }
  }
  EXPECT_GE(compared, 3);
  EXPECT_EQ(refuted, 2 * kPoints * compared);
}

TEST(OtherQuasiVelocities, TurnResidualsByARegularMatrix) {
  for (const auto& [shape, m] : {std::pair(test::Shape::affine, 1), std::pair(test::Shape::linear, 2)}) {
    const auto top = [order = m](const char* q) { return test::primes(q, order); };
    const std::string one =
        "u = \"" + top("x") + "*(2 + z) + " + top("w") + "/3\"\nv = \"" + top("y") + " + t*" + top("x") + "/4\"\n";
    const std::string another =
        "u = \"" + top("y") + " - x*" + top("x") + "/5\"\nv = \"(3 + t)*" + top("x") + " + y*" + top("z") + "/3\"\n";
    const std::string crooked = "u = \"" + top("y") + "^2/3 + 2*" + top("x") + "\"\nv = \"" + top("y") + " + " +
                                top("w") + "*" + top("x") + "/4\"\n";
    compare_quasi(test::generic_system(m, shape), one, another);
    compare_quasi(test::generic_system(m, shape), one, crooked);
  }
}

TEST(OtherQuasiVelocities, OfTheSleigh) {
  std::string text = test::shipped_text("zoo/chaplygin-sleigh");
  text = text.substr(0, text.find("\n[initial]") + 1);
  compare_quasi(text, "v = \"x'*cos(th) + y'*sin(th)\"\nomega = \"th'\"\n",
                "v1 = \"x' + th'\"\nv2 = \"th'*(2 + x^2) - y'/2\"\n");
}

// At r = 0, p = s = 0 the row of the blade's constraint is zero. The list of quasi-velocities is completed
// nevertheless: it has n of them.
TEST(OtherQuasiVelocities, AreCompletedAtASingularState) {
  const System s(test::replaced(changed_text(changes()[0]), "r = 1", "r = 0"));
  const Elimination e = elimination_for(s.m, Unknowns::quasi_velocities, {}, {});
  EXPECT_EQ(e.quasi->w.size(), s.m.q.size());
}

// ---- other ways to write a constraint
// -----------------------------------------------------------------------------------------

struct Written {
  const char* name;
  const char* model;
  const char* factor;  // a function without zeros
  std::function<Multi(const StateReport&)> value;
};
void PrintTo(const Written& w, std::ostream* out) { *out << w.name; }

Multi number(const std::string& digits) {
  Multi x;
  if (mpfr_set_str(x.raw(), digits.c_str(), 10, MPFR_RNDN) != 0)
    throw std::runtime_error("'" + digits + "' is no number");
  return x;
}

// phi -> g phi in every constraint of the text.
std::string rewritten(const std::string& text, const std::string& g) {
  std::string out;
  std::size_t at = 0;
  const std::string key = "\nequation = \"";
  for (std::size_t next; (next = text.find(key, at)) != std::string::npos;) {
    const std::size_t first = next + key.size(), last = text.find('"', first), equals = text.find('=', first);
    out += text.substr(at, first - at) + "(" + g + ")*(" + text.substr(first, equals - first) + " - (" +
           text.substr(equals + 1, last - equals - 1) + ")) = 0";
    at = last;
  }
  return out + text.substr(at);
}

StateReport report_of(const std::string& text) {
  Scenario s;
  StateReport r;
  Outcome o = make_scenario(test::model_of(text), *find_formulation("routh"), {}, s);
  if (o.ok()) o = evaluate(s, {}, 30, r);
  if (!o.ok()) throw std::runtime_error(o.message);
  return r;
}

double distance_of(const std::vector<std::string>& a, const std::vector<std::string>& b,
                   const Multi& factor = Multi(1)) {
  double worst = a.size() == b.size() ? 0 : 1e300;
  for (std::size_t i = 0; i < std::min(a.size(), b.size()); ++i)
    worst = std::max(worst, test::distance(factor * number(a[i]), number(b[i])));
  return worst;
}

std::vector<std::string> values_of(const StateReport::Named& named) {
  std::vector<std::string> out;
  for (const auto& [name, value] : named) out.push_back(value);
  return out;
}

class OtherWords : public testing::TestWithParam<Written> {};

TEST_P(OtherWords, ForAConstraintChangeTheMultiplierOnly) {
  constexpr double kDigits = 1e-27;  // 30 are printed
  const PrecisionScope precision(45);
  const std::string text = test::shipped_text(GetParam().model);
  const StateReport a = report_of(text), b = report_of(rewritten(text, GetParam().factor));
  EXPECT_LE(distance_of(values_of(a.q), values_of(b.q)), kDigits);
  EXPECT_LE(distance_of(values_of(a.qdot), values_of(b.qdot)), kDigits);
  EXPECT_LE(distance_of(values_of(a.derivatives), values_of(b.derivatives)), kDigits);
  ASSERT_EQ(a.forces.size(), b.forces.size());
  for (std::size_t f = 0; f < a.forces.size(); ++f)
    EXPECT_LE(distance_of(a.forces[f].second, b.forces[f].second), kDigits) << a.forces[f].first;
  EXPECT_EQ(a.forces.back().first, "N");
  const Multi g = GetParam().value(a);
  EXPECT_LE(distance_of(values_of(b.lambda), values_of(a.lambda), g), kDigits);
  // Mutants: lambda in place of N; the factor on the wrong side.
  EXPECT_GT(distance_of(values_of(b.lambda), values_of(a.lambda)), kRefuted);
  EXPECT_GT(distance_of(values_of(a.lambda), values_of(b.lambda), g), kRefuted);
}

Multi first_coordinate(const StateReport& r) { return number(r.q[0].second); }
Multi first_velocity(const StateReport& r) { return number(r.qdot[0].second); }

INSTANTIATE_TEST_SUITE_P(
    Model, OtherWords,
    testing::Values(Written{"Order0", "zoo/double-pendulum-cartesian", "2 + x1^2",
                            [](const StateReport& r) { return Multi(2) + first_coordinate(r) * first_coordinate(r); }},
                    Written{"Order1", "zoo/chaplygin-sleigh", "2 + x",
                            [](const StateReport& r) { return Multi(2) + first_coordinate(r); }},
                    Written{"Order1Nonlinear", "zoo/rheonomic-order-1", "1 + x^2",
                            [](const StateReport& r) { return Multi(1) + first_coordinate(r) * first_coordinate(r); }},
                    Written{"Order1Velocities", "zoo/rheonomic-order-1", "1 + (x')^2",
                            [](const StateReport& r) { return Multi(1) + first_velocity(r) * first_velocity(r); }},
                    Written{"Order2", "zoo/second-order-linear", "1 + x^2",
                            [](const StateReport& r) { return Multi(1) + first_coordinate(r) * first_coordinate(r); }},
                    Written{"Order2Velocities", "zoo/rheonomic-order-2", "1 + (x')^2",
                            [](const StateReport& r) { return Multi(1) + first_velocity(r) * first_velocity(r); }}),
    [](const auto& p) { return p.param.name; });

}  // namespace
}  // namespace anholon::invariance_test
