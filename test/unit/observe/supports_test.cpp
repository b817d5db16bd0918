// Which constraints are floors, and which only resemble one.
#include <gtest/gtest.h>

#include "observe/floors/supports.h"
#include "support/models.h"

namespace anholon::supports_test {
namespace {

// A plate that stands on two feet, 2 apart, with its mass centre 1 above them.
std::string plate(const std::string& constraints, const std::string& more = "") {
  return "coordinates = [\"x\", \"y\", \"theta\"]\ngravity.field = \"-9.81*ey\"\npoint.rear = \"x*ex + y*ey - "
         "rotz(theta).x\"\npoint.front = \"x*ex + y*ey + rotz(theta).x\"\n" +
         more +
         "[[body]]\nname = \"plate\"\nmass = 2\ninertia = 1\ncenter = \"x*ex + y*ey + rotz(theta).y\"\nangle = "
         "\"theta\"\n" +
         constraints;
}

std::string constraint(const std::string& name, const std::string& equation) {
  return "[[constraint]]\nname = \"" + name + "\"\nequation = \"" + equation + "\"\n";
}

Scenario scenario(const std::string& text) {
  Scenario s;
  EXPECT_TRUE(make_scenario(test::model_of(text), *find_formulation("routh"), {}, s).ok());
  return s;
}

std::vector<Support> floors_of(const std::string& text) {
  const Scenario s = scenario(text);
  return floors(s, translations(s));
}

std::vector<std::string> names(const Scenario& s, const std::vector<Support>& list) {
  std::vector<std::string> all;
  for (const Support& f : list) all.push_back(s.model->constraints[f.constraint].name);
  return all;
}

std::vector<std::string> floors(const std::string& text) {
  const Scenario s = scenario(text);
  return names(s, floors(s, translations(s)));
}

std::vector<std::string> carriers(const std::string& text) {
  const Scenario s = scenario(text);
  return names(s, carriers(s, floors(s, translations(s))));
}

TEST(Supports, AreHeightsAlone) {
  EXPECT_EQ(floors(plate(constraint("back", "rear.y = 0") + constraint("ahead", "front.y = 0"))),
            (std::vector<std::string>{"back", "ahead"}));
  EXPECT_EQ(floors(plate(constraint("back", "3*rear.y = 0"))), std::vector<std::string>{"back"}) << "times a number";
}

TEST(Supports, AreNoHingesRailsAndRods) {
  EXPECT_TRUE(
      floors(plate("[[constraint]]\nname = \"hinge\"\nequation = \"rear = -ex\"\nalong = [\"ex\", \"ey\"]\n")).empty())
      << "a hinge";
  EXPECT_TRUE(floors(plate(constraint("a", "rear.y = 0") + constraint("b", "rear.x = -1"))).empty())
      << "held sideways, too";
  EXPECT_TRUE(floors(plate(constraint("a", "rear.y + rear.x = -1") + constraint("b", "rear.y - rear.x = 1"))).empty())
      << "a hinge in turned axes";
  EXPECT_TRUE(floors(plate(constraint("rod", "front.x^2 + front.y^2 = 1"))).empty()) << "a rod";
  EXPECT_TRUE(floors(plate(constraint("level", "theta = 0"))).empty()) << "no height";
  EXPECT_TRUE(
      floors(test::replaced(plate(constraint("back", "rear.y = 0")), "gravity.field = \"-9.81*ey\"\n", "")).empty())
      << "no gravity";
}

// The plate is braked with 10 t at the height of the feet, 1 below the mass centre: the load of the rear foot is m (g -
// a h / l) / 2 with m a = 10 t.
TEST(Supports, PullWhereTheLoadSaysSo) {
  Scenario s;
  ASSERT_TRUE(
      make_scenario(test::model_of(plate(constraint("back", "rear.y = 0") + constraint("ahead", "front.y = 0"))),
                    *find_formulation("routh"), {}, s)
          .ok());
  SupportWatch watch(s, floors(s, translations(s)));
  ASSERT_TRUE(watch.any());
  const std::vector<double> numbers(9, 0.0);
  // lambda of both feet at three moments; the equation has its height on the left, so a multiplier is the force
  // upwards.
  const double loads[3][2] = {{9.81, 9.81}, {-1, 20.6}, {-4, 23.6}};
  for (int k = 0; k < 3; ++k) watch.see(k, [&](std::size_t r) { return loads[k][r]; }, numbers);
  const std::vector<std::string> notes = watch.notes();
  ASSERT_EQ(notes.size(), 1u);
  EXPECT_EQ(notes[0],
            "constraint 'back' looks like a floor and pulls down from t = 1 on, at most with 4 at t = 2: a "
            "body that may lift would leave it; one_sided = true in the constraint lets it open, with the equation "
            "rear.y = 0");
}

// The sign depends neither on the side of the equation on which the height stands nor on the sense of the coordinate.
TEST(Supports, TheSignIsThatOfTheForce) {
  const auto upwards = [](const std::string& text) {
    const auto list = floors_of(text);
    return list.empty() ? 0 : list[0].upwards;
  };
  EXPECT_EQ(upwards(plate(constraint("back", "rear.y = 0"))), 1);
  EXPECT_EQ(upwards(plate(constraint("back", "0 = rear.y"))), -1);
  EXPECT_EQ(upwards(plate(constraint("back", "2*rear.y = 0"))), 2);
  const std::string depth =
      test::replaced(test::replaced(test::replaced(plate(constraint("back", "rear.y = 0")), "rear = \"x*ex + y*ey",
                                                   "rear = \"x*ex - y*ey"),
                                    "front = \"x*ex + y*ey", "front = \"x*ex - y*ey"),
                     "center = \"x*ex + y*ey", "center = \"x*ex - y*ey");
  EXPECT_EQ(upwards(depth), 1);
}

// A plane may be oblique to gravity, and gravity to the axes; a ground is no plane.
TEST(Supports, AreSlopesAndGrounds) {
  const auto one = [](const std::string& text) {
    const auto list = floors_of(text);
    EXPECT_EQ(list.size(), 1u);
    return list.empty() ? Support{} : list[0];
  };
  const Support rail = one(plate(constraint("rail", "rear.y = 0.75*(rear.x + 1)")));
  EXPECT_EQ(rail.kind, Support::Kind::floor);
  EXPECT_NEAR(rail.upwards, 1.25, 1e-14) << "the length of its gradient";
  EXPECT_FALSE(rail.level);
  const Support wire = one(plate(constraint("wire", "0.1*(rear.x + 1)^2 = rear.y")));
  EXPECT_EQ(wire.kind, Support::Kind::ground);
  EXPECT_EQ(wire.upwards, -1);
  const std::string floor = plate(constraint("back", "2*rear.y = 0")), field = "gravity.field = \"-9.81*ey\"\n";
  const Support askew = one(test::replaced(floor, field, "gravity.field = \"3*ex - 9*ey\"\n"));
  EXPECT_EQ(askew.upwards, 2);
  EXPECT_FALSE(askew.level);
  EXPECT_TRUE(one(floor).level);
  // The weight is given as a force.
  const std::string force = "[[force]]\non = \"plate\"\nvector = ";
  EXPECT_EQ(one(test::replaced(floor, field, "") + force + "\"3*ex - 9*ey\"\n").upwards, 2);
  EXPECT_TRUE(floors(test::replaced(floor, field, "") + force + "\"3*ex - 9*t*ey\"\n").empty())
      << "a force that varies is no weight";
}

// A particle in the given coordinates.
std::string particle(const std::string& coordinates, const std::string& position, const std::string& start) {
  return "coordinates = [" + coordinates +
         "]\ngravity.field = \"-9.81*ez\"\n[[particle]]\nname = \"bead\"\nmass = 2\nposition = \"" + position +
         "\"\n[initial]\n" + start;
}
const char* const kPlane = "\"x\", \"z\"";

TEST(Supports, CarryOneBody) {
  const std::string plane = particle(kPlane, "x*ex + z*ez", "z = 1\n");
  EXPECT_EQ(carriers(plane + constraint("hoop", "x^2 + z^2 = 1")), std::vector<std::string>{"hoop"});
  EXPECT_EQ(carriers(particle("\"r\", \"a\"", "r*sin(a)*ex + r*cos(a)*ez", "r = 1\n") + constraint("hoop", "r = 1")),
            std::vector<std::string>{"hoop"})
      << "in polar coordinates";
  const std::string space = particle("\"x\", \"y\", \"z\"", "x*ex + y*ey + z*ez", "z = 1\n");
  EXPECT_EQ(carriers(space + constraint("ball", "norm(bead) = 1")), std::vector<std::string>{"ball"});
  EXPECT_EQ(carriers(space + constraint("hoop", "x^2 + z^2 = 1") + constraint("wall", "y = 0")),
            std::vector<std::string>{"hoop"})
      << "what holds it across the plane carries nothing";
}

TEST(Supports, CarryNoHingesLinksAndDrives) {
  const std::string plane = particle(kPlane, "x*ex + z*ez", "z = 1\n");
  EXPECT_TRUE(carriers(particle(kPlane, "x*ex + z*ez", "x = 1\n") + constraint("hoop", "x^2 + z^2 = 1")).empty())
      << "it carries no weight here";
  EXPECT_TRUE(carriers(plane + constraint("arm", "x*cos(t) = (z - 1)*sin(t)")).empty()) << "a drive";
  EXPECT_TRUE(carriers(test::file_text(test::source_dir() / "models/zoo/double-pendulum-cartesian.toml")).empty())
      << "rods that end at bodies";
  EXPECT_TRUE(carriers(test::file_text(test::source_dir() / "models/asked/closed-chain.toml")).empty()) << "a linkage";
  EXPECT_TRUE(carriers(plate(constraint("rod", "front.x^2 + front.y^2 = 1"))).empty())
      << "a rod beside the mass centre";
  // The slider of a slider-crank is guided on both sides.
  EXPECT_TRUE(
      carriers("coordinates = [\"a\", \"b\"]\ngravity.field = \"-9.81*ez\"\npoint.P = \"sin(a)*ex + cos(a)*ez\"\n"
               "[[particle]]\nname = \"pin\"\nmass = 1\nposition = \"P\"\n[[particle]]\nname = \"slider\"\nmass = 1\n"
               "position = \"P + 2*sin(b)*ex - 2*cos(b)*ez\"\n[initial]\nb = 1.2\n" +
               constraint("guide", "slider.z = 0"))
          .empty());
  // A hinge is written as two equations.
  const std::string rod =
      "coordinates = [\"x\", \"y\", \"theta\"]\ngravity.field = \"-9.81*ey\"\n[[body]]\nname = \"rod\"\nmass = 1\n"
      "inertia = 0.1\ncenter = \"x*ex + y*ey\"\nangle = \"theta\"\n[initial]\ny = -1\n" +
      constraint("a", "x = sin(theta)") + constraint("b", "y = -cos(theta)");
  EXPECT_TRUE(floors(rod).empty());
  EXPECT_TRUE(carriers(rod).empty());
}

// Rolling with a component along the normal shares the normal force with the surface.
TEST(Supports, CarryBallsThatRollAlongTheSurface) {
  const auto ball = [](const std::string& rolling) {
    return "coordinates = [\"x\", \"z\", \"phi\"]\ngravity.field = \"-9.81*ez\"\npoint.C = \"x*ex + z*ez\"\n[[body]]\n"
           "name = \"ball\"\nmass = 2\nshape = \"ball(0.1)\"\ncenter = \"C\"\norientation = \"roty(phi)\"\n" +
           constraint("top", "norm(C) = 1") + constraint("rolling", rolling) + "[initial]\nz = 1\n";
  };
  EXPECT_EQ(carriers(ball("dot(vel(ball, 0.9*C), z*ex - x*ez) = 0")), std::vector<std::string>{"top"});
  EXPECT_TRUE(carriers(ball("vel(ball, 0.9*C).x = 0")).empty());
}

}  // namespace
}  // namespace anholon::supports_test
