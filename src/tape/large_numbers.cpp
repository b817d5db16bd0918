#include "tape/large_numbers.h"

#include <algorithm>

namespace anholon {

long binary_exponent(const Rational& r) {
  return static_cast<long>(mpz_sizeinbase(r.get_num().get_mpz_t(), 2)) -
         static_cast<long>(mpz_sizeinbase(r.get_den().get_mpz_t(), 2));
}

Rational times_power_of_two(const Rational& r, long k) {
  const mpz_class power = mpz_class(1) << static_cast<mp_bitcnt_t>(std::labs(k));
  return k < 0 ? r / Rational(power) : r * Rational(power);
}

std::unordered_set<NodeId> large_sums(const Graph& g, std::span<const NodeId> nodes) {
  const auto exponent = [&](NodeId sum) {
    long most = 0;
    for (const Term& t : g.summands(sum)) most = std::max(most, binary_exponent(g.rational(t.weight)));
    return most;
  };
  std::unordered_set<NodeId> large;
  for (const NodeId id : nodes) {
    if (g.node(id).kind == Kind::sum && exponent(id) > kLargestExponent) large.insert(id);
    if (g.node(id).kind != Kind::product) continue;
    long of_product = 0;
    std::vector<NodeId> sums;
    for (const Term& t : g.terms(id)) {
      const Rational& n = g.rational(t.weight);
      if (g.node(t.node).kind != Kind::sum || !n.is_integer() || !n.fits_long()) continue;
      const long each = exponent(t.node);
      if (each == 0) continue;
      sums.push_back(t.node);
      of_product += std::min(1000L, std::labs(n.to_long())) * each;
    }
    if (of_product > kLargestExponent) large.insert(sums.begin(), sums.end());
  }
  return large;
}

}  // namespace anholon
