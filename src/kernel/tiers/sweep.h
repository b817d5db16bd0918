// The arithmetic of a kernel over one lane type: expansions. Included by one file per instruction set (tier_*.cpp),
// which defines the lanes.
//
// Everything is in an unnamed namespace: each of those files has its own copy, compiled for its machine.
#pragma once
#include <algorithm>
#include <cmath>
#include <limits>

#include "kernel/tiers/sines.h"
#include "kernel/tiers/sweep_steps.h"

namespace anholon {
namespace {

template <int L>
class Sweep final : public SweepSteps<L> {
  using T = Lanes<L>;
  using V = typename T::V;
  using Steps = SweepSteps<L>;
  using Steps::abs, Steps::larger, Steps::smaller, Steps::k_, Steps::p_, Steps::w_;

 public:
  using Steps::Steps;

  void values(int from) override {
    for (int stage = from; stage <= 0; ++stage) run(p_.point, stage);
    for (const Partial& d : p_.partials) w_[d.out] = partial(d);
  }

  void factor() override {
    const SparseLu& e = *k_.elimination;
    V* lu = w_ + k_.lu;
    const V zero = T::broadcast(0);
    for (std::uint32_t i = 0; i < e.entries; ++i) lu[i] = zero;
    for (std::size_t i = 0; i < p_.entries.size(); ++i) {
      const Entry& entry = p_.entries[i];
      const V value = T::broadcast(entry.sign) * w_[entry.from];
      lu[e.place[i]] += value;
      if (k_.keeps_entries()) w_[k_.entries + i] = value;
    }
    V* reciprocal = w_ + k_.reciprocal;
    const V one = T::broadcast(1);
    for (std::size_t k = 0; k < e.pivots.size(); ++k) {
      const SparseLu::Pivot& p = e.pivots[k];
      if (!p.one) {
        const V r = p.minus_one ? -one : one / lu[p.entry];
        reciprocal[k] = r;
        for (std::uint32_t i = p.first_scaled; i < p.first_scaled + p.scaled; ++i) lu[e.scaled_entries[i]] *= r;
      }
      for (std::uint32_t i = p.first_update; i < p.first_update + p.updates; ++i) {
        const SparseLu::Update& u = e.update_list[i];
        lu[u.to] = T::fma(-lu[u.l], lu[u.u], lu[u.to]);
      }
    }
    if (!e.influences.empty()) invert();
  }

  void residual(int level) override {
    V* side = w_ + k_.side;
    for (std::size_t i = 0; i < p_.roots.size(); ++i) {
      const int order = p_.c[i] - level;
      const Place r = p_.roots[i];
      side[i] =
          order < 0 ? T::broadcast(0) : *at(r, static_cast<std::uint32_t>(order)) * T::broadcast(-k_.factorial[order]);
    }
    solve();
  }

  void judge() override {
    const V zero = T::broadcast(0);
    V health = T::broadcast(std::numeric_limits<double>::max()), determinant = T::broadcast(1), invalid = zero;
    const V* inverse = w_ + k_.inverse_pivots;
    for (const JudgedPivot& p : k_.judged) {
      const V ratio = w_[p.at] * *inverse++, size = abs(ratio);
      health = size < health ? size : health;
      determinant *= ratio;
      invalid += ratio - ratio;
    }
    w_[k_.found.health] = invalid == zero ? health : zero;  // NaN
    w_[k_.found.determinant] = determinant;
    w_[k_.found.drift] = w_[k_.found.moved] = zero;
  }

  bool displaced(int level) override {
    const V one = T::broadcast(1), zero = T::broadcast(0);
    V displacement = zero;
    for (const std::vector<std::uint32_t>& scale : p_.scales) {
      V size = one, most = zero;
      for (const std::uint32_t j : scale) {
        const int k = p_.d[j] - level;
        if (k < 0) continue;
        size = larger(size, abs(w_[p_.x[j] + static_cast<std::uint32_t>(k)]) *
                                T::broadcast(k_.factorial[static_cast<std::size_t>(k)]));
        most = larger(most, abs(w_[k_.solution + j]));
      }
      const V here = most / size;
      displacement = here <= displacement ? displacement : here;
    }
    V& drift = w_[k_.found.drift];
    drift = displacement <= drift ? drift : displacement;
    const auto moves = displacement > T::broadcast(kQuiet);
    w_[k_.found.weight] = moves ? one : zero;
    w_[k_.found.moved] = moves ? one : w_[k_.found.moved];
    return T::any(moves);
  }

