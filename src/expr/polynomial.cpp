#include "expr/polynomial.h"

#include "base/assert.h"

namespace anholon {

Relations::Rule Relations::rule(Poly relation) const {
  std::vector<unsigned long> e(static_cast<std::size_t>(ring_->generators()));
  fmpq_mpoly_get_term_exp_ui(e.data(), relation.p_, 0, ring_->context());
  const auto first = std::find_if(e.begin(), e.end(), [](unsigned long n) { return n > 0; });
  ANHOLON_ASSERT(first != e.end());
  Rule r{std::move(relation), static_cast<std::size_t>(first - e.begin()), *first, 0, {}};
  r.tail = r.relation.length() - 1;
  for (long k = 1; k <= r.tail; ++k) {
    fmpq_mpoly_get_term_exp_ui(e.data(), r.relation.p_, k, ring_->context());
    for (std::size_t i = 0; i < e.size(); ++i)
      if (e[i] > 0) r.opens.push_back(i);
  }
  std::sort(r.opens.begin(), r.opens.end());
  r.opens.erase(std::unique(r.opens.begin(), r.opens.end()), r.opens.end());
  return r;
}

void Relations::add(Poly relation) { rules_.push_back(rule(std::move(relation))); }
void Relations::add_first(Poly relation) { rules_.insert(rules_.begin(), rule(std::move(relation))); }

// Returns the rules that may divide a term of p or of a tail that a division introduces. The other rules never do:
// without them FLINT only spends less time on comparing every term with every relation.
std::vector<const Relations::Rule*> Relations::needed(const std::vector<long>& degrees) const {
  std::vector<bool> wanted(rules_.size()), open(degrees.size());
  for (bool more = true; more;) {
    more = false;
    for (std::size_t i = 0; i < rules_.size(); ++i) {
      const Rule& r = rules_[i];
      if (wanted[i] || (degrees[r.generator] < static_cast<long>(r.power) && !open[r.generator])) continue;
      wanted[i] = more = true;
      for (std::size_t k : r.opens) open[k] = true;
    }
  }
  std::vector<const Rule*> out;
  for (std::size_t i = 0; i < rules_.size(); ++i)
    if (wanted[i]) out.push_back(&rules_[i]);
  return out;
}

// Charges an estimate of the number of terms that a reduction makes: each relation g^k = (a tail of T terms) expands
// g^(mk + …) into as many terms as the m-th power of its tail has, at most binomial(m + T - 1, m).
void Relations::pay(const Poly& p, const std::vector<const Rule*>& rules) const {
  // In large rings each term is compared with many relations, over exponents of many words.
  const std::size_t words = 1 + static_cast<std::size_t>(ring_->generators()) / 8;
  double work = static_cast<double>(p.length()) * static_cast<double>(rules_.size() * words / 16);
  for (long i = 0; i < p.length() && work < 1e9 && !rules.empty(); ++i) {
    double opened = 1;
    for (const Rule* rule : rules) {
      const unsigned long e =
          fmpq_mpoly_get_term_var_exp_ui(p.p_, i, static_cast<slong>(rule->generator), ring_->context());
      for (unsigned long m = e / rule->power, k = 1; k <= m && opened < 1e9; ++k)
        opened *= static_cast<double>(rule->tail - 1 + static_cast<long>(k)) / static_cast<double>(k);
    }
    if (opened > 1) work += opened;
  }
  ring_->spend(static_cast<long>(std::min(work, 1e9)));
}

Poly Relations::remainder(const Poly& p) const {
  if (rules_.empty() || p.zero()) return p;
  std::vector<long> degrees(static_cast<std::size_t>(ring_->generators()));
  fmpq_mpoly_degrees_si(degrees.data(), p.p_, ring_->context());
  const std::vector<const Rule*> rules = needed(degrees);
  pay(p, rules);
  if (rules.empty()) return p;
  std::vector<Poly> quotients(rules.size(), Poly(*ring_));
  std::vector<fmpq_mpoly_struct*> q, d;
  for (std::size_t i = 0; i < rules.size(); ++i) {
    q.push_back(quotients[i].p_);
    d.push_back(const_cast<fmpq_mpoly_struct*>(rules[i]->relation.p_));
  }
  Poly r(*ring_);
  fmpq_mpoly_divrem_ideal(q.data(), r.p_, p.p_, d.data(), static_cast<slong>(d.size()), ring_->context());
  return r;
}

}  // namespace anholon
