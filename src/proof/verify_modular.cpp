#include "proof/verify_modular.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <map>
#include <utility>

namespace anholon::verification {

using Word = Field::Word;
using Index = Certificate::Index;
using Operation = Certificate::Operation;

Word Field::power(Word a, Word exponent) const {
  Word r = 1;
  for (; exponent > 0; exponent >>= 1, a = multiply(a, a))
    if (exponent & 1) r = multiply(r, a);
  return r;
}

std::optional<Word> Field::from(const Rational& r) const {
  const Word n = mpz_fdiv_ui(r.get_num_mpz_t(), p_), d = mpz_fdiv_ui(r.get_den_mpz_t(), p_);
  if (d == 0) return std::nullopt;
  return d == 1 ? n : multiply(n, inverse(d));
}

namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kLargestChance = -40;  // log2; a weaker bound confirms nothing
constexpr int kMostBranches = 8;
constexpr std::size_t kMostBits = 4096;  // of a coefficient inside an angle

// What cannot be treated, with its reason.
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
  unsigned twelfths = 0;  // of π, exactly; circle functions only
};

enum class Family : std::uint8_t { none, circle, exponential };
Family family(const std::string& f) {
  if (f == "sin" || f == "cos" || f == "tan") return Family::circle;
  if (f == "exp" || f == "sinh" || f == "cosh" || f == "tanh") return Family::exponential;
  return Family::none;
}
bool is_odd(const std::string& f) { return f == "asin" || f == "atan" || f == "asinh" || f == "atanh"; }

struct Step {
  const Certificate::Node* node = nullptr;
  std::vector<std::uint32_t> operands;  // local
  Angle angle;
  Family family = Family::none;
  std::uint64_t name = 0;  // of the function, for its key
  bool constant = false;   // the same number at all points
};

// A place where the sign of a root, or of a number, has to be chosen.
struct Site {
  std::uint32_t local = 0;
  bool root = false;      // the argument must be a square
  bool constant = false;
  bool failed = false;    // it was seen not to be a square: its root is in no smaller field
};

// Degrees as rational functions of everything that is drawn at random. The denominators are kept
// apart by what they come from, so that sums over a common denominator do not count it twice.
struct Degree {
  double numerator = 0;
  std::vector<std::pair<std::uint64_t, double>> denominators;  // base, exponent; ascending
};

// The nodes that some claims need, to be evaluated together.
class Program {
 public:
  Program(const Certificate& c, std::vector<std::size_t> claims, std::vector<std::uint32_t>& scratch, Work& work)
      : c_(c), claims_(std::move(claims)), local_(scratch), work_(work) {
    collect();
  }
  ~Program() {
    for (const Index node : nodes_) local_[node] = kNone;
  }
  Program(const Program&) = delete;
  Program& operator=(const Program&) = delete;

  // Where signs are chosen: nodes of the certificate, and whether a root is taken of them.
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
    Word exponent = 0;      // modulo the order of the group
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
  Point turn(const Field& f, const Step& step, const std::vector<Turn>& turns, const HashKey& key, const std::vector<Word>& v, const Point& twelfth) const;
  Word grow(const Field& f, const Step& step, const std::vector<Turn>& turns, const HashKey& key, const std::vector<Word>& v) const;
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
  double keyed_ = 0, largest_key_ = 0;  // arguments told apart by their values, and their degree
  double log2_conjugates_ = 0;
};

// Compiling

void Program::add(Index node) {
  if (local_[node] != kNone) return;
  local_[node] = 0;
  nodes_.push_back(node);
}

