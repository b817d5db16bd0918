// Random drops of boxes, balls and discs: the energy never grows, no gap is negative, and each motion ends by name.
// `./dev long` (ANHOLON_LONG=1) computes 10^4 of them.
#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <thread>

#include <gtest/gtest.h>

#include "support/contact_motion.h"

namespace anholon {
namespace drops_test {

// Numbers from 0 to 1 that are the same for every library: a linear congruential generator.
class Numbers {
 public:
  explicit Numbers(std::uint64_t seed) : state_(seed * 2862933555777941757ULL + 3037000493ULL) {}
  double operator()(double from, double to) {
    state_ = state_ * 6364136223846793005ULL + 1442695040888963407ULL;
    return from + (to - from) * static_cast<double>(state_ >> 11) * 0x1p-53;
  }

 private:
  std::uint64_t state_;
};

std::string number(const std::string& key, double x) { return key + " = " + std::to_string(x) + "\n"; }

// A body in the plane y = 0 over a floor, beside a wall, or in a corner of both. All four corners of a box may touch.
std::string drop(std::uint64_t seed, const std::string& law = "newton") {
  Numbers random(seed);
  const int kind = static_cast<int>(seed % 3);
  const bool wall = seed % 2 == 1 && kind > 0;
  const double a = random(0.1, 0.5), b = random(0.1, 0.5);
  std::string text = R"toml(coordinates = ["x", "z", "th"]
frame.B = "roty(th)"
point.C = "x*ex + z*ez"
gravity.field = "-g*ez"
[parameters]
m = 1
g = 9.81
)toml";
  text += number("a", a) + number("b", b) + number("mu", std::max(0.0, random(-0.3, 1))) +
          number("e", std::max(0.0, random(-0.4, 0.9)));
  const char* const kShapes[] = {"box(2*a, 1, 2*b)", "ball(a)", "disc(a)"};
  const char* const kInertias[] = {"m*(a^2 + b^2)/3", "2/5*m*a^2", "m*a^2/2"};
  const std::string J = kInertias[kind];
  text += "[[body]]\nname = \"body\"\nmass = \"m\"\ncenter = \"C\"\norientation = \"B\"\ninertia = [\"" + J + "\", \"" +
          J + "\", \"" + J + "\"]\n";
  const std::string rough = "friction = \"mu\"\nrestitution = \"e\"\nimpact = \"" + law + "\"\n";
  if (kind == 0) {
    text += "[[contact]]\nname = \"floor\"\nbody = \"body\"\nshape = \"" + std::string(kShapes[0]) + "\"\n" + rough;
  } else {
    text +=
        "[[contact]]\nname = \"floor\"\ngap = \"z - a\"\nslip = \"vel(body, C - a*ez)\"\nalong = [\"ex\"]\n" + rough;
    if (wall)
      text += "[[contact]]\nname = \"wall\"\ngap = \"3 - x - a\"\nslip = \"vel(body, C + a*ex)\"\nalong = [\"ez\"]\n" +
              rough;
  }
  text += "[monitor]\nenergy = \"m*(x'^2 + z'^2)/2 + " + J + "*th'^2/2 + m*g*z\"\n[initial]\n";
  return text + number("z", random(0.75, 1.5)) + number("th", random(-3, 3)) + number("\"x'\"", random(-2, 2)) +
         number("\"z'\"", random(-2, 2)) + number("\"th'\"", random(-6, 6));
}

struct Found {
  double gains = 0, depth = 0;  // the largest growth of the energy between rows, the deepest gap
  Outcome outcome;
  std::vector<double> last;
};

Found look_at(const std::string& text, const Overrides& overrides = {}) {
  const auto m = test::contact_motion(text, 2, overrides);
  Found f;
  f.outcome = m.report.outcome;
  const auto& names = m.rows.names();
  for (std::size_t k = 0; k < m.rows.rows().size(); ++k) {
    if (k > 0) f.gains = std::max(f.gains, m.number(k, "energy") - m.number(k - 1, "energy"));
    for (const std::string& name : names)
      if (name.size() > 4 && name.compare(name.size() - 4, 4, ".gap") == 0)
        f.depth = std::max(f.depth, -m.number(k, name));
  }
  for (const char* name : {"t", "x", "z", "th", "x'", "z'", "th'"}) f.last.push_back(m.last(name));
  return f;
}

TEST(Drops, EnergyNeverGrowsAndNothingPenetrates) {
  const std::size_t count = std::getenv("ANHOLON_LONG") ? 10'000 : 150;
  const unsigned threads = std::max(2U, std::thread::hardware_concurrency());
  std::vector<Found> found(count), again(20);
  const auto all = [&](std::vector<Found>& list, unsigned workers) {
    std::vector<std::thread> pool;
    for (unsigned w = 0; w < workers; ++w)
      pool.emplace_back([&list, w, workers] {
        for (std::size_t k = w; k < list.size(); k += workers) list[k] = look_at(drop(k + 1));
      });
    for (std::thread& t : pool) t.join();
  };
  all(found, threads);
  all(again, 1);
  std::size_t finished = 0;
  for (std::size_t k = 0; k < count; ++k) {
    // Both bounds are round-off: energies are about 20, places about 1.
    EXPECT_LE(found[k].gains, 1e-11) << k + 1;
    EXPECT_LE(found[k].depth, 1e-12) << k + 1;
    const Outcome& o = found[k].outcome;
    finished += o.ok();
    EXPECT_TRUE(o.ok() || o.message.find("Painlev") != std::string::npos ||
                o.message.find("raise the energy") != std::string::npos)
        << k + 1 << ": " << o.message;
  }
  EXPECT_GT(finished, count * 99 / 100);
  for (std::size_t k = 0; k < again.size(); ++k)
    EXPECT_EQ(std::memcmp(again[k].last.data(), found[k].last.data(), again[k].last.size() * sizeof(double)), 0)
        << k + 1;
}

// Poisson's law never raises the energy, so all drops finish.
TEST(Drops, PoissonsLawFinishes) {
  for (std::uint64_t k = 1; k <= 40; ++k) {
    const Found f = look_at(drop(k, "poisson"));
    EXPECT_TRUE(f.outcome.ok() || f.outcome.message.find("Painlev") != std::string::npos) << k << f.outcome.message;
    EXPECT_LE(f.gains, 1e-11) << k;
    EXPECT_LE(f.depth, 1e-12) << k;
  }
}

// In some drops a corner is pushed below the depth of its hit while another one comes to rest. In others a disc spins
// in the corner of a floor and a wall: friction of the floor drives it against the wall, and its impacts there come to
// rest.
TEST(Drops, HardOnesFinish) {
  for (const std::uint64_t k : {1001025, 1001268, 1002563, 1002635}) {
    const Found f = look_at(drop(k));
    EXPECT_TRUE(f.outcome.ok()) << k << f.outcome.message;
    EXPECT_LE(f.gains, 1e-11) << k;
    EXPECT_LE(f.depth, 1e-12) << k;
  }
  // Both contacts slip: the floor carries m g/(1 + mu^2), the wall mu times as much.
  const auto m = test::contact_motion(drop(1002563), Rational(191, 100));
  const double mu = 0.257532, N = 9.81 / (1 + mu * mu);
  EXPECT_EQ(m.last("floor.mode"), 1);
  EXPECT_EQ(m.last("wall.mode"), 1);
  EXPECT_NEAR(m.last("floor.normal"), N, 1e-12);
  EXPECT_NEAR(m.last("wall.normal"), mu * N, 1e-12);
}

// A box in space turns over an edge and lands on a face; all products in the rate of its quaternion's norm are
// round-off then.
TEST(Drops, ABoxInSpaceLandsOnAFace) {
  const std::string J[] = {"0.15052933333333332", "0.11998166666666665", "0.11174833333333334"};
  const auto m = test::contact_motion(R"toml(coordinates = ["x", "y", "z", "e0", "e1", "e2", "e3"]
parameters = {m = 1, g = 9.81}
gravity.field = "-g*ez"
[[body]]
name = "body"
mass = "m"
center = "x*ex + y*ey + z*ez"
orientation = "quat(e0, e1, e2, e3)"
shape = "box(0.698, 0.924, 0.976)"
inertia = [)toml" + J[0] + ", " + J[1] + ", " +
                                          J[2] + R"toml(]
[[contact]]
name = "floor"
body = "body"
friction = 0.733
impact = "poisson"
[monitor]
energy = "m/2*(x'^2 + y'^2 + z'^2) + m*g*z + )toml" +
                                          J[0] + "*2*(e0*e1' - e1*e0' - e2*e3' + e3*e2')^2 + " + J[1] +
                                          "*2*(e0*e2' - e2*e0' - e3*e1' + e1*e3')^2 + " + J[2] +
                                          R"toml(*2*(e0*e3' - e3*e0' - e1*e2' + e2*e1')^2"
[initial]
z = 1.6
"x'" = 0.428
"y'" = -0.55
"z'" = -0.014
e0 = 0.3707911100995236
e1 = 0.7542773124125622
e2 = 0.493980819020853
e3 = -0.22262668099383814
"e0'" = 0.9401848616774339
"e1'" = -0.16275931327320214
"e2'" = -1.0868492149766695
"e3'" = -1.397119755833029
)toml",
                                      Rational(3, 2));
  EXPECT_TRUE(m.report.outcome.ok()) << m.report.outcome.message;
  for (std::size_t k = 1; k < m.rows.rows().size(); ++k)
    EXPECT_LE(m.number(k, "energy"), m.number(k - 1, "energy") + 1e-11) << k;
  for (const char* corner : {"floor1", "floor2", "floor3", "floor4", "floor5", "floor6", "floor7", "floor8"})
    EXPECT_GE(m.last(std::string(corner) + ".gap"), -1e-12) << corner;
}

