// The examples of Luo and Zhao with functions of time left open: equations as a machine has read them, which loses dots, and as
// they have to read.
#include <gtest/gtest.h>

#include <span>

#include "published/subject.h"

namespace anholon {
namespace {

const char* const kParticle = R"toml(coordinates = ["r", "psi", "phi"]
[parameters]
k = 2
w = 0.7
c = 1.5
[functions]
m = {}
ur = {}
up = {}
uf = {}
[frame]
local = "rotz(phi)*roty(-psi)"
[point]
P = "r*local.x"
[observer]
spin = "w*ez"
[[particle]]
name = "particle"
mass = "m"
position = "P"
expelled_velocity = "ur*local.x + uf*local.y + up*local.z"
[[force]]
name = "attraction"
on = "particle"
vector = "-k^2*m/r^2*local.x"
[[constraint]]
name = "speed"
equation = "r'^2 + r^2*psi'^2 + r^2*cos(psi)^2*phi'^2 - c^2 = 0"
)toml";
const char* const kSleigh = R"toml(coordinates = ["x", "y", "theta"]
[parameters]
M     = 3
a     = 0.5
J     = "2/3"
b     = 0.8
u     = 2
alpha = 0.4
[functions]
m = {}
phi = {}
vx = {}
vy = {}
[define]
omega = "phi'"
[frame]
blade = "rotz(theta)"
jet   = "blade*rotz(alpha)"
[point]
P = "x*ex + y*ey"
C = "P + a*blade.x"
B = "P + b*blade.x"
[observer]
rotation = "rotz(phi)"
origin_velocity_inertial = ["vx", "vy", "0"]
[[body]]
name = "sleigh"
mass = "M"
inertia = "J"
center = "C"
orientation = "blade"
[[particle]]
name = "rocket"
mass = "m"
position = "B"
expelled_velocity = "-u*jet.x"
[[constraint]]
name = "blade_edge"
equation = "y' = x'*tan(theta)"
)toml";

