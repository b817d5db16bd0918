// Forces, energies, powers, reactions and equations of every paired model at the stored states, with the stored leading
// derivatives and multipliers put in. Nothing is solved, so constraints of every order can be judged. The reference
// evaluator computes the values with 40 digits.
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "formulation/formulation.h"
#include "support/model_point.h"
#include "support/models.h"
#include "support/oracle.h"

namespace anholon::terms_test {
namespace {

using nlohmann::json;

constexpr double kTerms = 1e-29;  // 32 digits are stored

Multi number(const json& digits) {
  Multi x;
  if (mpfr_set_str(x.raw(), digits.get<std::string>().c_str(), 10, MPFR_RNDN) != 0)
    throw std::runtime_error(digits.dump() + " is no number");
  return x;
}

class OracleTerms : public testing::TestWithParam<test::OraclePair> {
 protected:
  PrecisionScope precision{40};
  std::shared_ptr<const Model> model = test::shipped(GetParam().model);
  json data = test::oracle_data(GetParam().oracle);
  Mechanics m = mechanics(*model);

  Expr symbol(const std::string& name) const {
    const auto [base, order] = test::split_order(name);
    const std::vector<std::string>& coordinates = model->names.coordinates;
    if (const auto it = std::find(coordinates.begin(), coordinates.end(), base); it != coordinates.end())
      return m.graph().jet(static_cast<std::uint32_t>(it - coordinates.begin()), order);
    const auto whole = std::find(coordinates.begin(), coordinates.end(), name);
    if (whole != coordinates.end()) return m.graph().jet(static_cast<std::uint32_t>(whole - coordinates.begin()), 0);
    if (base.rfind("lam", 0) != 0) throw std::runtime_error("unknown symbol " + name);
    Expr e = m.lambda.at(std::stoul(base.substr(3)) - 1);
    for (unsigned k = 0; k < order; ++k) e = total_derivative(e);
    return e;
  }

  test::Point point(const json& stored) const {
    test::Point p = test::random_point(*model, 1);
    p.set(m.graph().time(), number(stored["t"]));
    for (const char* part : {"state", "solution"})
      for (const auto& [name, value] : stored[part].items()) p.set(symbol(name), number(value));
    return p;
  }

  // The largest error, in units of `scale` or 1, and the name of its quantity.
  struct Worst {
    double error = 0;
    std::string what;
  };
  static void compare(Worst& worst, const std::string& what, const Column& column, const json& stored,
                      const Multi& scale, const test::Point& at) {
    const std::vector<Multi> values = test::values(column, at);
    EXPECT_EQ(values.size(), stored.size()) << what;
    for (std::size_t i = 0; i < values.size(); ++i) {
      const double miss =
          to_double(Multi(abs(Multi(values[i] - number(stored[i]))) / (scale > Multi(1) ? scale : Multi(1))));
      if (!(miss <= worst.error)) worst = {miss == miss ? miss : 1e300, what};
    }
  }

  Column put(const Column& c) const { return put_masses(*model, c); }