  void correct(int level) override {
    const V* y = w_ + k_.solution;
    const V use = w_[k_.found.weight];
    for (std::size_t j = 0; j < p_.x.size(); ++j)
      if (const int order = p_.d[j] - level; order >= 0) {
        V& x = w_[p_.x[j] + static_cast<std::uint32_t>(order)];
        x = T::fma(y[j] * use, T::broadcast(k_.inverse_factorial[order]), x);
      }
  }

  void complete(int stage) override {
    const V* y = w_ + k_.solution;
    for (std::size_t j = 0; j < p_.x.size(); ++j) {
      const std::uint32_t order = static_cast<std::uint32_t>(stage + p_.d[j]);
      V& x = w_[p_.x[j] + order];
      const V change = p_.d[j] > 0 ? over(y[j], k_.rising_, k_.rising_at(p_.d[j], stage)) : y[j];
      x = stage > 0 ? change : x + change;
    }
    for (const Completion& c : p_.completions) {
      V& w = w_[c.out.at + static_cast<std::uint32_t>(stage + c.lead)];
      V change = y[c.column];
      if (c.lead > 0) change = over(change, k_.rising_, k_.rising_at(c.lead, stage));
      w = stage > 0 && c.fresh ? change : w + change;
    }
    run(p_.weigh_again, stage);
  }

  void extend() override {
    V* side = w_ + k_.side;
    for (int stage = 1; stage <= p_.stages; ++stage) {
      run(p_.stage, stage);
      for (std::size_t i = 0; i < p_.roots.size(); ++i) {
        const Place r = p_.roots[i];
        const int order = stage + p_.c[i];
        side[i] = p_.root_is_zero[i]
                      ? T::broadcast(0)
                      : *at(r, static_cast<std::uint32_t>(order)) * T::broadcast(-k_.rising(p_.c[i], stage));
      }
      solve();
      complete(stage);
    }
    if (!p_.after.empty())
      for (int stage = 0; stage <= p_.stages; ++stage) run(p_.after, stage);
  }

  void quadratures() override { run(p_.after, 0); }

 private:
  V* at(const Place& place, std::uint32_t order) { return w_ + place.at + (place.series ? order : 0); }

  static V over(V x, const KernelTables::Divisors& d, std::size_t i) {
    return quotient<T>(x, d.number[i], d.reciprocal[i], d.beyond[i]);
  }

  // Sum of a_j b_(p-j), j = 1..p - 1. Orders are computed in blocks of four: products of coefficients from before the
  // block come first (so that another tier can compute them for four orders at once), then those with new coefficients
  // of b, then of a. In each part the newest comes last.
  V history(const V* a, const V* b, std::int64_t p) const {
    const std::int64_t known = block_ < p ? block_ : p, i = p - known, few = known < kBlock ? known : kBlock;
    V s = T::broadcast(0), t = s;
    for (std::int64_t j = kBlock; j < known; ++j) s = T::fma(a[j], b[p - j], s);
    for (std::int64_t j = few - 1; j > i; --j) s = T::fma(a[j], b[p - j], s);
    for (std::int64_t j = i < known ? i : known - 1; j >= 1; --j) s = T::fma(a[j], b[p - j], s);
    for (std::int64_t j = known > 1 ? known : 1; j < p; ++j) t = T::fma(a[j], b[p - j], t);
    return s + t;
  }

  // Like history(), for j = first..last; first is 0 or 1, last p or p - 1.
  V convolution(const V* a, const V* b, std::int64_t p, bool first, bool last, bool b_later = false) const {
    V s = history(a, b, p);
    if (first && !b_later) s = T::fma(a[0], b[p], s);
    if (last) s = T::fma(a[p], b[0], s);
    if (first && b_later) s = T::fma(a[0], b[p], s);
    return s;
  }

  template <class F>
  static V each(V v, F f) {
    V r;
    for (int lane = 0; lane < L; ++lane) T::set(r, lane, f(T::get(v, lane)));
    return r;
  }

