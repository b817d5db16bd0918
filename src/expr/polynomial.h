// Polynomials over Q with exact arithmetic, on FLINT, for the normal form and for the arrangement of expressions in
// print. Every product counts towards a limit, which bounds the time of a computation.
#pragma once
#include <algorithm>
#include <cstdlib>
#include <utility>
#include <vector>

#include <flint/fmpq_mpoly.h>
#include <flint/fmpq_mpoly_factor.h>

#include "base/stop.h"
#include "expr/monomial.h"
#include "numeric/flint_rational.h"

namespace anholon {

struct TooLarge {};

// A product with more terms ends the test.
inline constexpr long kNormalTermLimit = 2'000'000;
// A coefficient with more bits ends the test.
inline constexpr long kLargestCoefficient = 4000;
// The limit of products of terms in one test.
inline constexpr long kMostWork = 10'000'000;

// Polynomials over Q in a fixed number of generators, lexicographic, earlier generators first.
class Ring {
 public:
  explicit Ring(long generators, long most_work = kMostWork) : generators_(generators), most_work_(most_work) {
    fmpq_mpoly_ctx_init(context_, generators, ORD_LEX);
  }
  ~Ring() { fmpq_mpoly_ctx_clear(context_); }
  Ring(const Ring&) = delete;
  Ring& operator=(const Ring&) = delete;
  const fmpq_mpoly_ctx_struct* context() const { return context_; }
  long generators() const { return generators_; }
  void spend(long work) const {
    look_for_stop();
    if (work > kNormalTermLimit || (work_ += work) > most_work_) throw TooLarge{};
  }

 private:
  fmpq_mpoly_ctx_t context_;
  long generators_, most_work_;
  mutable long work_ = 0;
};

class Poly {
 public:
  explicit Poly(const Ring& ring) : ring_(&ring) { fmpq_mpoly_init(p_, ring.context()); }
  Poly(const Poly& o) : ring_(o.ring_) {
    fmpq_mpoly_init(p_, ring_->context());
    fmpq_mpoly_set(p_, o.p_, ring_->context());
  }
  Poly(Poly&& o) noexcept : ring_(o.ring_) {
    fmpq_mpoly_init(p_, ring_->context());
    fmpq_mpoly_swap(p_, o.p_, ring_->context());
  }
  Poly& operator=(const Poly& o) {
    fmpq_mpoly_set(p_, o.p_, ring_->context());
    return *this;
  }
  Poly& operator=(Poly&& o) noexcept {
    fmpq_mpoly_swap(p_, o.p_, ring_->context());
    return *this;
  }
  ~Poly() { fmpq_mpoly_clear(p_, ring_->context()); }
  static Poly constant(const Ring& ring, const Rational& r) {
    Poly p(ring);
    fmpq_mpoly_set_fmpq(p.p_, FlintRational::of(r), ring.context());
    return p;
  }
  static Poly generator(const Ring& ring, long k) {
    Poly p(ring);
    fmpq_mpoly_gen(p.p_, k, ring.context());
    return p;
  }
  bool zero() const { return fmpq_mpoly_is_zero(p_, ring_->context()) != 0; }
  bool one() const { return fmpq_mpoly_is_one(p_, ring_->context()) != 0; }
  bool same(const Poly& o) const { return fmpq_mpoly_equal(p_, o.p_, ring_->context()) != 0; }
  Monomials terms() const {
    Monomials out;
    for (long k = 0; k < length(); ++k) {
      Monomial m;
      fmpq_mpoly_get_term_coeff_fmpq(FlintRational::of(m.coefficient), p_, k, ring_->context());
      m.exponents.resize(static_cast<std::size_t>(ring_->generators()));
      fmpq_mpoly_get_term_exp_ui(m.exponents.data(), p_, k, ring_->context());
      out.push_back(std::move(m));
    }
    return out;
  }
  static Poly of(const Ring& ring, const Monomials& terms) {
    Poly p(ring);
    for (const Monomial& m : terms)
      fmpq_mpoly_push_term_fmpq_ui(p.p_, FlintRational::of(m.coefficient), m.exponents.data(), ring.context());
    fmpq_mpoly_sort_terms(p.p_, ring.context());
    fmpq_mpoly_combine_like_terms(p.p_, ring.context());
    return p;
  }
  long length() const { return fmpq_mpoly_length(p_, ring_->context()); }
  friend Poly operator+(const Poly& a, const Poly& b) {
    Poly r(*a.ring_);
    fmpq_mpoly_add(r.p_, a.p_, b.p_, a.ring_->context());
    return r;
  }
  friend Poly operator-(const Poly& a, const Poly& b) {
    Poly r(*a.ring_);
    fmpq_mpoly_sub(r.p_, a.p_, b.p_, a.ring_->context());
    return r;
  }
  friend Poly operator*(const Poly& a, const Poly& b) {
    a.ring_->spend(a.length() * b.length());
    if (std::abs(fmpz_mpoly_max_bits(a.p_->zpoly)) > kLargestCoefficient) throw TooLarge{};
    Poly r(*a.ring_);
    fmpq_mpoly_mul(r.p_, a.p_, b.p_, a.ring_->context());
    return r;
  }
  // These return the greatest common divisor (1 if FLINT finds none), and the quotient by a divisor.
  friend Poly common(const Poly& a, const Poly& b) {
    Poly r(*a.ring_);
    if (!fmpq_mpoly_gcd(r.p_, a.p_, b.p_, a.ring_->context())) return constant(*a.ring_, 1);
    return r;
  }
  friend Poly quotient(const Poly& a, const Poly& divisor) {
    Poly r(*a.ring_);
    if (!fmpq_mpoly_divides(r.p_, a.p_, divisor.p_, a.ring_->context())) throw TooLarge{};
    return r;
  }
  // Returns the irreducible factors with their exponents; their product is this polynomial up to a rational factor.
  std::vector<std::pair<Poly, unsigned long>> factors() const {
    std::vector<std::pair<Poly, unsigned long>> out;
    fmpq_mpoly_factor_t f;
    fmpq_mpoly_factor_init(f, ring_->context());
    if (fmpq_mpoly_factor(f, p_, ring_->context()))
      for (long k = 0; k < fmpq_mpoly_factor_length(f, ring_->context()); ++k) {
        Poly base(*ring_);
        fmpq_mpoly_factor_get_base(base.p_, f, k, ring_->context());
        out.emplace_back(std::move(base),
                         static_cast<unsigned long>(fmpq_mpoly_factor_get_exp_si(f, k, ring_->context())));
      }
    fmpq_mpoly_factor_clear(f, ring_->context());
    return out;
  }

 private:
  friend class Relations;
  const Ring* ring_;
  fmpq_mpoly_t p_;
};

// Polynomials that are zero, each g^k = (a tail of later generators), in the order in which a division tries them.
class Relations {
 public:
  explicit Relations(const Ring& ring) : ring_(&ring) {}
  void add(Poly relation);
  void add_first(Poly relation);
  Poly remainder(const Poly& p) const;

 private:
  // The condition of the leading monomial on a term that it divides, and the generators that the tail introduces.
  struct Rule {
    Poly relation;
    std::size_t generator;
    unsigned long power;
    long tail;
    std::vector<std::size_t> opens;
  };
  Rule rule(Poly relation) const;
  std::vector<const Rule*> needed(const std::vector<long>& degrees) const;
  void pay(const Poly& p, const std::vector<const Rule*>& rules) const;

  const Ring* ring_;
  std::vector<Rule> rules_;
};

}  // namespace anholon