  void compare_terms(Worst& worst, const test::Point& at, const json& values) const {
    const std::vector<std::pair<const char*, Column>> forces = {{"Q", put(m.Q)},
                                                                {"QR", put(m.QR)},
                                                                {"Qomega", put(m.Qomega)},
                                                                {"minus_dVO", put(m.minus_dVO)},
                                                                {"minus_dVomega", put(m.minus_dVomega)},
                                                                {"Gamma", put(m.Gamma)},
                                                                {"inertia_term", newton_left_side(m)},
                                                                {"N", put(m.N)}};
    Multi force(1), speed(1);
    for (const auto& [name, column] : forces)
      for (const json& v : values[name])
        if (abs(number(v)) > force) force = abs(number(v));
    for (const Multi& v : test::values(m.qd, at))
      if (abs(v) > speed) speed = abs(v);
    for (const auto& [name, column] : forces) compare(worst, name, column, values[name], force, at);

    const Power p = power(m);
    const std::vector<std::pair<const char*, Expr>> energies = {
        {"T_r", m.T}, {"S_r", m.S}, {"V_O", m.V_O}, {"V_omega", m.V_omega}, {"h", p.h}};
    for (const auto& [name, e] : energies)
      compare(worst, name, put({e}), values[name], abs(number(values[name][0])), at);
    const std::vector<std::pair<const char*, Expr>> powers = {
        {"power_noncons", p.noncons}, {"power_constraint", p.constraint}, {"dh_dt", p.dh_dt}};
    for (const auto& [name, e] : powers) compare(worst, name, {e}, values[name], force * speed, at);

    Column upper;
    const std::vector<Column> mass = mass_matrix(m);
    for (std::size_t i = 0; i < mass.size(); ++i)
      upper.insert(upper.end(), mass[i].begin() + static_cast<std::ptrdiff_t>(i), mass[i].end());
    compare(worst, "mass matrix", upper, values["M_upper"], Multi(1), at);

    std::vector<std::size_t> bodies;  // those with a mass or an inertia, in the order of the file
    for (std::size_t b = 0; b < model->bodies.size(); ++b)
      if (!is_zero(model->bodies[b].mass) || !model->bodies[b].axes.empty()) bodies.push_back(b);
    const std::vector<Load> loads = reactions(*m.model);
    for (const auto& [key, vector] : values.items())
      if (key.rfind("R_total_body", 0) == 0) {
        const Vector& r = loads.at(bodies.at(std::stoul(key.substr(12)))).force;
        compare(worst, key, {r.x, r.y, r.z}, vector, force, at);
      }

    // The stored solution satisfies the constraints and every form with multipliers.
    const auto vanishes = [&](const Column& column, const std::string& what) {
      compare(worst, what, column, json(std::vector<std::string>(column.size(), "0")), force, at);
    };
    vanishes(put(m.phi), "constraints");
    for (const Formulation* form : formulations()) {
      if (form->unknowns != Unknowns::multipliers || !form->obstacle(m).empty()) continue;
      const Equations e = form->equations(m, {});
      vanishes(put(e.left - e.right), form->name);
    }
  }
};

TEST_P(OracleTerms, AtStates) {
  ASSERT_EQ(data["coords"].get<std::vector<std::string>>(), model->names.coordinates);
  std::vector<int> orders;
  for (const json& c : data["constraints"]) orders.push_back(c["order"].get<int>());
  EXPECT_EQ(orders, m.order);
  for (const json& stored : data["states"]) {
    Worst worst;
    compare_terms(worst, point(stored), stored["values"]);
    EXPECT_LE(worst.error, kTerms) << worst.what << " at t = " << stored["t"];
  }
}

INSTANTIATE_TEST_SUITE_P(Model, OracleTerms, testing::ValuesIn(test::oracle_pairs()),
                         [](const auto& p) { return test::test_name(p.param.model); });

// Mutant: a change of the mass in the 26th digit must be seen by the comparison.
class OracleTermsMutant : public OracleTerms {
 protected:
  OracleTermsMutant() {
    model = test::model_of(test::shipped_text(GetParam().model), {{"m", "2*(1 + 1e-25)"}});
    m = mechanics(*model);
  }
};
TEST_P(OracleTermsMutant, IsRefuted) {
  Worst worst;
  compare_terms(worst, point(data["states"][0]), data["states"][0]["values"]);
  EXPECT_GT(worst.error, 100 * kTerms);
}
INSTANTIATE_TEST_SUITE_P(Model, OracleTermsMutant,
                         testing::Values(test::OraclePair{"zoo/constant-jerk", "s16_const_jerk_uniform"}),
                         [](const auto& p) { return test::test_name(p.param.model); });

TEST(OracleData, EverySystemHasAModel) {
  std::vector<std::string> systems, paired;
  for (const auto& entry : std::filesystem::directory_iterator(test::source_dir() / "test/oracle/data"))
    if (entry.path().extension() == ".json") systems.push_back(entry.path().stem().string());
  for (const test::OraclePair& p : test::oracle_pairs()) paired.push_back(p.oracle);
  std::sort(systems.begin(), systems.end());
  std::sort(paired.begin(), paired.end());
  paired.erase(std::unique(paired.begin(), paired.end()), paired.end());
  EXPECT_EQ(systems, paired);
}

}  // namespace
}  // namespace anholon::terms_test
