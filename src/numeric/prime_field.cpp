#include "numeric/prime_field.h"

namespace anholon {

PrimeField::Word PrimeField::power(Word a, Word exponent) const {
  Word r = 1;
  for (; exponent > 0; exponent >>= 1, a = multiply(a, a))
    if (exponent & 1) r = multiply(r, a);
  return r;
}

std::optional<PrimeField::Word> PrimeField::from(const Rational& r) const {
  const auto [n, d] = r.modulo(p_);
  if (d == 0) return std::nullopt;
  return d == 1 ? n : multiply(n, inverse(d));
}

}  // namespace anholon
