// Finds the true equation nearest to a false one.
#include <algorithm>

#include "expr/normal.h"
#include "print/arrange.h"
#include "published/at_points.h"
#include "published/compare.h"

namespace anholon {

namespace {

constexpr long kWorkOfCount = 200'000;
constexpr std::size_t kLongestCounted = 800;  // nodes
constexpr std::size_t kLongestFactor = 40;    // nodes
constexpr std::size_t kPrinted = 5;           // differences that are arranged for a choice

// Returns a measure of the length of an expression in print.
std::size_t monomials(Expr e, const SymbolNames& names) {
  if (is_zero(e)) return 0;
  std::size_t least = 1000 + number_of_nodes(e);
  if (least > 1000 + kLongestCounted) return least;
  // Tries sines of sums and tangents unexpanded, then expanded.
  for (const bool angles : {true, false})
    if (const auto form = normal_form(e, Whole{angles, angles, &names.defined}, kWorkOfCount))
      least = std::min(least, form->numerator.size() * (form->denominator.size() > 1 ? 2 : 1));
  return least;
}

}  // namespace

// A misprint shows the intended equation: of several misprints, the one with the smallest change is taken.
void Comparer::nearest_of(const std::vector<Change>& changes, Expr P, Comparison& out) const {
  std::size_t shortest = SIZE_MAX;
  for (std::size_t k = 0; k < changes.size() && k < kPrinted; ++k) {
    const Expr difference = arranged(P - changes[k].difference, names_);
    const std::size_t length = print(difference, names_, Format::text).size();
    if (length < shortest) shortest = length, out.difference = difference, out.what = changes[k].what;
  }
}

// Collects derived equations, times factors, that a false equation may mean.
class Comparer::Nearest {
 public:
  Nearest(const Comparer& comparer, EquationsOfMotion& motion, Expr P)
      : c_(comparer), g_(comparer.M_.graph()), P_(P), motion_(motion), point_(motion.anywhere()[0]), by_(motion.top) {
    // If all accelerations are lost, parameters show the factor.
    const Column p_top = gradient(P, motion.top);
    if (std::all_of(p_top.begin(), p_top.end(), [](Expr x) { return is_zero(x); }))
      for (std::size_t k = 0; k < c_.M_.model->parameters.size(); ++k)
        by_.push_back(g_.parameter(static_cast<std::uint32_t>(k)));
    p_by_ = gradient(P, by_);
  }

  void offer_derived(const DerivedEquation& e) {
    next_equation();
    if (e.constraint) {
      // The comparison is in the equation's own leading derivatives.
      const Column symbols = c_.leading(e, motion_), q = gradient(P_, symbols), f = gradient(e.residual, symbols);
      for (std::size_t j = 0; j < symbols.size(); ++j)
        if (are_not_zero(q[j], f[j]))
          offer(P_ - c_.tidy(q[j] / f[j]) * e.residual, c_.name(e) + c_.times(c_.tidy(q[j] / f[j])), 6);
    }
    for (Expr factor : e.constraint ? signs() : factors_of(e.residual))
      offer(P_ - factor * e.residual, c_.name(e) + c_.times(factor), e.constraint ? 6 : is_number(factor) ? 2 : 3);
  }

  // Offers the equations of motion projected on the directions that the constraints leave free.
  void offer_projections() {
    const Elimination& E = c_.elimination_;
    if (E.dependent.empty() || E.quasi) return;
    Column routh;
    for (const DerivedEquation& e : motion_.rows)
      if (!e.constraint && e.times == 0) routh.push_back(e.residual);
    if (routh.size() != c_.M_.q.size()) return;
    for (std::size_t nu = 0; nu < E.independent.size(); ++nu) {
      Column parts;
      for (std::size_t s = 0; s < routh.size(); ++s)
        if (!is_zero(E.g_by_u()[s][nu])) parts.push_back(E.g_by_u()[s][nu] * routh[s]);
      const Expr row = sum(parts);
      next_equation();
      for (Expr factor : factors_of(row)) {
        const std::string what = "the equation of " + c_.M_.model->coordinates[E.independent[nu]].name +
                                 " without multipliers" + c_.times(factor);
        offer(P_ - factor * row, what, 3);
        if (const Column on = motion_.reduced(P_ - factor * row); !on.empty())
          offer(on[0], what + ", on the constraints", 4);
      }
    }
  }