struct BoxInSpace {
  std::array<double, 3> sizes;
  double friction = 0, restitution = 0;
  std::array<double, 2> gravity;  // along the floor, and onto it
  std::array<double, 4> along;    // z, x', y', z'
  std::array<double, 8> turned;   // e0 … e3, e0' … e3'
};

std::string digits(double x) {
  char text[32];
  return {text, std::to_chars(text, text + sizeof text, x).ptr};
}

std::string box_in_space(const BoxInSpace& of) {
  std::string text = R"toml(coordinates = ["x", "y", "z", "e0", "e1", "e2", "e3"]
parameters = {m = 1, gx = )toml" +
                     digits(of.gravity[0]) + ", gz = " + digits(of.gravity[1]) + R"toml(}
gravity.field = "gx*ex - gz*ez"
[[body]]
name = "body"
mass = "m"
center = "x*ex + y*ey + z*ez"
orientation = "quat(e0, e1, e2, e3)"
shape = "box()toml";
  std::vector<std::string> J;
  for (std::size_t i = 0; i < 3; ++i) {
    const double a = of.sizes[(i + 1) % 3] / 2, b = of.sizes[(i + 2) % 3] / 2;
    J.push_back(digits((a * a + b * b) / 3));
    text += digits(of.sizes[i]) + (i < 2 ? ", " : ")\"\n");
  }
  text += "inertia = [" + J[0] + ", " + J[1] + ", " + J[2] +
          "]\n[[contact]]\nname = \"floor\"\nbody = \"body\"\nfriction = " + digits(of.friction) +
          "\nrestitution = " + digits(of.restitution) + "\nimpact = \"poisson\"\n[monitor]\n" +
          "energy = \"m/2*(x'^2 + y'^2 + z'^2) + m*gz*z - m*gx*x + " + J[0] +
          "*2*(e0*e1' - e1*e0' - e2*e3' + e3*e2')^2 + " + J[1] + "*2*(e0*e2' - e2*e0' - e3*e1' + e1*e3')^2 + " + J[2] +
          "*2*(e0*e3' - e3*e0' - e1*e2' + e2*e1')^2\"\n[initial]\n";
  const char* const kAlong[] = {"z", "\"x'\"", "\"y'\"", "\"z'\""};
  for (std::size_t k = 0; k < 4; ++k) text += std::string(kAlong[k]) + " = " + digits(of.along[k]) + "\n";
  for (std::size_t k = 0; k < 8; ++k)
    text +=
        (k < 4 ? "e" + std::to_string(k) : "\"e" + std::to_string(k - 4) + "'\"") + " = " + digits(of.turned[k]) + "\n";
  return text;
}