void Program::collect() {
  for (const std::size_t k : claims_) {
    const Certificate::Claim& claim = c_.claims[k];
    add(claim.left);
    for (const Certificate::Pair& p : claim.right) add(p.coefficient), add(p.node);
  }
  for (std::size_t i = 0; i < nodes_.size(); ++i) {
    const Certificate::Node& n = c_.nodes[nodes_[i]];
    work_.spend(1 + n.terms.size());
    for (const Certificate::Term& t : n.terms)
      if (n.operation != Operation::product || t.weight != 0) add(t.node);
  }
  std::sort(nodes_.begin(), nodes_.end());
  for (std::size_t i = 0; i < nodes_.size(); ++i) local_[nodes_[i]] = static_cast<std::uint32_t>(i);
  steps_.resize(nodes_.size());
  for (std::size_t i = 0; i < nodes_.size(); ++i) {
    Step& s = steps_[i];
    s.node = &c_.nodes[nodes_[i]];
    const bool algebraic = s.node->operation == Operation::sum || s.node->operation == Operation::product;
    s.constant = algebraic || s.node->operation == Operation::number || (s.node->operation == Operation::function && (s.node->function == "abs" || s.node->function == "sign"));
    cost_ += 30 + (s.node->operation == Operation::sum ? 5 : 400) * s.node->terms.size();
    for (const Certificate::Term& t : s.node->terms) {
      const bool used = s.node->operation != Operation::product || t.weight != 0;
      s.operands.push_back(used ? local_[t.node] : kNone);
      if (used && !steps_[local_[t.node]].constant) s.constant = false;
    }
    if (s.node->operation == Operation::product) {
      for (std::size_t k = 0; k < s.operands.size(); ++k)
        if (s.operands[k] != kNone && mpz_even_p(s.node->terms[k].weight.get_den_mpz_t())) site(s.operands[k], true);
    } else if (s.node->operation == Operation::function) {
      const std::string& name = s.node->function;
      s.family = family(name);
      const auto& all = Certificate::functions();
      s.name = static_cast<std::uint64_t>(std::find(all.begin(), all.end(), name) - all.begin());
      if (name == "abs" || name == "sign") site(s.operands[0], false);
    }
  }
}

std::size_t Program::site(std::uint32_t local, bool root) {
  const auto [it, is_new] = site_of_.emplace(std::pair{local, root}, static_cast<std::uint32_t>(sites_.size()));
  if (is_new) sites_.push_back({local, root, steps_[local].constant, false});
  return it->second;
}

// From the largest node down: all ways into a node are added up before it is opened.
Angle Program::flatten(Index argument, bool circle) {
  Angle angle;
  Rational ones = 0, pis = 0;
  std::map<Index, Rational, std::greater<>> open{{argument, 1}};
  const auto check = [](const Rational& r) {
    if (mpz_sizeinbase(r.get_num_mpz_t(), 2) + mpz_sizeinbase(r.get_den_mpz_t(), 2) > kMostBits) throw Unable{"an angle has a coefficient of too many digits"};
  };
  while (!open.empty()) {
    const Index at = open.begin()->first;
    const Rational coefficient = open.begin()->second;
    open.erase(open.begin());
    if (coefficient == 0) continue;
    check(coefficient);
    const Certificate::Node& n = c_.nodes[at];
    if (!work_.spend(4 + 4 * n.terms.size())) throw Unable{"the limit of work is reached"};
    switch (n.operation) {
      case Operation::number: ones += coefficient * n.value; break;
      case Operation::pi: pis += coefficient; break;
      case Operation::sum:
        for (const Certificate::Term& t : n.terms) open[t.node] += coefficient * t.weight;
        break;
      case Operation::product: {
        Rational content = 1;
        const Certificate::Term* other = nullptr;
        std::size_t others = 0;
        for (const Certificate::Term& t : n.terms) {
          if (t.weight == 0) continue;
          const Certificate::Node& factor = c_.nodes[t.node];
          const bool number = factor.operation == Operation::number && factor.value != 0 && t.weight.get_den() == 1;
          const auto power = number ? exact_power(factor.value, t.weight.get_num().get_si()) : std::nullopt;
          if (power) content *= *power, check(content);
          else other = &t, ++others;
        }
        if (others == 0) ones += coefficient * content;
        else if (others == 1 && other->weight == 1) open[other->node] += coefficient * content;
        else angle.parts.push_back({Part::Of::node, local_[at], content, coefficient * content});
        break;
      }
      case Operation::symbol:
      case Operation::function:
      case Operation::atan2: angle.parts.push_back({Part::Of::node, local_[at], 1, coefficient}); break;
    }
  }
  check(ones), check(pis);
  if (circle && pis != 0) {
    const Rational twelfths = pis * 12;
    mpz_class whole;
    mpz_fdiv_q(whole.get_mpz_t(), twelfths.get_num_mpz_t(), twelfths.get_den_mpz_t());
    angle.twelfths = static_cast<unsigned>(mpz_fdiv_ui(whole.get_mpz_t(), 24));
    pis = (twelfths - whole) / 12;
  }
  if (ones != 0) angle.parts.push_back({Part::Of::one, 0, 1, ones});
  if (pis != 0) angle.parts.push_back({Part::Of::pi, 0, 1, pis});
  return angle;
}

