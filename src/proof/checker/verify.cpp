#include "proof/checker/verify.h"

#include <algorithm>
#include <array>

#include "base/hash.h"
#include "numeric/ball.h"
#include "numeric/enclosure.h"
#include "proof/checker/modular.h"
#include "proof/checker/real.h"

namespace anholon {

namespace {

using verification::ModularFinding;
using verification::RealProgram;
using verification::Work;
using Index = Certificate::Index;

constexpr int kRealPoints = 3;     // real points that a claim of zero must survive
constexpr int kRealAttempts = 64;  // attempts to find these points, or one that contradicts
constexpr std::array<slong, 2> kRealBits = {128, 512};
constexpr std::size_t kMostEnclosed = 64;

std::string text(const Ball& b) {
  // A radius that the printed digits do not resolve is omitted.
  const bool negligible = !(b.center() + Ball(1 << 30) * b.spread()).contains_zero();
  return b.midpoint_text(8) + (negligible || b.radius() == Rational(0) ? "" : " ± " + b.radius_text());
}

std::string text(const Certificate& c, const std::vector<Index>& symbols, const std::vector<Rational>& values) {
  std::string s;
  for (std::size_t i = 0; i < symbols.size(); ++i) {
    if (i == 12) return s + ", …";
    s += (i ? ", " : "") + c.symbols[symbols[i]] + " = " + to_string(values[symbols[i]]);
  }
  return s;
}

// Returns small numbers with few digits, positive at every other attempt, because roots and logarithms need positive
// arguments.
std::vector<Rational> real_point(const Certificate& c, const HashKey& key, int attempt) {
  std::vector<Rational> point(c.symbols.size());
  for (std::size_t s = 0; s < point.size(); ++s) {
    const std::array<std::uint64_t, 3> words{7, static_cast<std::uint64_t>(attempt), s};
    const auto h = siphash(key, words);
    const long most = attempt % 4 < 2 ? 192 : 60, digits = static_cast<long>(h % static_cast<std::uint64_t>(most)) + 1;
    point[s] = Rational(attempt % 2 == 0 || (h >> 32) % 2 == 0 ? digits : -digits, 64);
  }
  return point;
}

// Tests claims of zero at real points, after the test modulo primes: a point may contradict a claim.
void real_points(const Certificate& c, const HashKey& key, Work& work, std::vector<ClaimFinding>& findings) {
  for (const slong bits : kRealBits) {
    const BallScope precision(bits);
    std::vector<std::size_t> open;
    for (std::size_t k = 0; k < c.claims.size(); ++k) {
      if (!c.claims[k].says_zero() || findings[k].finding == Finding::contradicted) continue;
      if (bits == kRealBits[0] || findings[k].finding == Finding::unchecked) open.push_back(k);
    }
    std::vector<int> seen(c.claims.size(), 0);
    std::size_t compiled = 0;
    std::optional<RealProgram> program;
    for (int attempt = 0; attempt < kRealAttempts && !open.empty(); ++attempt) {
      if (!program || open.size() * 2 < compiled) {
        std::vector<const Certificate::Claim*> claims;
        for (const std::size_t k : open) claims.push_back(&c.claims[k]);
        program.emplace(c, claims);
        compiled = open.size();
      }
      if (!work.spend(static_cast<std::uint64_t>(bits) * 2 * (program->size() + 1))) return;
      const std::vector<Rational> point = real_point(c, key, attempt);
      std::vector<Ball> symbols;
      for (const Rational& r : point) symbols.emplace_back(r);
      program->evaluate(symbols);
      std::erase_if(open, [&](std::size_t k) {
        const Ball d = program->difference(c.claims[k]);
        if (!d.is_finite()) return false;
        if (!d.contains_zero()) {
          const RealProgram alone(c, {&c.claims[k]});
          const std::string at = text(c, alone.symbols(), point);
          findings[k] = {Finding::contradicted, false, 0,
                         (at.empty() ? "" : "at " + at + " ") + "the difference is " + text(d)};
          return true;
        }
        return findings[k].finding == Finding::confirmed && ++seen[k] == kRealPoints;
      });
    }
  }
}

// Tests a claim of not zero by enclosures at the witness, with increasing precision.
ClaimFinding at_witness(const Certificate& c, const Certificate::Claim& claim, slong most_bits, Work& work) {
  const auto unchecked = [](std::string why) { return ClaimFinding{Finding::unchecked, false, 0, std::move(why)}; };
  const Certificate::Witness& w = *claim.witness;
  RealProgram program(c, {&claim}, w.equations);
  std::vector<bool> known(c.symbols.size(), false);
  for (const Certificate::Value& v : w.values) known[v.symbol] = true;
  std::vector<Index> unknowns;
  for (const Certificate::Enclosed& e : w.enclosed) known[e.symbol] = true, unknowns.push_back(e.symbol);
  for (const Index s : program.symbols())
    if (!known[s]) return unchecked("the witness has no value of '" + c.symbols[s] + "'");
  if (unknowns.size() > kMostEnclosed)
    return unchecked("the witness encloses more than " + std::to_string(kMostEnclosed) + " symbols");

  Ball last = Ball::unknown();
  bool rooted = false;
  for (slong bits = 64; bits <= most_bits; bits = bits < most_bits ? std::min(2 * bits, most_bits) : 2 * bits) {
    const BallScope precision(bits);
    if (!work.spend(static_cast<std::uint64_t>(bits) * 2 * (program.size() + 1) *
                    (unknowns.empty() ? 1 : 70 * (1 + unknowns.size()))))
      return unchecked("the limit of work is reached");
    std::vector<Ball> symbols(c.symbols.size());
    for (const Certificate::Value& v : w.values) symbols[v.symbol] = Ball(v.value);
    if (!unknowns.empty()) {
      SquareSystem system;
      system.size = unknowns.size();
      const auto put = [&](const Box& box) {
        for (std::size_t i = 0; i < unknowns.size(); ++i) symbols[unknowns[i]] = box[i];
        program.evaluate(symbols);
      };
      system.value = [&](const Box& box) {
        put(box);
        std::vector<Ball> values;
        for (const Index node : w.equations) values.push_back(program.value(node));
        return values;
      };
      system.jacobian = [&](const Box& box) {
        put(box);
        return program.jacobian(w.equations, unknowns);
      };
      Box box;
      for (const Certificate::Enclosed& e : w.enclosed) box.emplace_back(e.midpoint, e.radius);
      const std::vector<Ball> values = system.value(box);
      for (std::size_t i = 0; i < values.size(); ++i)
        if (values[i].is_finite() && !values[i].contains_zero())
          return {Finding::contradicted, false, 0,
                  "equation " + std::to_string(i + 1) + " of the witness has no root in its box: it is " +
                      text(values[i])};
      const auto root = prove_root(system, box);
      if (!root) continue;
      rooted = true;
      put(*root);
    } else {
      program.evaluate(symbols);
      rooted = true;
    }
    last = program.difference(claim);
    if (!last.is_finite()) continue;
    if (!last.contains_zero()) return {Finding::confirmed, true, 0, "it is " + text(last)};
    if (last.is_zero()) return {Finding::contradicted, false, 0, "at the witness it is 0"};
  }
  if (!rooted) return unchecked("no root of the witness's equations could be proved in its box");
  if (!last.is_finite()) return unchecked("it is not defined at the witness");
  return unchecked("at the witness it cannot be told from 0: it is " + text(last));
}

}  // namespace

const char* name(Finding f) {
  switch (f) {
  case Finding::confirmed:
    return "confirmed";
  case Finding::contradicted:
    return "contradicted";
  case Finding::unchecked:
    return "could not be checked";
  }
  return "";
}

bool Verification::all_confirmed() const {
  return !claims.empty() && std::all_of(claims.begin(), claims.end(),
                                        [](const ClaimFinding& f) { return f.finding == Finding::confirmed; });
}

Verification verify(const Certificate& c, const VerifyOptions& options) {
  const HashKey key = hash_key(std::to_string(options.seed) + '\n' + to_json(c));
  Work work;
  Verification result;
  result.claims.resize(c.claims.size());
  const std::vector<ModularFinding> modular = verification::test_zero(c, key, std::max(options.points, 1), work);
  for (std::size_t k = 0; k < c.claims.size(); ++k) {
    if (!c.claims[k].says_zero()) continue;
    switch (modular[k].is) {
    case ModularFinding::Is::zero:
      result.claims[k] = {Finding::confirmed, false, modular[k].log2_chance, ""};
      break;
    case ModularFinding::Is::nonzero:
      result.claims[k].detail = "it is not zero by the rules of the checker, but no real point was found that shows it";
      break;
    case ModularFinding::Is::unknown:
      result.claims[k].detail = modular[k].detail;
      break;
    }
  }
  real_points(c, key, work, result.claims);
  for (std::size_t k = 0; k < c.claims.size(); ++k)
    if (!c.claims[k].says_zero())
      result.claims[k] = at_witness(c, c.claims[k], static_cast<slong>(options.digits * 3.3219281) + 1, work);
  return result;
}

}  // namespace anholon