  V partial(const Partial& d) {
    using K = Partial::Kind;
    const V a = w_[d.a], one = T::broadcast(1);
    switch (d.kind) {
    case K::twice:
      return a + a;
    case K::half_reciprocal:
      return T::broadcast(0.5) / a;
    case K::quotient:
      return a * w_[d.b];
    case K::chosen:
      return each(a, [](double x) { return x < 0 ? 0.0 : 1.0; });
    case K::not_chosen:
      return each(a, [](double x) { return x < 0 ? 1.0 : 0.0; });
    }
    return one;
  }

  void run(const std::vector<Step>& steps, int stage) {
    for (const Step& s : steps)
      if (const int p = stage + s.lead; p >= 0) {
        block_ = stage > 0 ? (stage - 1) / kBlock * kBlock + 1 + s.lead : 0;
        if (p == 0)
          value(s);
        else
          coefficient(s, static_cast<std::uint32_t>(p));
      }
  }

  void value(const Step& s) {
    V& out = w_[s.out.at];
    const V a = w_[s.a.at];
    switch (s.act) {
    case Act::input:
      out = w_[s.a.at + s.index] * T::broadcast(k_.factorial[s.index]);
      break;
    case Act::linear:
      out = sum(s, 0, s.count + s.constants);
      break;
    case Act::beyond:
      out = beyond_of_sum(s);
      break;
    case Act::multiply:
      out = a * w_[s.b.at];
      break;
    case Act::square:
      out = a * a;
      break;
    case Act::divide: {
      const V r = T::broadcast(1) / w_[s.b.at];
      w_[s.c.at] = r;
      out = a * r;
      break;
    }
    case Act::square_root:
      out = each(a, [](double x) { return std::sqrt(x); });
      break;
    case Act::power:
      out = each(a, [&](double x) { return power_of(x, s.value); });
      w_[s.b.at] = T::broadcast(1) / a;
      w_[s.d.at] = T::broadcast(0);
      w_[s.e.at] = T::broadcast(s.value) * out * w_[s.b.at];
      break;
    case Act::sine_cosine:
      Sines<L>::of(a, s.d.at != 0 ? w_[s.d.at] : T::broadcast(0), out, w_[s.c.at]);
      break;
    case Act::function:
      out = each(a, [&](double x) { return function_of(s.index, x); });
      break;
    case Act::arctan2:
      for (int lane = 0; lane < L; ++lane) T::set(out, lane, std::atan2(T::get(a, lane), T::get(w_[s.b.at], lane)));
      break;
    case Act::weigh:
      out = T::broadcast(0);
      break;
    case Act::select:
      out = chosen(s, 0);
      break;
    case Act::lookup:
      out = each(a, [&](double x) { return k_.lookup(s.index, x); });
      break;
    }
  }

  V sum(const Step& s, std::uint32_t p, std::uint32_t count) {
    const PlanTerm* term = &p_.terms[s.first];
    V r = T::broadcast(0);
    for (std::uint32_t k = 0; k < count; ++k)
      r = T::fma(w_[term[k].coefficient], k < s.count ? *at(term[k].x, p) : T::broadcast(1), r);
    return r;
  }

  // Sums the rounding errors of each product and each addition.
  V beyond_of_sum(const Step& s) {
    const PlanTerm *term = &p_.terms[s.first], *low = &p_.terms[s.index];
    V r = T::broadcast(0), beyond = r;
    for (std::uint32_t k = 0; k < s.count + s.constants; ++k) {
      const V c = w_[term[k].coefficient], x = k < s.count ? *at(term[k].x, 0) : T::broadcast(1);
      const V product = c * x, sum = product + r, part = sum - product, rounded = T::fma(c, x, r);
      beyond += ((sum - rounded) + ((product - (sum - part)) + (r - part))) + T::fma(c, x, -product);
      if (k < s.count && low[k].x.at != 0) beyond = T::fma(c, w_[low[k].x.at], beyond);
      r = rounded;
    }
    return beyond;
  }

  V chosen(const Step& s, std::uint32_t p) {
    V r;
    for (int lane = 0; lane < L; ++lane) {
      const bool first = !(T::get(w_[s.c.at], lane) < 0), none = p > 0 && (first ? s.a_constant : s.b_constant);
      T::set(r, lane, none ? 0.0 : T::get(*at(first ? s.a : s.b, p), lane));
    }
    return r;
  }