// Degrees

// The bases of denominators.
enum : std::uint64_t { kInverted = 0, kCircle = 1, kGrowth = 2, kQuotient = 3, kBases = 4 };

double Program::total(const Degree& d) const {
  double sum = d.numerator;
  for (const auto& [base, exponent] : d.denominators) sum += exponent * base_degree_.at(base);
  return std::isnan(sum) ? kInfinity : sum;
}

Degree Program::sum_degree(const std::vector<const Degree*>& terms) {
  std::map<std::uint64_t, double> common;
  for (const Degree* d : terms)
    for (const auto& [base, exponent] : d->denominators) {
      double& e = common[base];
      e = std::max(e, exponent);
    }
  Degree sum;
  double all = 0;
  for (const auto& [base, exponent] : common) all += exponent * base_degree_.at(base), sum.denominators.emplace_back(base, exponent);
  for (const Degree* d : terms) {
    const double missing = all - (total(*d) - d->numerator);
    sum.numerator = std::max(sum.numerator, std::isnan(missing) ? kInfinity : d->numerator + missing);
  }
  work_.spend(10 * common.size() + 10 * terms.size());
  return sum;
}

void Program::multiply_degree(Degree& d, const Degree& by, double exponent, std::uint64_t base) {
  if (exponent < 0) {
    // 1 / (N/D) = D/N, N a new base.
    d.numerator += -exponent * (total(by) - by.numerator);
    if (by.numerator > 0) {
      base_degree_[base] = by.numerator;
      Degree inverse;
      inverse.denominators.emplace_back(base, 1);
      multiply_degree(d, inverse, -exponent, base);
    }
  } else {
    d.numerator += exponent * by.numerator;
    for (const auto& [b, e] : by.denominators) {
      const auto it = std::lower_bound(d.denominators.begin(), d.denominators.end(), std::pair{b, -kInfinity});
      if (it != d.denominators.end() && it->first == b) it->second += e * exponent;
      else d.denominators.insert(it, {b, e * exponent});
    }
  }
  if (std::isnan(d.numerator)) d.numerator = kInfinity;
  work_.spend(4 * (1 + d.denominators.size()));
}

void Program::degrees() {
  degree_.assign(steps_.size(), {});
  const std::uint64_t special = static_cast<std::uint64_t>(steps_.size()) * kBases;  // of the atoms 1 and π
  std::vector<std::pair<std::uint32_t, mpz_class>> roots;
  const auto key = [&](double degree) { ++keyed_, largest_key_ = std::max(largest_key_, degree); };
  for (std::size_t i = 0; i < steps_.size(); ++i) {
    const Step& s = steps_[i];
    Degree& d = degree_[i];
    const auto operand = [&](std::size_t k) -> const Degree& { return degree_[s.operands[k]]; };
    switch (s.node->operation) {
      case Operation::number: break;
      case Operation::pi:
      case Operation::symbol: d.numerator = 1; break;
      case Operation::sum: {
        std::vector<const Degree*> terms;
        for (std::size_t k = 0; k < s.operands.size(); ++k)
          if (s.node->terms[k].weight != 0) terms.push_back(&operand(k));
        d = sum_degree(terms);
        break;
      }
      case Operation::product:
        for (std::size_t k = 0; k < s.operands.size(); ++k) {
          if (s.operands[k] == kNone) continue;
          const Rational& weight = s.node->terms[k].weight;
          multiply_degree(d, operand(k), weight.get_d(), s.operands[k] * kBases + kInverted);
          if (weight.get_den() != 1) roots.emplace_back(s.operands[k], weight.get_den());
        }
        break;
      case Operation::atan2:
        d.numerator = 1;
        key(std::max(total(operand(0)), total(operand(1))));
        break;
      case Operation::function: {
        const std::string& name = s.node->function;
        if (name == "abs") d = operand(0);
        if (name == "abs" || name == "sign") break;
        if (s.family == Family::none) {
          d.numerator = 1;
          key(total(operand(0)));
          break;
        }
        const bool circle = s.family == Family::circle;
        double sum = 0;
        for (const Part& part : s.angle.parts) {
          const double times = std::abs(Rational(part.coefficient * (circle ? circle_q_ : growth_q_)).get_d());
          sum += 2 * times;
          const std::uint64_t atom = part.of == Part::Of::node ? part.local * kBases : special + (part.of == Part::Of::pi ? 1 : 0) * kBases;
          const std::uint64_t base = atom + (circle ? kCircle : kGrowth);
          base_degree_[base] = 2;
          Degree by;
          if (name == "exp" && part.coefficient > 0) by.numerator = 2 * times;
          else by.denominators.emplace_back(base, times);
          multiply_degree(d, by, 1, base);
          key(part.of == Part::Of::node ? total(degree_[part.local]) : 1);
        }
        if (circle) d.numerator += sum;
        if (name == "sinh" || name == "cosh" || name == "tanh") d.numerator += 2 * sum;
        if (name == "tan" || name == "tanh") {
          const std::uint64_t base = i * kBases + kQuotient;
          base_degree_[base] = name == "tan" ? sum : 2 * sum;
          d = Degree{base_degree_[base], {{base, 1}}};
        }
        break;
      }
    }
    if (std::isnan(d.numerator)) d.numerator = kInfinity;
    if (work_.done()) throw Unable{"the limit of work is reached"};
  }
  // The norm down to the field without roots: one factor for each choice of all roots.
  std::map<std::uint32_t, mpz_class> order;
  for (const auto& [local, q] : roots) {
    mpz_class& n = order.emplace(local, 1).first->second;
    mpz_lcm(n.get_mpz_t(), n.get_mpz_t(), q.get_mpz_t());
  }
  for (const auto& [local, n] : order) log2_conjugates_ += std::log2(n.get_d());
}

