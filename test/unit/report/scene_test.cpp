// The picture of a model: its items, and that its program places them as the model does.
#include <cmath>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "report/scene.h"
#include "support/models.h"

namespace anholon::scene_test {
namespace {

using Json = nlohmann::json;

// The column of a symbol in a row of coordinates, then velocities, then accelerations.
ColumnOf jets_in_a_row(std::size_t n) {
  return [n](const Node& node) -> std::optional<int> {
    if (node.kind == Kind::time) return -1;
    if (node.kind != Kind::jet || node.order > 2) return std::nullopt;
    return static_cast<int>(node.index + node.order * n);
  };
}

// Runs the program of the page, written a second time from the description of its operations alone.
std::vector<double> run(const Json& scene, const std::vector<double>& row, double t) {
  std::vector<double> v;
  for (const Json& e : scene["code"]) {
    const std::string op = e[0];
    const auto at = [&](std::size_t k) { return v.at(e[k].get<std::size_t>()); };
    if (op == "c")
      v.push_back(e[1]);
    else if (op == "i") {
      const int column = scene["inputs"][e[1].get<std::size_t>()]["column"];
      v.push_back(column < 0 ? t : row.at(static_cast<std::size_t>(column)));
    } else if (op == "l") {
      double s = e[1];
      for (std::size_t k = 2; k < e.size(); k += 2) s += e[k].get<double>() * at(k + 1);
      v.push_back(s);
    } else if (op == "*")
      v.push_back(at(1) * at(2));
    else if (op == "/")
      v.push_back(at(1) / at(2));
    else if (op == "^")
      v.push_back(std::pow(at(1), e[2].get<double>()));
    else if (op == "f" && e[1] == "sin")
      v.push_back(std::sin(at(2)));
    else if (op == "f" && e[1] == "cos")
      v.push_back(std::cos(at(2)));
    else
      ADD_FAILURE() << "an operation that this test does not know: " << op, v.push_back(0);
  }
  return v;
}

Json scene_of(const Model& model, bool contacts = false) {
  const Mechanics m = mechanics(model);
  JsonWriter j;
  write_scene(j, scene(m, contacts), *model.graph, jets_in_a_row(model.coordinates.size()), {});
  return Json::parse(j.text());
}

const Json& item(const Json& scene, const std::string& kind, const std::string& name) {
  for (const Json& i : scene["items"])
    if (i["kind"] == kind && i["name"] == name) return i;
  static const Json none;
  ADD_FAILURE() << "no " << kind << " " << name;
  return none;
}

TEST(Scene, ADiscStandsOnItsContact) {
  const auto model = test::shipped("zoo/disc");
  const Json s = scene_of(*model);
  EXPECT_FALSE(s["camera"]["flat"]);
  EXPECT_EQ(s["floor"]["z"], 0);
  const Json& disc = item(s, "body", "disc");
  EXPECT_EQ(disc["shape"], "disc");
  EXPECT_EQ(disc["sizes"], Json::parse("[0.5]"));
  // x, y, psi, theta, phi and their derivatives
  const std::vector<double> row = {1, 2, 0.3, 1.1, 4, 0.5, -1, 0.2, 0.7, 6, 0, 0, 0, 0, 0};
  const std::vector<double> v = run(s, row, 0);
  const auto slot = [&](const Json& slots, std::size_t k) { return v.at(slots[k].get<std::size_t>()); };
  const double R = 0.5;
  // lean = rotz(psi) rotx(theta): lean.y = (-sin psi cos theta, cos psi cos theta, sin theta)
  EXPECT_NEAR(slot(disc["position"], 0), 1 - R * std::sin(0.3) * std::cos(1.1), 1e-14);
  EXPECT_NEAR(slot(disc["position"], 1), 2 + R * std::cos(0.3) * std::cos(1.1), 1e-14);
  EXPECT_NEAR(slot(disc["position"], 2), R * std::sin(1.1), 1e-14);
  // The axle lean.z = (sin psi sin theta, -cos psi sin theta, cos theta) is the body's z axis.
  EXPECT_NEAR(slot(disc["axes"], 6), std::sin(0.3) * std::sin(1.1), 1e-14);
  EXPECT_NEAR(slot(disc["axes"], 8), std::cos(1.1), 1e-14);
  // The mass centre rises with R cos(theta) theta'.
  const Json& velocity = item(s, "vector", "velocity of disc");
  EXPECT_NEAR(slot(velocity["vector"], 2), R * std::cos(1.1) * 0.7, 1e-14);
}

TEST(Scene, PlaneModelsAreFlatAndDrawnByTheirView) {
  const Json s = scene_of(*test::shipped("zoo/car-three-trailers"));
  EXPECT_TRUE(s["camera"]["flat"]);
  EXPECT_TRUE(s["floor"].is_null());
  EXPECT_EQ(item(s, "body", "car")["shape"], "box");
  EXPECT_EQ(item(s, "line", "bars")["points"].size(), 4U);
  for (const Json& i : s["items"]) EXPECT_NE(i["kind"], "point");  // hidden
}

TEST(Scene, FloorFalseIsNeitherFloorNorGrid) {
  const auto floor_of = [](const std::string& view) {
    const std::string model = R"toml(coordinates = ["x", "y", "z"]
particle = [{name = "p", mass = 1, position = "x*ex + y*ey + z*ez"}]
gravity.field = "-9.81*ez"
)toml";
    return scene_of(*test::model_of(model + view))["floor"];
  };
  EXPECT_EQ(floor_of("view.floor = false\n"), false);
  EXPECT_EQ(floor_of("view.floor = -1\n")["z"], -1);
  EXPECT_NE(floor_of(""), false);
}

TEST(Scene, WithoutAViewParticlesLeaveTheirPath) {
  Diagnostics d;
  const auto model = read_model(
      SourceText{"m.toml", "coordinates = [\"x\"]\n[[particle]]\nname = \"p\"\nmass = 1\nposition = \"x*ex\"\n"}, d);
  ASSERT_TRUE(model);
  const Json s = scene_of(*model);
  EXPECT_EQ(item(s, "trace", "p")["of"], "p");
  EXPECT_EQ(item(s, "body", "p")["shape"], "point");
}

TEST(Scene, TheReactionIsThatOfTheConstraint) {
  const auto model = test::shipped("zoo/chaplygin-sleigh");
  const Json s = scene_of(*model);
  // x, y, th; at th = 0.4 with some accelerations: the reaction is m a, as no other force acts
  const std::vector<double> row = {0, 0, 0.4, 1, 0.5, 2, 3, -1, 0.7};
  const std::vector<double> v = run(s, row, 0);
  const Json& f = item(s, "vector", "reaction of sleigh");
  const double m = 2, a = 0.6, c = std::cos(0.4), sn = std::sin(0.4);
  const double ax = 3 - a * (sn * 0.7 + c * 4), ay = -1 + a * (c * 0.7 - sn * 4);
  EXPECT_NEAR(v.at(f["vector"][0].get<std::size_t>()), m * ax, 1e-13);
  EXPECT_NEAR(v.at(f["vector"][1].get<std::size_t>()), m * ay, 1e-13);
}

// The force of a contact follows from the accelerations of the run.
TEST(Scene, TheForceOfAContactIsAReaction) {
  const auto model = test::shipped("contacts/bead-in-hoop");
  const Json s = scene_of(*model, true);
  const std::vector<double> v = run(s, {0.6, -0.8, 1, 2, -3, 4}, 0);
  const Json& f = item(s, "vector", "reaction of bead");
  EXPECT_NEAR(v.at(f["vector"][0].get<std::size_t>()), 0.1 * -3, 1e-15);
  EXPECT_NEAR(v.at(f["vector"][2].get<std::size_t>()), 0.1 * (4 + 9.81), 1e-15);
  EXPECT_EQ(scene_of(*model)["items"].dump().find("reaction of bead"), std::string::npos);
}

}  // namespace
}  // namespace anholon::scene_test