void expect_a_motion(const BoxInSpace& of, const Rational& to) {
  const auto m = test::contact_motion(box_in_space(of), to);
  EXPECT_TRUE(m.report.outcome.ok()) << m.report.outcome.message;
  for (std::size_t k = 1; k < m.rows.rows().size(); ++k)
    EXPECT_LE(m.number(k, "energy"), m.number(k - 1, "energy") + 1e-11) << k;
}

// After the impact of an edge the box turns about an axis. Two components of its quaternion have rates of the size of
// round-off, which the norm needs.
TEST(Drops, ABoxInSpaceKeepsTheNormOfItsQuaternion) {
  expect_a_motion({{0.284, 0.768, 0.506},
                   0.6,
                   0.18,
                   {0.6176212542790208, 9.790538493170986},
                   {1.262, -0.898, 1.267, 0.555},
                   {-0.5288906473196648, -0.6116083416315318, 0.49958516736233455, 0.3108449455533441,
                    -1.965526734265035, 1.239284692913281, -0.08660760030962811, -0.766697293558125}},
                  Rational(11, 10));
}

// The slips of the four corners of a rod end within 1e-10 s, two of them first. These begin again without reversing the
// others, whose friction would drive the rod.
TEST(Drops, ARodInSpaceComesToRestWithoutBeingDriven) {
  expect_a_motion({{0.04, 0.04, 0.554},
                   0.168,
                   0.059,
                   {0, 9.81},
                   {0.935, 0.231, 0.403, -1.878},
                   {-0.6364831818611896, 0.4258804203865304, -0.3341322335228921, 0.5494275905524326,
                    0.5733085506011308, -0.31318011780636923, -0.9420969374101198, 0.33397226489208065}},
                  Rational(6, 10));
}

// The mutants: a rising floor lifts the body, whose energy grows.
TEST(Drops, MutantsAreFound) {
  for (std::uint64_t k = 1; k <= 6; ++k) {
    std::string lifted = drop(3 * k - 1);
    lifted.replace(lifted.find("gap = \"z - a\""), 13, "gap = \"z - a - t/9\"");
    EXPECT_GT(look_at(lifted).gains, 1e-3) << k;
  }
}

}  // namespace drops_test
}  // namespace anholon
