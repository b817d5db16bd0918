#include "proof/verify_modular.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "proof/verify_modular_program.h"

namespace anholon::verification {

constexpr double kLargestChance = -40;  // log2 of the probability; a larger bound confirms nothing
constexpr int kMostBranches = 8;

std::vector<ModularFinding> ModularProgram::run(const HashKey& key, int points) {
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

    const auto roots = static_cast<double>(
        std::count_if(sites_.begin(), sites_.end(), [](const Site& s) { return s.root && !s.constant; }));
    const auto branches = [this] {
      return static_cast<int>(
          std::count_if(sites_.begin(), sites_.end(), [](const Site& s) { return !s.failed && !s.constant; }));
    };
    const auto most_tries = static_cast<int>(200 * std::exp2(std::min(roots, 12.0)));
    std::vector<bool> nonzero(claims_.size(), false);
    std::vector<Word> v(steps_.size());
    std::vector<std::pair<Field, Reduced>> fields;
    std::uint64_t draws = 0;
    int accepted = 0;

    // Tests one more point over a field; returns false if the prime is unsuitable.
    const auto one_point = [&](const Field& f, const Reduced& r) {
      for (int attempt = 0;; ++attempt) {
        if (!work_.spend(cost_)) throw Unable{"the limit of work is reached"};
        if (attempt == most_tries)
          throw Unable{roots > 0 ? "no point was found where it is defined and its roots exist"
                                 : "no point was found where it is defined"};
        const std::array<std::uint64_t, 2> words{f.prime(), ++draws};
        const HashKey point{siphash(key, words), key.high ^ draws};
        const Drawn drawn = draw(f, r, point, v);
        if (drawn == Drawn::bad_prime) return false;
        if (drawn == Drawn::not_square) sites_[failed_site_].failed = true;
        if (drawn != Drawn::good) continue;
        for (std::size_t k = 0; k < claims_.size(); ++k) {
          const Certificate::Claim& claim = c_.claims[claims_[k]];
          Word difference = v[local_[claim.left]];
          for (const Certificate::Pair& p : claim.right)
            difference = f.subtract(difference, f.multiply(v[local_[p.coefficient]], v[local_[p.node]]));
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
      while (accepted < before + points && one_point(f, r)) {
      }
      if (accepted == before + points)
        fields.emplace_back(f, std::move(r));
      else
        accepted = before;
    }
    if (fields.size() < 2) throw Unable{"its constant roots exist modulo none of the primes at hand"};
    const auto needed = [&](int m) {
      return m == 0 || m > kMostBranches ? 0 : static_cast<int>(std::ceil(-kLargestChance * 0.7 * std::exp2(m))) + 1;
    };
    for (std::size_t turn_of = 0; accepted < needed(branches()); turn_of ^= 1)
      one_point(fields[turn_of].first, fields[turn_of].second);

    for (std::size_t k = 0; k < claims_.size(); ++k) {
      if (nonzero[k]) {
        findings[k].is = ModularFinding::Is::nonzero;
        continue;
      }
      // Probability per point: degree d over p, for all conjugates, given that the roots exist; and two different
      // arguments may have equal values.
      const double zeros = degree[k] + keyed_ * keyed_ * largest_key_;
      double chance = std::exp2(std::log2(std::max(zeros, 1.0)) + log2_conjugates_ + roots - 60.99);
      if (const int m = branches(); m > 0) chance += 1 - std::exp2(-m);
      findings[k].log2_chance = std::isfinite(chance) && chance < 1 ? accepted * std::log2(chance) : 0;
      if (findings[k].log2_chance <= kLargestChance)
        findings[k].is = ModularFinding::Is::zero;
      else if (branches() > kMostBranches)
        findings[k].detail = "it has too many roots or signs to try all their branches";
      else
        findings[k].detail = "it is zero at all points tried, but its degree is too high to conclude from that";
    }
  } catch (const Unable& u) {
    for (ModularFinding& finding : findings) finding = {ModularFinding::Is::unknown, 0, u.reason};
  }
  return findings;
}

std::vector<ModularFinding> test_zero(const Certificate& c, const HashKey& key, int points, Work& work) {
  std::vector<ModularFinding> findings(c.claims.size());
  std::vector<std::uint32_t> scratch(c.nodes.size(), ~std::uint32_t{0});
  // Claims whose signs are chosen at the same nodes can share their points: no root of one claim then excludes a point
  // that another claim needs.
  std::map<std::vector<std::pair<Index, bool>>, std::vector<std::size_t>> groups;
  for (std::size_t k = 0; k < c.claims.size(); ++k) {
    if (!c.claims[k].says_zero()) continue;
    if (work.done()) {
      findings[k].detail = "the limit of work is reached";
      continue;
    }
    groups[ModularProgram(c, {k}, scratch, work).sites()].push_back(k);
  }
  const auto settle = [&](const std::vector<std::size_t>& claims) {
    std::vector<ModularFinding> part;
    {
      ModularProgram program(c, claims, scratch, work);
      part = program.run(key, points);
    }
    for (std::size_t i = 0; i < claims.size(); ++i) findings[claims[i]] = std::move(part[i]);
  };
  for (const auto& [sites, claims] : groups) {
    settle(claims);
    // A claim that cannot be checked must not affect the others.
    if (claims.size() == 1) continue;
    for (const std::size_t k : claims)
      if (findings[k].is == ModularFinding::Is::unknown && !work.done()) settle({k});
  }
  return findings;
}

}  // namespace anholon::verification