struct Line {
  const char *label, *meant, *read;
};
const Line kOfParticle[] = {
    {"4.1p",
     "r'^2 + r^2*psi'^2 + r^2*cos(psi)^2*phi'^2 - c^2 = 0",
     "r'^2 + r^2*psi'^2 + r^2*c^2*phi'^2 - c^2 = 0"},
    {"4.3.r.p",
     "m*r'' - m*r*(psi'^2 + phi'^2*cos(psi)^2) = -k^2/r^2*m + m'*ur + 2*m*w*r*phi'*cos(psi)^2 + m*w^2*r*cos(psi)^2 + 2*r'*lambda",
     "m*r'' - m*r*(psi'^2 + phi'^2*cos(psi)^2) = -k^2/r^2*m + m*ur + 2*m*w*r*phi'*cos(psi)^2 + m*w^2*r*cos(psi)^2 + 2*r'*lambda"},
    {"4.3.psi.p",
     "m*D(r^2*psi',1) + m*r^2*phi'^2*sin(psi)*cos(psi) = m'*r*up + 2*r^2*psi'*lambda - 2*m*w*r^2*phi'*sin(psi)*cos(psi) - m*r^2*w^2*sin(psi)*cos(psi)",
     "m*D(r^2*psi',1) + m*r^2*phi'^2*sin(psi)*cos(psi) = m*r*up + 2*r*psi'^2*lambda - 2*m*w*r^2*phi'*sin(psi)*cos(psi) - m*r^2*w^2*sin(psi)*cos(psi)"},
    {"4.3.phi.p",
     "m*D(r^2*phi'*cos(psi)^2,1) = m'*r*uf*cos(psi) + 2*m*w*r^2*psi'*sin(psi)*cos(psi) - 2*m*w*r*r'*cos(psi)^2 + 2*r^2*phi'*cos(psi)^2*lambda",
     "m*D(r^2*phi'*cos(psi)^2,1) = m*r*uf*cos(psi) + 2*m*w*r^2*psi'*sin(psi)*cos(psi) - 2*m*w*r*r'*cos(psi)^2 + 2*r^2*phi'*cos(psi)^2*lambda"},
    {"4.4.r.p",
     "2*r'*lambda = m*r'' - m*r*(psi'^2 + phi'^2*cos(psi)^2) + k^2/r^2*m - m'*ur - 2*m*w*r*phi'*cos(psi)^2 - m*w^2*r*cos(psi)^2",
     "2*r'*lambda = m*r'' - m*r*(psi'^2 + phi'^2*cos(psi)^2) + k^2/r^2*m - m*ur - 2*m*w*r*phi'*cos(psi)^2 - m*w^2*r*cos(psi)^2"},
    {"4.4.psi.p",
     "2*r^2*psi'*lambda = m*D(r^2*psi',1) + m*r^2*phi'^2*sin(psi)*cos(psi) - m'*r*up + 2*m*w*r^2*phi'*sin(psi)*cos(psi) + m*r^2*w^2*sin(psi)*cos(psi)",
     "2*r^2*psi'*lambda = m*D(r^2*psi',1) + m*r^2*phi'^2*sin(psi)*cos(psi) - m*r*up + 2*m*w*r^2*phi'*sin(psi)*cos(psi) + m*r^2*w^2*sin(psi)*cos(psi)"},
    {"4.4.phi.p",
     "2*r^2*phi'*cos(psi)^2*lambda = m*D(r^2*phi'*cos(psi)^2,1) - 2*m*w*r^2*psi'*sin(psi)*cos(psi) - m'*r*uf*cos(psi) + 2*m*w*r*r'*cos(psi)^2",
     "2*r^2*phi'*cos(psi)^2*lambda = m*D(r^2*phi'*cos(psi)^2,1) - 2*m*w*r^2*psi'*sin(psi)*cos(psi) - m*r*uf*cos(psi) + 2*m*w*r*r'*cos(psi)^2"},
};
const Line kOfSleigh[] = {
    {"4.7p",
     "(M + m)*x'' - (a*M + b*m)*(theta''*sin(theta) + theta'^2*cos(theta)) = -m'*u*cos(alpha + theta) + (a*M + b*m)*(omega^2*cos(theta) + 2*omega*theta'*cos(theta) + omega'*sin(theta)) + (M + m)*(omega'*y + 2*omega*y' + omega^2*x - vx'*cos(phi) - vy'*sin(phi)) - lambda*tan(theta)",
     "(M + m)*x - (a*M + b*m)*(theta''*sin(theta) + theta'^2*cos(theta)) = -m'*u*cos(alpha + theta) + (a*M + b*m)*(omega^2*cos(theta) + 2*omega*theta'*cos(theta) + omega'*sin(theta)) + (M + m)*(omega'*y + 2*omega*y' + omega^2*x - vx*cos(phi) - vy*sin(phi)) - lambda*tan(theta)"},
    {"4.8p",
     "(M + m)*y'' + (a*M + b*m)*(theta''*cos(theta) - theta'^2*sin(theta)) = -m'*u*sin(alpha + theta) + (a*M + b*m)*(omega^2*sin(theta) + 2*omega*theta'*sin(theta) - omega'*cos(theta)) + (M + m)*(-omega'*x - 2*omega*x' + omega^2*y + vx'*sin(phi) - vy'*cos(phi)) + lambda",
     "(M + m)*y + (a*M + b*m)*(theta''*cos(theta) - theta'^2*sin(theta)) = -m'*u*sin(alpha + theta) + (a*M + b*m)*(omega^2*sin(theta) + 2*omega*theta'*sin(theta) - omega'*cos(theta)) + (M + m)*(-omega'*x - 2*omega*x' + omega^2*y + vx*sin(phi) - vy*cos(phi)) + lambda"},
    {"4.9p",
     "(J + a^2*M + b^2*m)*theta'' + (a*M + b*m)*(y''*cos(theta) - x''*sin(theta)) = -m'*u*b*sin(alpha) - (a*M + b*m)*(omega'*(x*cos(theta) + y*sin(theta)) + 2*omega*(x'*cos(theta) + y'*sin(theta)) + omega^2*(x*sin(theta) - y*cos(theta)) - vx'*sin(theta + phi) + vy'*cos(theta + phi)) - (J + a^2*M + b^2*m)*omega'",
     "(J + a^2*M + b^2*m)*theta'' + (a*M + b*m)*(y'*cos(theta) - x'*sin(theta)) = -m'*u*b*sin(alpha) - (a*M + b*m)*(omega'*(x*cos(theta) + y*sin(theta)) + 2*omega*(x'*cos(theta) + y'*sin(theta)) + omega^2*(x*sin(theta) - y*cos(theta)) - vx*sin(theta + phi) + vy*cos(theta + phi)) - (J + a^2*M + b^2*m)*omega'"},
    {"4.9left",
     "(J + a^2*M + b^2*m)*theta'' + (a*M + b*m)*(y''*cos(theta) - x''*sin(theta)) = -m'*u*b*sin(alpha) - (a*M + b*m)*(omega'*(x*cos(theta) + y*sin(theta)) + 2*omega*(x'*cos(theta) + y'*sin(theta)) + omega^2*(x*sin(theta) - y*cos(theta)) - vx'*sin(theta + phi) + vy'*cos(theta + phi)) - (J + a^2*M + b^2*m)*omega'",
     "(J + a^2*M + b^2*m)*theta'' + (a*M + b*m)*(y''*cos(theta) - x''*sin(theta)) = -m'*u*b*sin(alpha) - (a*M + b*m)*(omega'*(x*cos(theta) + y*sin(theta)) + 2*omega*(x'*cos(theta) + y'*sin(theta)) + omega^2*(x*sin(theta) - y*cos(theta)) - vx*sin(theta + phi) + vy*cos(theta + phi)) - (J + a^2*M + b^2*m)*omega'"},
    {"4.10p",
     "(M + m)*(x''*cos(theta) + y''*sin(theta)) - (a*M + b*m)*(theta' + omega)^2 = -m'*u*cos(alpha) + (M + m)*(omega'*(y*cos(theta) - x*sin(theta)) - 2*omega*(x'*sin(theta) - y'*cos(theta)) + omega^2*(x*cos(theta) + y*sin(theta)) - vx'*cos(phi + theta) - vy'*sin(phi + theta))",
     "(M + m)*(x*cos(theta) + y*sin(theta)) - (a*M + b*m)*(theta' + omega)^2 = -m'*u*cos(alpha) + (M + m)*(omega'*(y*cos(theta) - x*sin(theta)) - 2*omega*(x'*sin(theta) - y'*cos(theta)) + omega^2*(x*cos(theta) + y*sin(theta)) - vx*cos(phi + theta) - vy*sin(phi + theta))"},
    {"4.11p",
     "-lambda*tan(theta) = (M + m)*(x'' + vx'*cos(phi) + vy'*sin(phi) - omega'*y - 2*omega*y' - omega^2*x) - (a*M + b*m)*(theta''*sin(theta) + theta'^2*cos(theta) + omega'*sin(theta) + omega^2*cos(theta) + 2*omega*theta'*cos(theta)) + m'*u*cos(alpha + theta)",
     "-lambda*tan(theta) = (M + m)*(x + vx*cos(phi) + vy*sin(phi) - omega'*y - 2*omega*y' - omega^2*x) - (a*M + b*m)*(theta''*sin(theta) + theta'^2*cos(theta) + omega'*sin(theta) + omega^2*cos(theta) + 2*omega*theta'*cos(theta)) + m'*u*cos(alpha + theta)"},
    {"4.12p",
     "lambda = (M + m)*(y'' - vx'*sin(phi) + vy'*cos(phi) + omega'*x + 2*omega*x' - omega^2*y) + (a*M + b*m)*(theta''*cos(theta) - theta'^2*sin(theta) + omega'*cos(theta) - omega^2*sin(theta) - 2*omega*theta'*sin(theta)) + m'*u*sin(alpha + theta)",
     "lambda = (M + m)*(y - vx*sin(phi) + vy*cos(phi) + omega'*x + 2*omega*x' - omega^2*y) + (a*M + b*m)*(theta''*cos(theta) - theta'^2*sin(theta) + omega'*cos(theta) - omega^2*sin(theta) - 2*omega*theta'*sin(theta)) + m'*u*sin(alpha + theta)"},
};

