// The text of a chain of n links in the plane: absolute angles, explicit joints P1 … Pn, a mass at each, gravity.
#pragma once
#include <string>

namespace anholon::test {

inline std::string chain_text(int n) {
  std::string coordinates, points, masses, initial;
  for (int i = 1; i <= n; ++i) {
    const std::string k = std::to_string(i);
    coordinates += (i > 1 ? ", " : "") + ("\"a" + k + "\"");
    points += "P" + k + " = \"" + (i > 1 ? "P" + std::to_string(i - 1) + " + " : "") + "l*sin(a" + k +
              ")*ex - l*cos(a" + k + ")*ey\"\n";
    masses += "[[particle]]\nname = \"bob" + k + "\"\nmass = \"m\"\nposition = \"P" + k + "\"\n";
    initial += "a" + k + " = " + std::to_string(0.3 + 0.02 * i) + "\n\"a" + k + "'\" = 0\n";
  }
  return "coordinates = [" + coordinates + "]\n[parameters]\nm = 0.1\nl = 0.2\ng = 9.81\n[point]\n" + points + masses +
         "[gravity]\nfield = \"-g*ey\"\n[initial]\n" + initial;
}

}  // namespace anholon::test
