// A small system in which everything occurs that equations of order m can contain: moving guides, a varying mass, two
// constraints whose right sides contain time, lower derivatives of dependent coordinates, and powers of the independent
// highest derivatives. It has polynomials only, so identities can be proved by exact algebra.
#pragma once
#include <string>

namespace anholon::test {

inline std::string primes(const std::string& name, int order) {
  return name + std::string(static_cast<std::size_t>(order), '\'');
}

enum class Shape {
  affine,     // in all highest derivatives: quasi-velocities can be solved too
  linear,     // in the dependent highest derivatives: the constraints can be solved
  nonlinear,  // in the dependent highest derivatives as well: the constraints cannot be solved
};

// The quasi-velocities beside the two constraints.
enum class Speeds { none, linear, nonlinear };

inline std::string generic_system(int m, Shape shape, Speeds speeds = Speeds::none) {
  const auto top = [m](const char* q) { return primes(q, m); };
  const auto below = [m](const char* q) { return primes(q, m - 1); };
  const bool affine = shape == Shape::affine;
  const std::string cubic = shape == Shape::nonlinear ? " + " + top("z") + "^3/5" : "";
  std::string text = "coordinates = [\"x\", \"y\", \"z\", \"w\"]\ndependent = [\"z\", \"w\"]\n"
                     "[functions]\nmu = \"2 + t/5\"\n"
                     "[[particle]]\nname = \"first\"\nmass = \"mu\"\nposition = [\"x + y*z/3\", \"y + t*x/2\", \"w\"]\n"
                     "expelled_velocity = [\"x'\", \"1/2\", \"t\"]\n"
                     "[[particle]]\nname = \"second\"\nmass = \"3/2\"\nposition = [\"z + t*w\", \"w*x/2\", \"t*y\"]\n"
                     "[[force]]\nname = \"pull\"\non = \"second\"\nvector = [\"-x\", \"2 - y*w'\", \"z\"]\n"
                     "[[constraint]]\nname = \"one\"\nequation = \"" +
                     top("z") + cubic + " = " + below("w") + "*" + top("x") + " + t*" + below("z") + "*" + top("y") +
                     (affine ? "" : "^2") + "/2 + x*" + below("y") +
                     "\"\n"
                     "[[constraint]]\nname = \"two\"\nequation = \"" +
                     top("w") + " + " + top("z") + "*y/4 = " + below("z") + "*" + top("x") + "*" +
                     (affine ? "x" : top("y")) + "/3 + " + below("w") + "*" + below("x") + "^2 - t\"\n";
  const std::string product = speeds == Speeds::nonlinear ? " + " + top("x") + "*" + top("z") + "/3" : "";
  if (speeds != Speeds::none)
    text += "[quasi]\nu = \"" + top("x") + "*(2 + " + below("z") + ") - " + below("y") + "*" + top("w") + "/3 + t" +
            product +
            "\"\n"
            "v = \"" +
            top("y") + " + " + below("x") + "*" + top("x") + "/4\"\n";
  return text;
}

}  // namespace anholon::test
