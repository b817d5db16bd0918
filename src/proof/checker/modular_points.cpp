// The program over a field, and its values at random points.
#include "proof/checker/modular_program.h"

namespace anholon::verification {

using Factor = ReducedProgram::Factor;
using Turn = ReducedProgram::Turn;
using Point = ReducedProgram::Point;

namespace {

// Returns a/b modulo the order of a cyclic group, to which b is coprime.
Word modulo(const Rational& e, Word order) {
  mpz_class m, inverse;
  mpz_import(m.get_mpz_t(), 1, 1, sizeof order, 0, 0, &order);
  mpz_invert(inverse.get_mpz_t(), e.get_den().get_mpz_t(), m.get_mpz_t());
  inverse *= e.get_num();
  return static_cast<Word>(mpz_fdiv_ui(inverse.get_mpz_t(), order));
}

Point rotate(const Field& f, const Point& a, const Point& b) {
  return {f.subtract(f.multiply(a.cos, b.cos), f.multiply(a.sin, b.sin)),
          f.add(f.multiply(a.cos, b.sin), f.multiply(a.sin, b.cos))};
}

Point rotate(const Field& f, Point a, Word times) {
  Point r{1, 0};
  for (; times > 0; times >>= 1, a = rotate(f, a, a))
    if (times & 1) r = rotate(f, r, a);
  return r;
}

// Returns cos and sin of π/12, which are (√6 ± √2)/4; 2 and 3 are squares.
Point twelfth_of(const Field& f, Word half) {
  const auto root = [&f](Word square) { return f.power(square, ((f.prime() - 1) / 2 + 1) / 2); };
  const Word quarter = f.multiply(half, half), root2 = root(2), root6 = f.multiply(root2, root(3));
  return {f.multiply(f.add(root6, root2), quarter), f.multiply(f.subtract(root6, root2), quarter)};
}

}  // namespace

ReducedProgram::ReducedProgram(const Field& f, std::size_t steps)
    : field(f), half(f.inverse(2)), twelfth(twelfth_of(f, half)), weights(steps), factors(steps), turns(steps) {}

std::optional<ReducedProgram> ModularProgram::over(const Field& f) const {
  const Word p = f.prime(), squares = (p - 1) / 2;
  ReducedProgram r(f, steps_.size());
  for (std::size_t i = 0; i < steps_.size(); ++i) {
    const Step& s = steps_[i];
    if (s.node->operation == Operation::number || s.node->operation == Operation::sum) {
      const auto take = [&](const Rational& value) {
        const auto w = f.from(value);
        if (w) r.weights[i].push_back(*w);
        return w.has_value();
      };
      if (s.node->operation == Operation::number && !take(s.node->value)) return std::nullopt;
      if (s.node->operation == Operation::sum)
        for (const Certificate::Term& t : s.node->terms)
          if (!take(t.weight)) return std::nullopt;
    } else if (s.node->operation == Operation::product) {
      for (std::size_t k = 0; k < s.operands.size(); ++k) {
        Factor factor;
        if (s.operands[k] != kNone) {
          const Rational& e = s.node->terms[k].weight;
          const bool even = e.has_even_denominator();
          factor.exponent = modulo(e, even ? squares : p - 1);
          factor.zero_allowed = e > 0;
          if (even) factor.site = site_of_.at({s.operands[k], true});
        }
        r.factors[i].push_back(factor);
      }
    } else if (is_of_angle(s.family)) {
      const bool circle = s.family == Family::circle;
      for (const Part& part : s.angle.parts) {
        const auto content = f.from(part.content);
        if (!content || *content == 0) return std::nullopt;
        r.turns[i].push_back(
            {f.inverse(*content), modulo(part.coefficient * (circle ? circle_q_ : growth_q_), circle ? p + 1 : p - 1)});
      }
    }
  }
  return r;
}

// The values of a program at one random point.
class ModularProgram::PointDraw {
 public:
  PointDraw(ModularProgram& program, const ReducedProgram& r, const HashKey& key, std::vector<Word>& values)
      : program_(program), r_(r), f_(r.field), key_(key), v_(values) {}

  Drawn run() {
    v_.resize(program_.steps_.size());
    for (std::size_t i = 0; i < v_.size() && drawn_ == Drawn::good; ++i) v_[i] = value(i);
    return drawn_;
  }

 private:
  // The kinds of random values, which begin the arguments that determine such a value.
  enum : std::uint64_t { kSymbol = 1, kPi = 2, kTurn = 3, kGrowth = 4, kAtan2 = 5, kFunction = 6 };

  Word random(std::uint64_t tag, Word a, Word b = 0) const {
    for (std::uint64_t attempt = 0;; ++attempt) {
      const std::array<std::uint64_t, 4> words{tag, a, b, attempt};
      const Word w = siphash(key_, words) >> 3;
      if (w < f_.prime()) return w;
    }
  }
  Word pi_value() const { return random(kPi, 0); }
  Word sign(Word a) const { return a == 0 ? Word{0} : f_.is_square(a) ? Word{1} : f_.prime() - 1; }
  Word fails(Drawn how) {
    drawn_ = how;
    return 0;
  }