double Program::difference_degree(const Certificate::Claim& claim) {
  std::vector<Degree> products(claim.right.size());
  std::vector<const Degree*> terms{&degree_[local_[claim.left]]};
  for (std::size_t k = 0; k < products.size(); ++k) {
    multiply_degree(products[k], degree_[local_[claim.right[k].coefficient]], 1, 0);
    multiply_degree(products[k], degree_[local_[claim.right[k].node]], 1, 0);
    terms.push_back(&products[k]);
  }
  return sum_degree(terms).numerator;
}

// Evaluating

bool Program::reduce(const Field& f, Reduced& r) const {
  const Word p = f.prime(), squares = (p - 1) / 2;
  r.weights.assign(steps_.size(), {});
  r.factors.assign(steps_.size(), {});
  r.turns.assign(steps_.size(), {});
  // a/b modulo the order of a cyclic group; b is prime to it.
  const auto modulo = [](const Rational& e, Word order) {
    mpz_class m, inverse;
    mpz_import(m.get_mpz_t(), 1, 1, sizeof order, 0, 0, &order);
    mpz_invert(inverse.get_mpz_t(), e.get_den_mpz_t(), m.get_mpz_t());
    inverse *= e.get_num();
    return static_cast<Word>(mpz_fdiv_ui(inverse.get_mpz_t(), order));
  };
  for (std::size_t i = 0; i < steps_.size(); ++i) {
    const Step& s = steps_[i];
    if (s.node->operation == Operation::number || s.node->operation == Operation::sum) {
      const auto take = [&](const Rational& value) {
        const auto w = f.from(value);
        if (w) r.weights[i].push_back(*w);
        return w.has_value();
      };
      if (s.node->operation == Operation::number && !take(s.node->value)) return false;
      if (s.node->operation == Operation::sum)
        for (const Certificate::Term& t : s.node->terms)
          if (!take(t.weight)) return false;
    } else if (s.node->operation == Operation::product) {
      for (std::size_t k = 0; k < s.operands.size(); ++k) {
        Factor factor;
        if (s.operands[k] != kNone) {
          const Rational& e = s.node->terms[k].weight;
          const bool even = mpz_even_p(e.get_den_mpz_t());
          factor.exponent = modulo(e, even ? squares : p - 1);
          factor.zero_allowed = e > 0;
          if (even) factor.site = site_of_.at({s.operands[k], true});
        }
        r.factors[i].push_back(factor);
      }
    } else if (s.family != Family::none) {
      const bool circle = s.family == Family::circle;
      for (const Part& part : s.angle.parts) {
        const auto content = f.from(part.content);
        if (!content || *content == 0) return false;
        r.turns[i].push_back({f.inverse(*content), modulo(part.coefficient * (circle ? circle_q_ : growth_q_), circle ? p + 1 : p - 1)});
      }
    }
  }
  return true;
}

