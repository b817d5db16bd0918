// The nodes that claims need, compiled for evaluation in finite fields (verify_modular.h): angles as combinations of
// atoms and bounds on degrees (verify_modular_program.cpp), values at random points (verify_modular_points.cpp), the
// conclusions (verify_modular.cpp).
#pragma once
#include <cstdint>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "proof/verify_modular.h"

namespace anholon::verification {

using Word = Field::Word;
using Index = Certificate::Index;
using Operation = Certificate::Operation;

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

enum class Family : std::uint8_t { none, circle, exponential };

struct Step {
  const Certificate::Node* node = nullptr;
  std::vector<std::uint32_t> operands;  // local indices
  Angle angle;
  Family family = Family::none;
  std::uint64_t name = 0;  // of the function, for its key
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

  // The choices of signs: nodes of the certificate, and whether a root is taken of them.
  std::vector<std::pair<Index, bool>> sites() const {
    std::vector<std::pair<Index, bool>> list;
    for (const Site& s : sites_) list.emplace_back(nodes_[s.local], s.root);
    std::sort(list.begin(), list.end());
    return list;
  }
  std::vector<ModularFinding> run(const HashKey& key, int points);

 private:
  static constexpr std::uint32_t kNone = ~std::uint32_t{0};
  struct Factor {
    Word exponent = 0;  // modulo the order of the group
    std::uint32_t site = kNone;
    bool zero_allowed = true;
  };
  struct Turn {
    Word scale = 0;     // 1 / content
    Word exponent = 0;  // coefficient · q, modulo the order of the group
  };
  // A program over one field.
  struct Reduced {
    std::vector<std::vector<Word>> weights;  // number: its value; sum: coefficients
    std::vector<std::vector<Factor>> factors;
    std::vector<std::vector<Turn>> turns;
  };
  enum class Drawn : std::uint8_t { good, undefined, not_square, bad_prime };
  struct Point {
    Word c, s;
  };

  void collect();
  void add(Index node);
  Angle flatten(Index argument, bool circle);
  std::size_t site(std::uint32_t local, bool root);
  void degrees();
  double total(const Degree& d) const;
  Degree sum_degree(const std::vector<const Degree*>& terms);
  void multiply_degree(Degree& d, const Degree& by, double exponent, std::uint64_t base);
  double difference_degree(const Certificate::Claim& claim);

  bool reduce(const Field& f, Reduced& r) const;
  Drawn draw(const Field& f, const Reduced& r, const HashKey& key, std::vector<Word>& v);
  Word random(const Field& f, const HashKey& key, std::uint64_t tag, Word a, Word b = 0) const;
  Point turn(const Field& f, const Step& step, const std::vector<Turn>& turns, const HashKey& key,
             const std::vector<Word>& v, const Point& twelfth) const;
  Word grow(const Field& f, const Step& step, const std::vector<Turn>& turns, const HashKey& key,
            const std::vector<Word>& v) const;
  Word atom(const Field& f, const Part& part, const Turn& t, const HashKey& key, const std::vector<Word>& v) const;
  Word pi_value(const Field& f, const HashKey& key) const { return random(f, key, 2, 0); }

  const Certificate& c_;
  std::vector<std::size_t> claims_;
  std::vector<std::uint32_t>& local_;  // node -> step, kNone outside of the program
  Work& work_;
  std::vector<Index> nodes_;  // ascending
  std::vector<Step> steps_;
  std::vector<Site> sites_;
  std::map<std::pair<std::uint32_t, bool>, std::uint32_t> site_of_;
  mpz_class circle_q_ = 1, growth_q_ = 1;
  std::size_t failed_site_ = 0;
  std::uint64_t cost_ = 100;  // of one point

  std::vector<Degree> degree_;
  std::map<std::uint64_t, double> base_degree_;
  double keyed_ = 0, largest_key_ = 0;  // number of arguments distinguished by their values, and their degree
  double log2_conjugates_ = 0;
};

}  // namespace anholon::verification