  Word value(std::size_t i) {
    const Step& s = program_.steps_[i];
    switch (s.node->operation) {
    case Operation::number:
      return r_.weights[i][0];
    case Operation::pi:
      return pi_value();
    case Operation::symbol:
      return random(kSymbol, s.node->symbol);
    case Operation::sum: {
      Word sum = 0;
      for (std::size_t k = 0; k < s.operands.size(); ++k)
        sum = f_.add(sum, f_.multiply(r_.weights[i][k], v_[s.operands[k]]));
      return sum;
    }
    case Operation::product:
      return product(s, r_.factors[i]);
    case Operation::atan2: {
      const Word y = v_[s.operands[0]], x = v_[s.operands[1]];
      return y == 0 && x == 0 ? fails(Drawn::undefined) : random(kAtan2, y, x);
    }
    case Operation::function:
      return function(s, r_.turns[i]);
    }
    return 0;
  }

  Word product(const Step& s, const std::vector<Factor>& factors) {
    Word value = 1;
    for (std::size_t k = 0; k < s.operands.size(); ++k) {
      if (s.operands[k] == kNone) continue;
      const Factor& factor = factors[k];
      const Word x = v_[s.operands[k]];
      if (x == 0) {
        if (!factor.zero_allowed) return fails(Drawn::undefined);
        value = 0;
        continue;
      }
      if (factor.site != kNone && !f_.is_square(x)) {
        Site& site = program_.sites_[factor.site];
        if (site.constant) return fails(Drawn::bad_prime);
        site.failed = true;
        return fails(Drawn::not_square);
      }
      value = f_.multiply(value, f_.power(x, factor.exponent));
    }
    return value;
  }

  Word function(const Step& s, const std::vector<Turn>& turns) {
    const Word u = v_[s.operands[0]];
    switch (s.family) {
    case Family::keyed:
      return random(kFunction + s.name, u);
    case Family::odd:
      return odd(s.name, u);
    case Family::complement:
      return f_.subtract(f_.multiply(r_.half, pi_value()), odd(s.name, u));
    case Family::branch:
      return branch(s, u);
    case Family::circle:
      return of_circle(s, turned(s, turns));
    case Family::exponential:
      return of_exponential(s, grown(s, turns));
    }
    return 0;
  }

  Word odd(std::uint64_t name, Word u) const {
    const Word plus = sign(u);
    return f_.multiply(plus, random(kFunction + name, f_.multiply(u, plus)));
  }

  Word branch(const Step& s, Word u) const {
    const Certificate::Node& of = *program_.steps_[s.operands[0]].node;
    const Word plus = of.operation != Operation::number ? sign(u)
                      : of.value == 0                   ? Word{0}
                      : of.value > 0                    ? Word{1}
                                                        : f_.prime() - 1;
    return s.node->function == "abs" ? f_.multiply(u, plus) : plus;
  }

  Word of_circle(const Step& s, const Point& p) {
    if (s.node->function == "sin") return p.sin;
    if (s.node->function == "cos") return p.cos;
    return p.cos == 0 ? fails(Drawn::undefined) : f_.multiply(p.sin, f_.inverse(p.cos));
  }

  Word of_exponential(const Step& s, Word e) {
    const std::string& name = s.node->function;
    if (name == "exp") return e;
    const Word inverse = f_.inverse(e);
    const Word twice_sinh = f_.subtract(e, inverse), twice_cosh = f_.add(e, inverse);
    if (name == "sinh") return f_.multiply(r_.half, twice_sinh);
    if (name == "cosh") return f_.multiply(r_.half, twice_cosh);
    return twice_cosh == 0 ? fails(Drawn::undefined) : f_.multiply(twice_sinh, f_.inverse(twice_cosh));
  }

  Word atom(const Part& part, const Turn& t) const {
    switch (part.of) {
    case Part::Of::node:
      return f_.multiply(v_[part.local], t.scale);
    case Part::Of::one:
      return 1;
    case Part::Of::pi:
      return pi_value();
    }
    return 0;
  }

  Point turned(const Step& step, const std::vector<Turn>& turns) const {
    Point r = rotate(f_, r_.twelfth, Word{step.angle.twelfths});
    for (std::size_t k = 0; k < turns.size(); ++k) {
      const Word u = random(kTurn, atom(step.angle.parts[k], turns[k])), square = f_.multiply(u, u);
      const Word scale = f_.inverse(f_.add(1, square));  // −1 is not a square
      const Point point{f_.multiply(f_.subtract(1, square), scale), f_.multiply(f_.add(u, u), scale)};
      r = rotate(f_, r, rotate(f_, point, turns[k].exponent));
    }
    return r;
  }

  Word grown(const Step& step, const std::vector<Turn>& turns) const {
    Word r = 1;
    for (std::size_t k = 0; k < turns.size(); ++k) {
      Word g = random(kGrowth, atom(step.angle.parts[k], turns[k]));
      if (g == 0) g = 1;
      r = f_.multiply(r, f_.power(f_.multiply(g, g), turns[k].exponent));
    }
    return r;
  }

  ModularProgram& program_;
  const ReducedProgram& r_;
  const Field& f_;
  const HashKey& key_;
  std::vector<Word>& v_;
  Drawn drawn_ = Drawn::good;
};

ModularProgram::Drawn ModularProgram::draw(const ReducedProgram& r, const HashKey& key, std::vector<Word>& values) {
  if (!work_.spend(cost_)) throw Unable{"the limit of work is reached"};
  return PointDraw(*this, r, key, values).run();
}

Word ModularProgram::difference(const ReducedProgram& r, const Certificate::Claim& claim,
                                const std::vector<Word>& values) const {
  const Field& f = r.field;
  Word difference = values[local_[claim.left]];
  for (const Certificate::Pair& p : claim.right)
    difference = f.subtract(difference, f.multiply(values[local_[p.coefficient]], values[local_[p.node]]));
  return difference;
}

}  // namespace anholon::verification