  void offer_combination(Comparer& comparer) {
    next_equation();
    std::vector<std::pair<std::size_t, Expr>> terms;
    const auto rest = comparer.combination(P_, motion_, terms);
    std::erase_if(terms, [](const auto& term) { return is_zero(term.second); });
    if (!rest || terms.empty()) return;
    std::string what;
    for (const auto& [i, c] : terms) what += (what.empty() ? "" : " and ") + c_.name(motion_.rows[i]) + c_.times(c);
    offer(*rest, what, 4);
    if (const Column on = motion_.reduced(*rest); !on.empty()) offer(on[0], what + ", on the constraints", 5);
  }

  void offer_identity() {
    identity_ = next_equation();
    if (c_.without_motion(P_, motion_)) offer(P_, kIdentity, 8);
  }

  // Takes the shortest in print of the best few.
  void take(Comparison& out) {
    std::stable_sort(offers_.begin(), offers_.end(),
                     [](const Offer& x, const Offer& y) { return x.length < y.length; });
    std::size_t shortest = SIZE_MAX;
    std::vector<std::size_t> seen;
    for (std::size_t k = 0; k < offers_.size() && seen.size() < kPrinted; ++k) {
      const Offer& o = offers_[k];
      if (std::find(seen.begin(), seen.end(), o.of) != seen.end() || (o.of != identity_ && !is_near(o))) continue;
      seen.push_back(o.of);
      const Expr difference = arranged(o.difference, c_.names_);
      const std::size_t length = o.weight * print(difference, c_.names_, Format::text).size();
      if (length < shortest) {
        shortest = length;
        out.difference = difference;
        out.what = o.what;
        out.identity = o.of == identity_;
      }
      if (number_of_nodes(o.difference) > kLongestCounted) break;
    }
  }

 private:
  struct Offer {
    // `of` is the number of the derived equation, in the order in which equations are offered.
    std::size_t length, weight, of;
    Expr difference;
    std::string what;
  };

  std::size_t next_equation() { return ++of_; }
  // True unless the difference is longer than P and than the offered equation.
  bool is_near(const Offer& o) {
    if (!length_) length_ = monomials(P_, c_.names_);
    return o.length <= o.weight * std::max(*length_, monomials(P_ - o.difference, c_.names_));
  }
  // Offers an equation. Weaker statements count as longer: a combination, a constraint beside an equation of motion.
  void offer(Expr difference, const std::string& what, std::size_t weight) {
    offers_.push_back({weight * monomials(difference, c_.names_), weight, of_, difference, what});
  }
  bool are_not_zero(Expr p, Expr f) const {
    return !is_zero(p) && !is_zero(f) && is_not_zero(f, point_) && is_not_zero(p, point_);
  }
  Column signs() const { return {g_.one(), -g_.one()}; }

  // Returns the factors of an equation that P may contain: ratios of derivatives.
  Column factors_of(Expr residual) const {
    Column factors = signs();
    const Column f = gradient(residual, by_);
    for (std::size_t j = 0; j < by_.size(); ++j) {
      if (!are_not_zero(p_by_[j], f[j])) continue;
      const auto constant = constant_ratio(p_by_[j], f[j], motion_.anywhere());
      const Expr factor = constant ? g_.number(*constant) : c_.tidy(p_by_[j] / f[j]);
      if (number_of_nodes(factor) > kLongestFactor) continue;
      if (std::find(factors.begin(), factors.end(), factor) == factors.end()) factors.push_back(factor);
    }
    return factors;
  }

  const Comparer& c_;
  Graph& g_;
  const Expr P_;
  EquationsOfMotion& motion_;
  PointValues& point_;
  Column by_, p_by_;  // the symbols by which factors are found, and dP/d of these
  std::vector<Offer> offers_;
  std::size_t of_ = 0, identity_ = 0;
  std::optional<std::size_t> length_;  // of P
};

void Comparer::nearest(Expr P, Comparison& out) {
  EquationsOfMotion& motion = this->motion(order_of_motion(P));
  // Numbers alone are near every equation that contains one.
  if (motion.anywhere().empty() || is_number(P)) return;
  Nearest nearest(*this, motion, P);
  for (const DerivedEquation& e : motion.lower) nearest.offer_derived(e);
  for (const DerivedEquation& e : motion.rows) nearest.offer_derived(e);
  nearest.offer_projections();
  nearest.offer_combination(*this);
  nearest.offer_identity();
  nearest.take(out);
}

}  // namespace anholon
