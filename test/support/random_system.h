// Random mechanical systems as model files: moving guides, varying masses, an observer that rotates and accelerates,
// rigid bodies, springs, and constraints of orders 0 to 4, linear and nonlinear in their highest derivatives, alone,
// mixed and redundant.
//
// The same seed gives the same text everywhere: only the raw numbers of the generator are used.
#pragma once
#include <random>
#include <string>
#include <vector>

namespace anholon::test {

class RandomSystem {
 public:
  explicit RandomSystem(std::uint64_t seed) : random_(seed) {
    n_ = 2 + below(5);
    const std::size_t most = std::min<std::size_t>(n_ - 1, 3);
    write_head();
    const std::size_t s = 1 + below(most);
    // Each constraint has a coordinate of its own, so that most sets are independent.
    for (std::size_t k = 0; k < s; ++k) constraint(k);
    if (one_in(6)) redundant();
    write_initial();
  }

  const std::string& text() const { return text_; }
  // A description of the system in one line.
  const std::string& what() const { return what_; }

 private:
  std::size_t below(std::size_t k) { return static_cast<std::size_t>(random_() % k); }
  bool one_in(std::size_t k) { return below(k) == 0; }
  // v/100 for a random whole number v from lo to hi.
  std::string number(int lo, int hi) {
    const int v = lo + static_cast<int>(below(static_cast<std::size_t>(hi - lo + 1)));
    return std::to_string(v) + "/100";
  }
  std::string signed_number(int lo, int hi) { return (one_in(2) ? "(-" : "(") + number(lo, hi) + ")"; }
  static std::string q(std::size_t a, int order = 0) {
    return "q" + std::to_string(a + 1) + std::string(static_cast<std::size_t>(order), '\'');
  }
  std::string any(int order = 0) { return q(below(n_), order); }

  // A bounded function of the coordinates and, if `time`, of time.
  std::string function(bool time) {
    switch (below(time ? 5 : 4)) {
    case 0:
      return "sin(" + any() + ")";
    case 1:
      return "cos(" + any() + " - " + any() + ")";
    case 2:
      return any() + "*" + any();
    case 3:
      return "exp(-" + any() + "^2)";
    default:
      return "sin(t + " + any() + ")";
    }
  }

  void write_head() {
    text_ = "coordinates = [";
    for (std::size_t a = 0; a < n_; ++a) text_ += (a ? ", \"" : "\"") + q(a) + "\"";
    text_ += "]\n";
    const bool moving = one_in(3), turning = one_in(3), losing = one_in(3);
    what_ = "n = " + std::to_string(n_) + (moving ? ", moving guides" : "") + (turning ? ", turning observer" : "") +
            (losing ? ", losing mass" : "");
    if (turning)
      text_ += "[observer]\nspin = [\"" + number(10, 60) +
               "\", \"t/3\", \"cos(t)/2\"]\norigin_acceleration = [\"sin(2*t)\", \"" + number(10, 90) + "\", \"t\"]\n";
    const std::size_t particles = (n_ + 2) / 3;
    for (std::size_t p = 0; p < particles; ++p) {
      text_ += "[[particle]]\nname = \"p" + std::to_string(p) + "\"\nmass = \"" + number(80, 300);
      const bool loses = losing && p == 0;
      if (loses) text_ += one_in(2) ? " - t/5" : "*exp(-t/4)*(1 + " + q(0) + "^2/8)";
      text_ += "\"\nposition = [";
      for (std::size_t i = 0; i < 3; ++i) {
        const std::size_t a = 3 * p + i;
        std::string x = a < n_ ? q(a) : function(false);
        if (one_in(2)) x += " + " + signed_number(5, 20) + "*" + function(moving);
        text_ += (i ? ", \"" : "\"") + x + "\"";
      }
      text_ += "]\n";
      if (loses) text_ += "expelled_velocity = [\"" + signed_number(20, 90) + "\", \"" + any(1) + "/5\", \"t/3\"]\n";
    }
    if (one_in(3)) {
      const std::size_t a = below(n_), b = below(n_);
      text_ += "[[body]]\nname = \"b\"\nmass = \"" + number(50, 150) +
               "\"\ninertia = [\"3/10\", \"2/5\", \"1/2\"]\ncenter = [\"" + q(a) + "\", \"" + function(false) +
               "\", \"0\"]\norientation = \"rotz(" + q(b) + ")*rotx(" + any() + "/2)\"\n";
      what_ += ", body";
    }
    text_ += "[gravity]\nfield = \"-" + number(100, 981) + "*ez\"\n[potential]\nspring = \"" + number(50, 400) + "*" +
             any() + "^2 + " + function(false) + "\"\n";
    if (one_in(2))
      text_ += "[[force]]\nname = \"drag\"\non = \"p0\"\nvector = [\"-" + number(10, 50) + "*" + any(1) +
               "\", \"cos(t)\", \"" + any(1) + "*" + any() + "/4\"]\n";
  }