Word Program::random(const Field& f, const HashKey& key, std::uint64_t tag, Word a, Word b) const {
  for (std::uint64_t attempt = 0;; ++attempt) {
    const std::array<std::uint64_t, 4> words{tag, a, b, attempt};
    const Word w = siphash(key, words) >> 3;
    if (w < f.prime()) return w;
  }
}

Word Program::atom(const Field& f, const Part& part, const Turn& t, const HashKey& key, const std::vector<Word>& v) const {
  switch (part.of) {
    case Part::Of::node: return f.multiply(v[part.local], t.scale);
    case Part::Of::one: return 1;
    case Part::Of::pi: return pi_value(f, key);
  }
  return 0;
}

static std::pair<Word, Word> rotate(const Field& f, std::pair<Word, Word> a, std::pair<Word, Word> b) {
  return {f.subtract(f.multiply(a.first, b.first), f.multiply(a.second, b.second)),
          f.add(f.multiply(a.first, b.second), f.multiply(a.second, b.first))};
}

static std::pair<Word, Word> rotate(const Field& f, std::pair<Word, Word> a, Word times) {
  std::pair<Word, Word> r{1, 0};
  for (; times > 0; times >>= 1, a = rotate(f, a, a))
    if (times & 1) r = rotate(f, r, a);
  return r;
}

Program::Point Program::turn(const Field& f, const Step& step, const std::vector<Turn>& turns, const HashKey& key,
                             const std::vector<Word>& v, const Point& twelfth) const {
  std::pair<Word, Word> r = rotate(f, std::pair{twelfth.c, twelfth.s}, Word{step.angle.twelfths});
  for (std::size_t k = 0; k < turns.size(); ++k) {
    const Word u = random(f, key, 3, atom(f, step.angle.parts[k], turns[k], key, v)), square = f.multiply(u, u);
    const Word scale = f.inverse(f.add(1, square));  // −1 is not a square
    const std::pair<Word, Word> point{f.multiply(f.subtract(1, square), scale), f.multiply(f.add(u, u), scale)};
    r = rotate(f, r, rotate(f, point, turns[k].exponent));
  }
  return {r.first, r.second};
}

Word Program::grow(const Field& f, const Step& step, const std::vector<Turn>& turns, const HashKey& key, const std::vector<Word>& v) const {
  Word r = 1;
  for (std::size_t k = 0; k < turns.size(); ++k) {
    const Word value = atom(f, step.angle.parts[k], turns[k], key, v);
    Word g = random(f, key, 4, value);
    if (g == 0) g = 1;
    r = f.multiply(r, f.power(f.multiply(g, g), turns[k].exponent));
  }
  return r;
}

