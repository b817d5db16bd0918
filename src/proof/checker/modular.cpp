#include "proof/checker/modular.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "proof/checker/modular_program.h"

namespace anholon::verification {

namespace {

constexpr double kLargestChance = -40;  // log2 of the probability; a larger bound confirms nothing
constexpr int kMostBranches = 8;

// Evaluates the claims of one program at random points over two fields.
class PointTest {
 public:
  PointTest(const Certificate& c, ModularProgram& program, const HashKey& key, int points)
      : c_(c), program_(program), key_(key), points_(points), nonzero_(program.claims().size(), false) {
    program.prepare();
    for (const std::size_t k : program.claims()) degree_.push_back(program.difference_degree(c.claims[k]));
    roots_ = program.varying_roots();
  }

  // Returns a finding for each claim of the program. Throws Unable.
  std::vector<ModularFinding> run() {
    take_points_of_two_fields();
    take_points_for_branches();
    std::vector<ModularFinding> findings;
    for (std::size_t k = 0; k < nonzero_.size(); ++k) findings.push_back(finding(k));
    return findings;
  }

 private:
  void take_points_of_two_fields() {
    for (const Word p : kPrimes) {
      if (fields_.size() == 2) return;
      std::optional<ReducedProgram> reduced = program_.over(Field(p));
      if (!reduced) continue;
      const int before = accepted_;
      while (accepted_ < before + points_ && one_point(*reduced)) {
      }
      if (accepted_ == before + points_)
        fields_.push_back(std::move(*reduced));
      else
        accepted_ = before;
    }
    if (fields_.size() < 2) throw Unable{"its constant roots exist modulo none of the primes at hand"};
  }

  // Takes more points, so that each choice of the signs that are still open occurs.
  void take_points_for_branches() {
    const auto needed = [&](int m) {
      return m == 0 || m > kMostBranches ? 0 : static_cast<int>(std::ceil(-kLargestChance * 0.7 * std::exp2(m))) + 1;
    };
    for (std::size_t turn_of = 0; accepted_ < needed(program_.open_branches()); turn_of ^= 1)
      one_point(fields_[turn_of]);
  }

  // Tests one more point over a field; returns false if the prime is unsuitable.
  bool one_point(const ReducedProgram& r) {
    using Drawn = ModularProgram::Drawn;
    const auto most_tries = static_cast<int>(200 * std::exp2(std::min(roots_, 12.0)));
    for (int attempt = 0; attempt < most_tries; ++attempt) {
      const std::array<std::uint64_t, 2> words{r.field.prime(), ++draws_};
      const Drawn drawn = program_.draw(r, {siphash(key_, words), key_.high ^ draws_}, values_);
      if (drawn == Drawn::bad_prime) return false;
      if (drawn != Drawn::good) continue;
      for (std::size_t k = 0; k < nonzero_.size(); ++k)
        if (program_.difference(r, c_.claims[program_.claims()[k]], values_) != 0) nonzero_[k] = true;
      ++accepted_;
      return true;
    }
    throw Unable{roots_ > 0 ? "no point was found where it is defined and its roots exist"
                            : "no point was found where it is defined"};
  }

  ModularFinding finding(std::size_t k) const {
    ModularFinding finding;
    if (nonzero_[k]) {
      finding.is = ModularFinding::Is::nonzero;
      return finding;
    }
    // The probability per point is degree d over p, for all conjugates, given that the roots exist; two different
    // arguments may also have equal values.
    const double zeros = degree_[k] + program_.key_collisions();
    double chance = std::exp2(std::log2(std::max(zeros, 1.0)) + program_.log2_conjugates() + roots_ - 60.99);
    const int branches = program_.open_branches();
    if (branches > 0) chance += 1 - std::exp2(-branches);
    finding.log2_chance = std::isfinite(chance) && chance < 1 ? accepted_ * std::log2(chance) : 0;
    if (finding.log2_chance <= kLargestChance)
      finding.is = ModularFinding::Is::zero;
    else if (branches > kMostBranches)
      finding.detail = "it has too many roots or signs to try all their branches";
    else
      finding.detail = "it is zero at all points tried, but its degree is too high to conclude from that";
    return finding;
  }

  const Certificate& c_;
  ModularProgram& program_;
  const HashKey& key_;
  const int points_;  // over each field
  std::vector<double> degree_;
  double roots_ = 0;
  std::vector<ReducedProgram> fields_;
  std::vector<Word> values_;
  std::vector<bool> nonzero_;
  std::uint64_t draws_ = 0;
  int accepted_ = 0;
};

std::vector<ModularFinding> test_together(const Certificate& c, ModularProgram& program, const HashKey& key,
                                          int points) {
  try {
    return PointTest(c, program, key, points).run();
  } catch (const Unable& u) {
    return std::vector<ModularFinding>(program.claims().size(), {ModularFinding::Is::unknown, 0, u.reason});
  }
}

}  // namespace

std::vector<ModularFinding> test_zero(const Certificate& c, const HashKey& key, int points, Work& work) {
  std::vector<ModularFinding> findings(c.claims.size());
  std::vector<std::uint32_t> scratch(c.nodes.size(), kNone);
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
    ModularProgram program(c, claims, scratch, work);
    std::vector<ModularFinding> part = test_together(c, program, key, points);
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