  // u_0 w_p = (r sum (j u_j) w_(p-j) - sum (j w_j) u_(p-j)) / p + r u_p w_0, j = 1..p - 1
  void coefficient_of_power(const Step& s, std::uint32_t p) {
    V* const a = w_ + s.a.at;
    V* const w = w_ + s.out.at;
    V& out = *at(s.out, p);
    const std::int64_t n = p;
    const bool newest = !s.a_unknown;
    V* const c = w_ + s.c.at;
    V* const d = w_ + s.d.at;
    const V older = over(T::fma(T::broadcast(s.value), history(c, w, n), -history(d, a, n)), k_.order, p) * w_[s.b.at];
    out = newest ? T::fma(a[p], w_[s.e.at], older) : older;
    d[p] = out * T::broadcast(static_cast<double>(n));
  }

  void coefficient_of_sine_cosine(const Step& s, std::uint32_t p) {
    V* const a = w_ + s.a.at;
    V* const b = w_ + s.b.at;
    V* const w = w_ + s.out.at;
    const std::int64_t n = p;
    const bool newest = !s.a_unknown;
    V* const c = w_ + s.c.at;
    V sine = over(history(b, c, n), k_.order, p), cosine = over(history(b, w, n), k_.order, p);
    if (newest) {
      sine = T::fma(a[p], c[0], sine);
      cosine = T::fma(a[p], w[0], cosine);
    }
    w[p] = sine;
    c[p] = -cosine;
  }

  // w' = f'(u) u'
  void coefficient_of_function(const Step& s, std::uint32_t p) {
    V* const a = w_ + s.a.at;
    V* const b = w_ + s.b.at;
    V& out = *at(s.out, p);
    const std::int64_t n = p;
    const bool newest = !s.a_unknown;
    V* const c = w_ + s.c.at;
    if (s.b_constant) {
      out = s.a_unknown ? T::broadcast(0) : V(b[0] * a[p]);
    } else {
      const V older = over(history(c, b, n), k_.order, p);
      out = newest ? T::fma(a[p], b[0], older) : older;
    }
  }

  void coefficient_of_arctan2(const Step& s, std::uint32_t p) {
    V* const a = w_ + s.a.at;
    V* const b = w_ + s.b.at;
    V& out = *at(s.out, p);
    const std::int64_t n = p;
    const bool newest = !s.a_unknown, newest_b = !s.b_unknown;
    V* const c = w_ + s.c.at;
    V* const d = w_ + s.d.at;
    V r = T::broadcast(0);
    if (!s.a_constant) r += history(w_ + s.e.at, c, n);
    if (!s.b_constant) r += history(w_ + s.f.at, d, n);
    r = over(r, k_.order, p);
    if (!s.a_constant && newest) r = T::fma(a[p], c[0], r);
    if (!s.b_constant && newest_b) r = T::fma(b[p], d[0], r);
    out = r;
  }

  void coefficient(const Step& s, std::uint32_t p) {
    V* const a = w_ + s.a.at;
    V* const b = w_ + s.b.at;
    V* const w = w_ + s.out.at;
    V& out = *at(s.out, p);
    const std::int64_t n = p;
    const bool newest = !s.a_unknown, newest_b = !s.b_unknown;
    switch (s.act) {
    case Act::input:
      out = a[p + s.index] * T::broadcast(k_.rising(static_cast<int>(s.index), static_cast<int>(p)));
      break;
    case Act::linear:
      out = sum(s, p, s.count);
      break;
    case Act::beyond:
      break;
    case Act::multiply:
      out = convolution(a, b, n, newest_b, newest, s.b_later);
      break;
    case Act::square:
      out = convolution(a, a, n, newest, newest);
      break;
    case Act::divide: {
      V r = -convolution(b, w, n, false, newest_b);
      if (!s.a_constant && !s.a_unknown) r += *at(s.a, p);
      out = r * w_[s.c.at];
      break;
    }
    case Act::square_root: {
      V r = -convolution(w, w, n, false, false);
      if (!s.a_unknown) r += *at(s.a, p);
      out = r * (T::broadcast(0.5) / w[0]);
      break;
    }
    case Act::power:
      coefficient_of_power(s, p);
      break;
    case Act::sine_cosine:
      coefficient_of_sine_cosine(s, p);
      break;
    case Act::function:
      coefficient_of_function(s, p);
      break;
    case Act::arctan2:
      coefficient_of_arctan2(s, p);
      break;
    case Act::weigh:
      out = *at(s.a, p) * T::broadcast(static_cast<double>(n));
      break;
    case Act::select:
      out = chosen(s, p);
      break;
    case Act::lookup:
      out = T::broadcast(0);
      break;
    }
  }