Program::Drawn Program::draw(const Field& f, const Reduced& r, const HashKey& key, std::vector<Word>& v) {
  const Word half = f.inverse(2);
  // cos and sin of π/12 are (√6 ± √2)/4; 2 and 3 are squares.
  const auto root = [&f](Word square) { return f.power(square, ((f.prime() - 1) / 2 + 1) / 2); };
  const Word quarter = f.multiply(half, half), root2 = root(2), root6 = f.multiply(root2, root(3));
  const Point twelfth{f.multiply(f.add(root6, root2), quarter), f.multiply(f.subtract(root6, root2), quarter)};
  const auto sign = [&f](Word a) { return a == 0 ? Word{0} : f.is_square(a) ? Word{1} : f.prime() - 1; };
  for (std::size_t i = 0; i < steps_.size(); ++i) {
    const Step& s = steps_[i];
    Word value = 0;
    switch (s.node->operation) {
      case Operation::number: value = r.weights[i][0]; break;
      case Operation::pi: value = pi_value(f, key); break;
      case Operation::symbol: value = random(f, key, 1, s.node->symbol); break;
      case Operation::sum:
        for (std::size_t k = 0; k < s.operands.size(); ++k) value = f.add(value, f.multiply(r.weights[i][k], v[s.operands[k]]));
        break;
      case Operation::product:
        value = 1;
        for (std::size_t k = 0; k < s.operands.size(); ++k) {
          if (s.operands[k] == kNone) continue;
          const Factor& factor = r.factors[i][k];
          const Word x = v[s.operands[k]];
          if (x == 0) {
            if (!factor.zero_allowed) return Drawn::undefined;
            value = 0;
            continue;
          }
          if (factor.site != kNone && !f.is_square(x)) {
            failed_site_ = factor.site;
            return sites_[factor.site].constant ? Drawn::bad_prime : Drawn::not_square;
          }
          value = f.multiply(value, f.power(x, factor.exponent));
        }
        break;
      case Operation::atan2:
        if (v[s.operands[0]] == 0 && v[s.operands[1]] == 0) return Drawn::undefined;
        value = random(f, key, 5, v[s.operands[0]], v[s.operands[1]]);
        break;
      case Operation::function: {
        const std::string& name = s.node->function;
        const Word u = v[s.operands[0]];
        if (s.family == Family::circle) {
          const Point point = turn(f, s, r.turns[i], key, v, twelfth);
          if (name == "tan" && point.c == 0) return Drawn::undefined;
          value = name == "sin" ? point.s : name == "cos" ? point.c : f.multiply(point.s, f.inverse(point.c));
        } else if (s.family == Family::exponential) {
          const Word e = grow(f, s, r.turns[i], key, v), inverse = f.inverse(e);
          const Word twice_sinh = f.subtract(e, inverse), twice_cosh = f.add(e, inverse);
          if (name == "tanh" && twice_cosh == 0) return Drawn::undefined;
          value = name == "exp" ? e : name == "sinh" ? f.multiply(half, twice_sinh) : name == "cosh" ? f.multiply(half, twice_cosh)
                                                                                                     : f.multiply(twice_sinh, f.inverse(twice_cosh));
        } else if (name == "abs" || name == "sign") {
          const Certificate::Node& of = *steps_[s.operands[0]].node;
          const Word plus = of.operation != Operation::number ? sign(u) : of.value == 0 ? Word{0} : of.value > 0 ? Word{1} : f.prime() - 1;
          value = name == "abs" ? f.multiply(u, plus) : plus;
        } else if (is_odd(name) || name == "acos") {
          static const auto& all = Certificate::functions();
          static const auto asin_name = static_cast<std::uint64_t>(std::find(all.begin(), all.end(), "asin") - all.begin());
          const Word plus = sign(u);
          value = f.multiply(plus, random(f, key, 6 + (name == "acos" ? asin_name : s.name), f.multiply(u, plus)));
          if (name == "acos") value = f.subtract(f.multiply(half, pi_value(f, key)), value);
        } else {
          value = random(f, key, 6 + s.name, u);
        }
        break;
      }
    }
    v[i] = value;
  }
  return Drawn::good;
}

