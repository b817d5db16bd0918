#include <algorithm>

#include "proof/verify_modular_program.h"

namespace anholon::verification {

static bool is_odd(const std::string& f) { return f == "asin" || f == "atan" || f == "asinh" || f == "atanh"; }

bool ModularProgram::reduce(const Field& f, Reduced& r) const {
  const Word p = f.prime(), squares = (p - 1) / 2;
  r.weights.assign(steps_.size(), {});
  r.factors.assign(steps_.size(), {});
  r.turns.assign(steps_.size(), {});
  // a/b modulo the order of a cyclic group, to which b is coprime.
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
        r.turns[i].push_back(
            {f.inverse(*content), modulo(part.coefficient * (circle ? circle_q_ : growth_q_), circle ? p + 1 : p - 1)});
      }
    }
  }
  return true;
}

Word ModularProgram::random(const Field& f, const HashKey& key, std::uint64_t tag, Word a, Word b) const {
  for (std::uint64_t attempt = 0;; ++attempt) {
    const std::array<std::uint64_t, 4> words{tag, a, b, attempt};
    const Word w = siphash(key, words) >> 3;
    if (w < f.prime()) return w;
  }
}

Word ModularProgram::atom(const Field& f, const Part& part, const Turn& t, const HashKey& key,
                          const std::vector<Word>& v) const {
  switch (part.of) {
  case Part::Of::node:
    return f.multiply(v[part.local], t.scale);
  case Part::Of::one:
    return 1;
  case Part::Of::pi:
    return pi_value(f, key);
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

ModularProgram::Point ModularProgram::turn(const Field& f, const Step& step, const std::vector<Turn>& turns,
                                           const HashKey& key, const std::vector<Word>& v, const Point& twelfth) const {
  std::pair<Word, Word> r = rotate(f, std::pair{twelfth.c, twelfth.s}, Word{step.angle.twelfths});
  for (std::size_t k = 0; k < turns.size(); ++k) {
    const Word u = random(f, key, 3, atom(f, step.angle.parts[k], turns[k], key, v)), square = f.multiply(u, u);
    const Word scale = f.inverse(f.add(1, square));  // −1 is not a square
    const std::pair<Word, Word> point{f.multiply(f.subtract(1, square), scale), f.multiply(f.add(u, u), scale)};
    r = rotate(f, r, rotate(f, point, turns[k].exponent));
  }
  return {r.first, r.second};
}

Word ModularProgram::grow(const Field& f, const Step& step, const std::vector<Turn>& turns, const HashKey& key,
                          const std::vector<Word>& v) const {
  Word r = 1;
  for (std::size_t k = 0; k < turns.size(); ++k) {
    const Word value = atom(f, step.angle.parts[k], turns[k], key, v);
    Word g = random(f, key, 4, value);
    if (g == 0) g = 1;
    r = f.multiply(r, f.power(f.multiply(g, g), turns[k].exponent));
  }
  return r;
}

ModularProgram::Drawn ModularProgram::draw(const Field& f, const Reduced& r, const HashKey& key, std::vector<Word>& v) {
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
    case Operation::number:
      value = r.weights[i][0];
      break;
    case Operation::pi:
      value = pi_value(f, key);
      break;
    case Operation::symbol:
      value = random(f, key, 1, s.node->symbol);
      break;
    case Operation::sum:
      for (std::size_t k = 0; k < s.operands.size(); ++k)
        value = f.add(value, f.multiply(r.weights[i][k], v[s.operands[k]]));
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
        value = name == "exp"    ? e
                : name == "sinh" ? f.multiply(half, twice_sinh)
                : name == "cosh" ? f.multiply(half, twice_cosh)
                                 : f.multiply(twice_sinh, f.inverse(twice_cosh));
      } else if (name == "abs" || name == "sign") {
        const Certificate::Node& of = *steps_[s.operands[0]].node;
        const Word plus = of.operation != Operation::number ? sign(u)
                          : of.value == 0                   ? Word{0}
                          : of.value > 0                    ? Word{1}
                                                            : f.prime() - 1;
        value = name == "abs" ? f.multiply(u, plus) : plus;
      } else if (is_odd(name) || name == "acos") {
        static const auto& all = Certificate::functions();
        static const auto asin_name =
            static_cast<std::uint64_t>(std::find(all.begin(), all.end(), "asin") - all.begin());
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

}  // namespace anholon::verification