  // Solves for the right sides in `side`; with `refine` again for the remaining residual. The residual is that of the
  // linearized tape, not of J: if J is nearly singular, the tape still contains the small difference of two rates whose
  // squares J has rounded away.
  void solve() {
    V* const side = w_ + k_.side;
    V* const rhs = w_ + k_.rhs;
    V* const y = w_ + k_.solution;
    const std::size_t n = p_.roots.size();
    if (const SparseLu& e = *k_.elimination; !e.influences.empty()) {
      std::fill(y, y + p_.rows, T::broadcast(0));
      const V* influence = w_ + k_.inverse;
      for (const SparseLu::Influence& of : e.influences) {
        y[of.column] = of.sign == 0  ? T::fma(*influence, side[of.side], y[of.column])
                       : of.sign > 0 ? side[of.side]
                                     : -side[of.side];
        ++influence;
      }
      const V* entries = w_ + k_.entries;
      for (const SparseLu::Own& own : e.own)
        for (std::uint32_t i = own.first; i < own.first + own.count; ++i)
          y[own.column] = T::fma(-entries[e.own_terms[i].entry], y[e.own_terms[i].column], y[own.column]);
      return;
    }
    std::copy(side, side + n, rhs);
    std::fill(rhs + n, rhs + p_.rows, T::broadcast(0));
    substitute(y);
    if (!k_.refine) return;
    const V* entries = w_ + k_.entries;
    std::copy(side, side + n, rhs);
    std::fill(rhs + n, rhs + p_.rows, T::broadcast(0));
    for (std::size_t i = 0; i < p_.entries.size(); ++i)
      rhs[p_.entries[i].row] = T::fma(-entries[i], y[p_.entries[i].column], rhs[p_.entries[i].row]);
    V* const change = w_ + k_.refined;
    substitute(change, true);
    for (std::uint32_t i = 0; i < p_.rows; ++i) y[i] += change[i];
  }

  // Solves for unit sides.
  void invert() {
    V* const rhs = w_ + k_.rhs;
    V* const y = w_ + k_.solution;
    V* const inverse = w_ + k_.inverse;
    const std::vector<SparseLu::Influence>& influences = k_.elimination->influences;
    for (const std::uint32_t side : p_.sides) {
      std::fill(rhs, rhs + p_.rows, T::broadcast(0));
      rhs[side] = T::broadcast(1);
      substitute(y);
      for (std::size_t i = 0; i < influences.size(); ++i)
        if (influences[i].side == side) inverse[i] = y[influences[i].column];
    }
  }

  void substitute(V* y, bool all_sides = false) {
    const SparseLu& e = *k_.elimination;
    const V* lu = w_ + k_.lu;
    const V* reciprocal = w_ + k_.reciprocal;
    V* rhs = w_ + k_.rhs;
    const V zero = T::broadcast(0);
    for (const SparseLu::Forward& f : all_sides ? e.forward_all : e.forward)
      rhs[f.to] = T::fma(-lu[f.entry], rhs[f.from], rhs[f.to]);
    for (const SparseLu::Backward& b : e.backward) {
      V s = b.zero_side && !all_sides ? zero : rhs[b.row];
      for (std::uint32_t i = b.first; i < b.first + b.count; ++i)
        s = T::fma(-lu[e.terms[i].entry], y[e.terms[i].column], s);
      y[b.column] = e.pivots[b.pivot].one ? s : s * reciprocal[b.pivot];
    }
  }

  std::int64_t block_ = 0;  // coefficients below this order are older than the present block
};

}  // namespace
}  // namespace anholon