std::vector<ModularFinding> Program::run(const HashKey& key, int points) {
  std::vector<ModularFinding> findings(claims_.size());
  try {
    for (Step& s : steps_) {
      if (s.family == Family::none) continue;
      const bool circle = s.family == Family::circle;
      s.angle = flatten(s.node->terms[0].node, circle);
      for (const Part& part : s.angle.parts) {
        mpz_class& q = circle ? circle_q_ : growth_q_;
        mpz_lcm(q.get_mpz_t(), q.get_mpz_t(), part.coefficient.get_den_mpz_t());
        cost_ += 1500;
        if (mpz_sizeinbase(q.get_mpz_t(), 2) > 60) throw Unable{"angles of too fine a common denominator"};
      }
    }
    degrees();
    std::vector<double> degree;
    for (const std::size_t k : claims_) degree.push_back(difference_degree(c_.claims[k]));

    const auto roots = static_cast<double>(std::count_if(sites_.begin(), sites_.end(), [](const Site& s) { return s.root && !s.constant; }));
    const auto branches = [this] {
      return static_cast<int>(std::count_if(sites_.begin(), sites_.end(), [](const Site& s) { return !s.failed && !s.constant; }));
    };
    const auto most_tries = static_cast<int>(200 * std::exp2(std::min(roots, 12.0)));
    std::vector<bool> nonzero(claims_.size(), false);
    std::vector<Word> v(steps_.size());
    std::vector<std::pair<Field, Reduced>> fields;
    std::uint64_t draws = 0;
    int accepted = 0;

    // One more point over a field; false if the prime does not serve.
    const auto one_point = [&](const Field& f, const Reduced& r) {
      for (int attempt = 0;; ++attempt) {
        if (!work_.spend(cost_)) throw Unable{"the limit of work is reached"};
        if (attempt == most_tries)
          throw Unable{roots > 0 ? "no point was found where it is defined and its roots exist" : "no point was found where it is defined"};
        const std::array<std::uint64_t, 2> words{f.prime(), ++draws};
        const HashKey point{siphash(key, words), key.high ^ draws};
        const Drawn drawn = draw(f, r, point, v);
        if (drawn == Drawn::bad_prime) return false;
        if (drawn == Drawn::not_square) sites_[failed_site_].failed = true;
        if (drawn != Drawn::good) continue;
        for (std::size_t k = 0; k < claims_.size(); ++k) {
          const Certificate::Claim& claim = c_.claims[claims_[k]];
          Word difference = v[local_[claim.left]];
          for (const Certificate::Pair& p : claim.right) difference = f.subtract(difference, f.multiply(v[local_[p.coefficient]], v[local_[p.node]]));
          if (difference != 0) nonzero[k] = true;
        }
        ++accepted;
        return true;
      }
    };
    for (const Word p : kPrimes) {
      if (fields.size() == 2) break;
      const Field f(p);
      Reduced r;
      if (!reduce(f, r)) continue;
      const int before = accepted;
      while (accepted < before + points && one_point(f, r)) {}
      if (accepted == before + points) fields.emplace_back(f, std::move(r));
      else accepted = before;
    }
    if (fields.size() < 2) throw Unable{"its constant roots exist modulo none of the primes at hand"};
    const auto needed = [&](int m) { return m == 0 || m > kMostBranches ? 0 : static_cast<int>(std::ceil(-kLargestChance * 0.7 * std::exp2(m))) + 1; };
    for (std::size_t turn_of = 0; accepted < needed(branches()); turn_of ^= 1) one_point(fields[turn_of].first, fields[turn_of].second);

    for (std::size_t k = 0; k < claims_.size(); ++k) {
      if (nonzero[k]) {
        findings[k].is = ModularFinding::Is::nonzero;
        continue;
      }
      // Per point: of degree d over p, for all conjugates, given that the roots exist; and two
      // arguments that are not equal may look equal.
      const double zeros = degree[k] + keyed_ * keyed_ * largest_key_;
      double chance = std::exp2(std::log2(std::max(zeros, 1.0)) + log2_conjugates_ + roots - 60.99);
      if (const int m = branches(); m > 0) chance += 1 - std::exp2(-m);
      findings[k].log2_chance = std::isfinite(chance) && chance < 1 ? accepted * std::log2(chance) : 0;
      if (findings[k].log2_chance <= kLargestChance) findings[k].is = ModularFinding::Is::zero;
      else if (branches() > kMostBranches) findings[k].detail = "it has too many roots or signs to try all their branches";
      else findings[k].detail = "it is zero at all points tried, but its degree is too high to conclude from that";
    }
  } catch (const Unable& u) {
    for (ModularFinding& finding : findings) finding = {ModularFinding::Is::unknown, 0, u.reason};
  }
  return findings;
}

}  // namespace

std::vector<ModularFinding> test_zero(const Certificate& c, const HashKey& key, int points, Work& work) {
  std::vector<ModularFinding> findings(c.claims.size());
  std::vector<std::uint32_t> scratch(c.nodes.size(), ~std::uint32_t{0});
  // Claims whose signs are chosen at the same places can share their points: no root of one claim
  // keeps another from a point it should see.
  std::map<std::vector<std::pair<Index, bool>>, std::vector<std::size_t>> groups;
  for (std::size_t k = 0; k < c.claims.size(); ++k) {
    if (!c.claims[k].says_zero()) continue;
    if (work.done()) {
      findings[k].detail = "the limit of work is reached";
      continue;
    }
    groups[Program(c, {k}, scratch, work).sites()].push_back(k);
  }
  const auto settle = [&](const std::vector<std::size_t>& claims) {
    std::vector<ModularFinding> part;
    {
      Program program(c, claims, scratch, work);
      part = program.run(key, points);
    }
    for (std::size_t i = 0; i < claims.size(); ++i) findings[claims[i]] = std::move(part[i]);
  };
  for (const auto& [sites, claims] : groups) {
    settle(claims);
    // One that cannot be treated must not spoil the others.
    if (claims.size() == 1) continue;
    for (const std::size_t k : claims)
      if (findings[k].is == ModularFinding::Is::unknown && !work.done()) settle({k});
  }
  return findings;
}

}  // namespace anholon::verification