  // A sum of terms with derivatives of at most order - 1, bounded in the coordinates.
  std::string lower(int order) {
    std::string s = signed_number(10, 60) + "*" + function(one_in(2));
    if (order > 0) s += " + " + signed_number(10, 40) + "*" + any(order - 1);
    if (order > 1 && one_in(2)) s += " + " + signed_number(10, 30) + "*" + any(order - 1) + "*" + any(1);
    return s;
  }

  void constraint(std::size_t k) {
    static const int orders[] = {0, 1, 1, 1, 1, 2, 2, 2, 3, 3, 4};
    const int m = orders[below(std::size(orders))];
    const std::size_t own = k, other = k + 1 + below(n_ - k - 1), third = below(n_);
    std::string e, kind;
    if (m == 0) {
      switch (below(3)) {
      case 0:
        e = q(own) + " + " + signed_number(10, 50) + "*sin(" + q(other) + ") = " + signed_number(10, 40) + "*" +
            q(third) + "^2 + t/7";
        break;
      case 1:
        e = "(" + q(own) + " + 1)^2 + " + q(other) + "^2 = 2 + " + signed_number(10, 30) + "*sin(t)";
        break;
      default:
        e = q(own) + "*cos(" + q(other) + ") + " + signed_number(20, 60) + "*" + q(other) + " = 1/4";
        break;
      }
      kind = "holonomic";
    } else if (!one_in(3)) {
      e = "(1 + " + number(10, 40) + "*" + function(false) + ")*" + q(own, m) + " + " + signed_number(20, 90) + "*" +
          q(other, m);
      if (third != own && third != other)
        e += " + " + signed_number(5, 30) + "*" + function(one_in(3)) + "*" + q(third, m);
      e += " = " + (one_in(4) ? "0" : lower(m));
      kind = "linear";
    } else {
      switch (below(4)) {
      case 0:
        e = q(own, m) + "^2 + " + q(other, m) + "^2 = " + number(100, 400);
        break;
      case 1:
        e = q(own, m) + " + " + signed_number(10, 30) + "*" + q(other, m) + "^2 = " + lower(m);
        break;
      case 2:
        e = q(own, m) + " = " + signed_number(20, 60) + "*" + q(own, m) + "*" + q(other, m) + " + " + lower(m);
        break;
      default:
        e = q(own, m) + "*" + q(other, m) + " = " + number(30, 120) + " + " + function(true) + "/5";
        break;
      }
      kind = "nonlinear";
    }
    what_ += ", order " + std::to_string(m) + " " + kind;
    equations_.push_back(e);
    text_ += "[[constraint]]\nname = \"c" + std::to_string(k) + "\"\nequation = \"" + e + "\"\n";
  }

  // Adds a constraint that follows from the others.
  void redundant() {
    const auto sides = [](const std::string& e) {
      const std::size_t at = e.find(" = ");
      return std::pair{"(" + e.substr(0, at) + ")", "(" + e.substr(at + 3) + ")"};
    };
    const auto [l, r] = sides(equations_[0]);
    std::string e;
    if (equations_.size() > 1 && one_in(2)) {
      const auto [l2, r2] = sides(equations_[1]);
      const std::string factor = "(2 + sin(" + any() + ")/2)";
      e = factor + "*" + l + " + " + l2 + "/2 = " + factor + "*" + r + " + " + r2 + "/2";
    } else {
      e = "3*" + l + " = 3*" + r;
    }
    what_ += ", redundant";
    text_ += "[[constraint]]\nname = \"again\"\nequation = \"" + e + "\"\n";
  }

  void write_initial() {
    text_ += "[initial]\nguess = {";
    for (int k = 0; k < 4; ++k)
      for (std::size_t a = 0; a < n_; ++a) {
        if (k + a > 0) text_ += ", ";
        text_ += "\"" + q(a, k) + "\" = \"" + signed_number(10, 90) + "\"";
      }
    text_ += "}\n";
  }

  std::mt19937_64 random_;
  std::size_t n_ = 0;
  std::string text_, what_;
  std::vector<std::string> equations_;
};

}  // namespace anholon::test
