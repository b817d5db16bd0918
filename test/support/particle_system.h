// Random systems of particles: positions are functions of as many coordinates (g = 0), or of fewer coordinates, with g
// = 3N - n > 0 holonomic constraints in them. They have varying masses, an observer that rotates and accelerates,
// moving guides, and constraints of one order. Every force has a point of application, so Newton's law gives the
// reaction on each particle.
//
// The same seed gives the same text everywhere: only the raw numbers of the generator are used.
#pragma once
#include <random>
#include <string>

namespace anholon::test {

struct ParticleChoice {
  std::size_t coordinates = 4, particles = 2;
  unsigned order = 1;  // of the constraints
  std::size_t constraints = 1;
  bool linear = false;  // in the highest derivatives
};

class ParticleSystem {
 public:
  ParticleSystem(const ParticleChoice& choice, std::uint64_t seed) : choice_(choice), random_(seed) {
    text_ = "coordinates = [";
    for (std::size_t a = 0; a < choice.coordinates; ++a) text_ += (a ? ", \"" : "\"") + q(a) + "\"";
    text_ += "]\n[observer]\nspin = [\"" + number() +
             "\", \"t/3\", \"cos(t)/2\"]\norigin_acceleration = [\"sin(2*t)\", \"" + number() + "\", \"t\"]\n";
    for (std::size_t p = 0; p < choice.particles; ++p) particle(p);
    for (std::size_t k = 0; k < choice.constraints; ++k) constraint(k);
  }

  const std::string& text() const { return text_; }

 private:
  std::string number() { return std::to_string(20 + random_() % 80) + "/100"; }
  std::string signed_number() { return (random_() % 2 ? "(-" : "(") + number() + ")"; }
  static std::string q(std::size_t a, unsigned order = 0) {
    const std::string name = "q" + std::to_string(a + 1);
    return order > 3 ? "D(" + name + "," + std::to_string(order) + ")" : name + std::string(order, '\'');
  }
  std::string any(unsigned order = 0) { return q(random_() % choice_.coordinates, order); }
  std::string function() {
    switch (random_() % 4) {
    case 0:
      return "sin(" + any() + ")";
    case 1:
      return "cos(" + any() + " - " + any() + ")";
    case 2:
      return any() + "*" + any();
    default:
      return "sin(t + " + any() + ")";
    }
  }

  void particle(std::size_t p) {
    const std::string name = "p" + std::to_string(p);
    text_ += "[[particle]]\nname = \"" + name + "\"\nmass = \"1 + " + number() +
             (p == 0 ? "*exp(-t/4) + " + q(0) + "^2/8" : "") + "\"\nposition = [";
    for (std::size_t i = 0; i < 3; ++i) {
      const std::string own = q((3 * p + i) % choice_.coordinates);
      text_ += (i ? ", \"" : "\"") + own + "*(1 + " + number() + "*t) + " + signed_number() + "*" + function() + "\"";
    }
    text_ += "]\n";
    if (p == 0) text_ += "expelled_velocity = [\"" + signed_number() + "\", \"" + any(1) + "/5\", \"t/3\"]\n";
    text_ += "[[force]]\nname = \"f" + std::to_string(p) + "\"\non = \"" + name + "\"\nvector = [\"" + signed_number() +
             "*" + any(1) + "\", \"cos(t)\", \"" + any() + "*" + any() + "\"]\n";
  }

  void constraint(std::size_t k) {
    const unsigned m = choice_.order;
    const std::size_t other = (k + 1) % choice_.coordinates, third = (k + 2) % choice_.coordinates;
    std::string e = "(1 + " + number() + "*t^2)*" + q(k, m) + " + " + signed_number() + "*" + q(other, m);
    e += choice_.linear && m > 0 ? " + " + function() + "*" + q(third, m)
                                 : " + " + number() + "*" + q(third, m) + "^2/4";
    e += " = " + signed_number() + "*" + function();
    if (m > 0) e += " + " + any(m - 1) + "/3";
    text_ += "[[constraint]]\nname = \"c" + std::to_string(k) + "\"\nequation = \"" + e + "\"\n";
  }

  ParticleChoice choice_;
  std::mt19937_64 random_;
  std::string text_;
};

}  // namespace anholon::test