void expect_each_named(const char* model, std::span<const Line> lines) {
  Diagnostics diagnostics;
  std::optional<OpenModel> open = open_model(SourceText{"model.toml", model}, diagnostics);
  ASSERT_TRUE(open) << diagnostics.print(SourceText{"model.toml", model});
  Subject subject(std::move(open).value());
  std::string text;
  for (const Line& l : lines) text += std::string(l.label) + ".meant: " + l.meant + "\n" + l.label + ".read: " + l.read + "\n";
  const SourceText source{"paper.eq", text};
  const std::vector<PublishedEquation> list = subject.read(source, diagnostics);
  ASSERT_EQ(list.size(), 2 * lines.size()) << diagnostics.print(source);
  for (std::size_t k = 0; k < lines.size(); ++k) {
    const PublishedEquation &meant = list[2 * k], &read = list[2 * k + 1];
    EXPECT_EQ(subject.compare(meant).verdict, Verdict::proved) << meant.label;
    const Comparison c = subject.compare(read);
    EXPECT_EQ(c.verdict, Verdict::refuted) << read.label;
    ASSERT_EQ(c.changes.size(), 1U) << read.label;
    EXPECT_EQ(c.changes[0].equation, meant.text()) << read.label;
    EXPECT_TRUE(c.changes[0].proved) << read.label;
  }
}

TEST(AsRead, EquationsOfTheParticle) { expect_each_named(kParticle, kOfParticle); }
TEST(AsRead, EquationsOfTheSleighWithARocket) { expect_each_named(kSleigh, kOfSleigh); }

}  // namespace
}  // namespace anholon
