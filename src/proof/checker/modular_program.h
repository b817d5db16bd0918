// The nodes that claims need, compiled for evaluation in finite fields by the rules of modular.h: angles as
// combinations of atoms and bounds on degrees (modular_program.cpp), values at random points
// (modular_points.cpp).
#pragma once
#include <algorithm>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "base/hash.h"
#include "numeric/prime_field.h"
#include "proof/checker/certificate.h"
#include "proof/checker/functions.h"
#include "proof/checker/work.h"

namespace anholon::verification {

using Field = PrimeField;
using Word = Field::Word;
using Index = Certificate::Index;
using Operation = Certificate::Operation;

inline constexpr std::uint32_t kNone = ~std::uint32_t{0};  // no step, no site

// Thrown for a construct that cannot be checked, with the reason.
struct Unable {
  std::string reason;
};

// A linear combination of atoms: the argument of sin, cos, tan, exp, sinh, cosh, tanh.
struct Part {
  enum class Of : std::uint8_t { node, one, pi } of = Of::node;
  std::uint32_t local = 0;  // the atom is node / content
  Rational content = 1, coefficient;
};
struct Angle {
  std::vector<Part> parts;
  unsigned twelfths = 0;  // multiple of π/12, exactly; circle functions only
};

// Functions of sums of angles: their arguments are flattened.
inline bool is_of_angle(Family f) { return f == Family::circle || f == Family::exponential; }

struct Step {
  const Certificate::Node* node = nullptr;
  std::vector<std::uint32_t> operands;  // local indices
  Angle angle;
  Family family = Family::keyed;
  std::uint64_t name = 0;  // the number of the function by which the values are keyed
  bool constant = false;   // the same number at all points
};

// A place at which the sign of a root, or of a number, has to be chosen.
struct Site {
  std::uint32_t local = 0;
  bool root = false;  // the argument must be a square
  bool constant = false;
  bool failed = false;  // the argument was not a square at some point: its root is in no smaller field
};

// Degrees as rational functions of all random numbers. Denominators are stored separately by their origin, so that sums
// over a common denominator do not count it twice.
struct Degree {
  double numerator = 0;
  std::vector<std::pair<std::uint64_t, double>> denominators;  // base, exponent; ascending
};

// A program over one field.
struct ReducedProgram {
  struct Factor {
    Word exponent = 0;  // modulo the order of the group
    std::uint32_t site = kNone;
    bool zero_allowed = true;
  };
  struct Turn {
    Word scale = 0;     // 1 / content
    Word exponent = 0;  // coefficient · q, modulo the order of the group
  };
  // A point of the circle group.
  struct Point {
    Word cos, sin;
  };
  ReducedProgram(const Field& f, std::size_t steps);
  Field field;
  Word half;
  Point twelfth;                           // the point of the angle pi/12
  std::vector<std::vector<Word>> weights;  // number: its value; sum: coefficients
  std::vector<std::vector<Factor>> factors;
  std::vector<std::vector<Turn>> turns;
};

// The nodes that some claims need, evaluated together.
class ModularProgram {
 public:
  ModularProgram(const Certificate& c, std::vector<std::size_t> claims, std::vector<std::uint32_t>& scratch, Work& work)
      : c_(c), claims_(std::move(claims)), local_(scratch), work_(work) {
    collect();
  }
  ~ModularProgram() {
    for (const Index node : nodes_) local_[node] = kNone;
  }
  ModularProgram(const ModularProgram&) = delete;
  ModularProgram& operator=(const ModularProgram&) = delete;

  const std::vector<std::size_t>& claims() const { return claims_; }
  // Returns the choices of signs: nodes of the certificate, and whether a root is taken of them.
  std::vector<std::pair<Index, bool>> sites() const {
    std::vector<std::pair<Index, bool>> list;
    for (const Site& s : sites_) list.emplace_back(nodes_[s.local], s.root);
    std::sort(list.begin(), list.end());
    return list;
  }

  // Flattens the angles and bounds the degrees. REQUIRED before the functions below. Throws Unable.
  void prepare();
  // Return the degree of the difference that a claim states, and the number of pairs of arguments that have to differ
  // times their degree; both bound the number of zeros.
  double difference_degree(const Certificate::Claim& claim);
  double key_collisions() const { return keyed_ * keyed_ * largest_key_; }
  double log2_conjugates() const { return log2_conjugates_; }
  // Returns the number of roots whose arguments vary: each has a value at half of the points.
  double varying_roots() const;
  // Returns the number of choices of signs that the points so far have left open.
  int open_branches() const;

  // Returns the program over a field; nullopt if a number of the program has no value in it.
  std::optional<ReducedProgram> over(const Field& field) const;

  enum class Drawn : std::uint8_t { good, undefined, not_square, bad_prime };
  // Computes the values of all nodes at the random point that `key` determines. Throws Unable at the limit of work.
  Drawn draw(const ReducedProgram& r, const HashKey& key, std::vector<Word>& values);
  // Returns left - sum coefficient * term of a claim, from the values of the nodes.
  Word difference(const ReducedProgram& r, const Certificate::Claim& claim, const std::vector<Word>& values) const;

 private:
  class PointDraw;

  void collect();
  void add(Index node);
  void compile(Step& s);
  Angle flatten(Index argument, bool circle);
  std::size_t site(std::uint32_t local, bool root);
  void degrees();
  void function_degree(std::size_t i, Degree& d);
  void angle_degree(std::size_t i, Degree& d);
  double total(const Degree& d) const;
  Degree sum_degree(const std::vector<const Degree*>& terms);
  void multiply_degree(Degree& d, const Degree& by, double exponent, std::uint64_t base);
  void key_degree(double degree) { ++keyed_, largest_key_ = std::max(largest_key_, degree); }

  const Certificate& c_;
  std::vector<std::size_t> claims_;
  std::vector<std::uint32_t>& local_;  // node -> step, kNone outside of the program
  Work& work_;
  std::vector<Index> nodes_;  // ascending
  std::vector<Step> steps_;
  std::vector<Site> sites_;
  std::map<std::pair<std::uint32_t, bool>, std::uint32_t> site_of_;
  mpz_class circle_q_ = 1, growth_q_ = 1;
  std::uint64_t cost_ = 100;  // cost of one point

  std::vector<Degree> degree_;
  std::map<std::uint64_t, double> base_degree_;
  double keyed_ = 0, largest_key_ = 0;  // number of arguments distinguished by their values, and their degree
  double log2_conjugates_ = 0;
};

}  // namespace anholon::verification
