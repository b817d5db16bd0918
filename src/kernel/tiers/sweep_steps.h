// The arithmetic of a kernel over one lane type for a step: its reach, and the state at its end.
#pragma once
#include <algorithm>

#include "kernel/arithmetic.h"
#include "kernel/tiers/lanes.h"

namespace anholon {
namespace {

template <int L>
class SweepSteps : public Arithmetic {
  using T = Lanes<L>;
  using V = typename T::V;
  using B = typename T::B;

 public:
  SweepSteps(const KernelTables& tables, double* arena)
      : k_(tables), p_(*tables.plan), w_(reinterpret_cast<V*>(arena)) {}

  // Sums every fourth term, from the highest on, so that no term waits for a power, and other code can compute four
  // orders as one vector.
  void advance() override {
    weigh();
    V* out = w_ + k_.increments;
    for (std::size_t j = 0; j < p_.x.size(); ++j) {
      const V* x = w_ + p_.x[j];
      for (int k = 0; k <= p_.d[j]; ++k) {
        const V* weight = w_ + k_.weight(k, 0);
        V s[kBlock];
        std::fill(s, s + kBlock, T::broadcast(0));
        for (int i = p_.stages + p_.d[j] - k; i >= 1; --i)
          s[(i - 1) % kBlock] = T::fma(x[k + i], weight[i], s[(i - 1) % kBlock]);
        *out++ = s[0] + (s[1] + (s[2] + s[3]));
      }
    }
  }

  void begin(const double* from) override {
    const V *high = reinterpret_cast<const V*>(from), *guess = high + 2 * k_.state_size;
    for (std::size_t j = 0; j < p_.x.size(); ++j) {
      V* x = w_ + p_.x[j];
      const int d = p_.d[j];
      for (int k = 0; k < d; ++k) x[k] = coefficient_of(*high++, k);
      x[d] = coefficient_of(guess[j], d);
    }
    const V* low = reinterpret_cast<const V*>(from) + k_.state_size;
    for (const Beyond& b : p_.beyond_double) w_[b.at] = low[b.index];
  }

  void adopt(const double* from) override {
    const auto moved = w_[k_.found.moved] > T::broadcast(0);
    const V* high = reinterpret_cast<const V*>(from);
    V* to = w_ + k_.projected;
    std::copy_n(high + k_.state_size, k_.state_size, to + k_.state_size);
    for (std::size_t j = 0; j < p_.x.size(); ++j)
      for (int k = 0; k < p_.d[j]; ++k, ++high)
        *to++ = moved ? V(w_[p_.x[j] + static_cast<std::uint32_t>(k)] *
                          T::broadcast(k_.factorial[static_cast<std::size_t>(k)]))
                      : *high;
  }

  // The newest coefficients come last: only their own division and logarithm wait for them.
  void measure() override {
    const int order = p_.stages + 1;
    const V zero = T::broadcast(0), one = T::broadcast(1);
    V last = zero, before_last = zero, pole = zero, unfit = zero;
    for (const std::vector<std::uint32_t>& scale : p_.scales) {
      double factor = 1, factor_before = 1;
      for (int k = 0; k < p_.largest_d; ++k) {
        if (k > 0) factor *= order + k, factor_before *= order - 1 + k;
        V size = one, l = zero, b = zero;
        for (const std::uint32_t j : scale) {
          if (k >= p_.d[j]) continue;
          const V* x = w_ + p_.x[j] + k;
          size = larger(size, abs(x[0]) * T::broadcast(k_.factorial[static_cast<std::size_t>(k)]));
          l = larger(l, abs(x[order]));
          b = larger(b, abs(x[order - 1]));
        }
        const V weight = T::broadcast(factor) / size;
        last = larger(last, l * weight);
        before_last = larger(before_last, b * (weight * T::broadcast(factor_before / factor)));
      }
    }
    bool poles = false;
    for (std::size_t j = 0; j < p_.x.size(); ++j) {
      const V* x = w_ + p_.x[j];
      const V top = x[p_.stages + p_.d[j]];
      unfit += top - top;
      if (p_.d[j] > 0) continue;
      const V value = abs(x[0]), relative = abs(top) * (one / larger(one, value));
      pole = value > zero ? larger(pole, relative) : pole;
      poles = true;
    }
    V most = smaller(reach(before_last, order - 1, w_[k_.margin]), T::broadcast(kFarthest));
    if (poles) most = smaller(most, reach(pole, order - 1, T::broadcast(-0.7 * kLog2e)));
    w_[k_.found.reach] = exp2(smaller(most, reach(last, order, w_[k_.margin])));
    w_[k_.found.unfit] = unfit;
  }

  // The bound is a sum of absolute terms; four partial sums do not wait for one another.
  void look_for_hidden() override {
    const V length = abs(w_[k_.step]), square = length * length, fourth = square * square, zero = T::broadcast(0);
    V worst = zero;
    for (const Plan::HidingSeries& slot : p_.hiding) {
      const V* a = w_ + slot.argument.at;
      V s[kBlock] = {zero, zero, zero, zero};
      for (int k = p_.stages / kBlock * kBlock; k >= 0; k -= kBlock)
        for (int i = 0; i < kBlock; ++i) {
          const bool is_term = k + i > 0 && k + i <= p_.stages;
          s[i] = T::fma(s[i], fourth, is_term ? abs(a[k + i]) : zero);
        }
      const V change = (s[0] + s[1] * length) + (s[2] + s[3] * length) * square;
      const V most =
          T::broadcast(slot.function.hides_beyond()) * (slot.function.function ? T::broadcast(1) : abs(a[0]));
      const V relative = change / most;
      worst = larger(worst, relative) + (relative - relative);
    }
    w_[k_.found.hidden] = worst;
  }

  void go_on(const double* base, double* next) override {
    const std::size_t n = k_.state_size;
    const V *high = reinterpret_cast<const V*>(base), *low = high + n, *change = w_ + k_.increments;
    V *to = reinterpret_cast<V*>(next), *guess = to + 2 * n;
    const V step = w_[k_.step], zero = T::broadcast(0);
    V largest = zero, invalid = zero;
    for (std::size_t j = 0; j < p_.x.size(); ++j) {
      const V* x = w_ + p_.x[j];
      const int d = p_.d[j];
      for (int k = 0; k < d; ++k, ++to) {
        // This sum contains the change of the state by projection, which the series do not contain.
        V s = low[k] + *change++, power = step;
        for (int i = k + 1; i < d; ++i) {
          s = T::fma(high[i] - x[i] * T::broadcast(k_.factorial[static_cast<std::size_t>(i)]) + low[i], power, s);
          if (i + 1 < d) power *= step * T::broadcast(k_.order.reciprocal[static_cast<std::size_t>(i - k + 1)]);
        }
        const V sum = high[k] + s, part = sum - high[k], error = (high[k] - (sum - part)) + (s - part);
        to[0] = sum;
        to[n] = rest(sum, error);
        largest = larger(largest, abs(sum));
        invalid += sum - sum;
      }
      guess[j] = x[d] * T::broadcast(k_.factorial[static_cast<std::size_t>(d)]) + *change++;
      high += d, low += d;
    }
    w_[k_.found.largest] = largest + invalid;
  }

  void compare(const double* from) override {
    const V* guess = reinterpret_cast<const V*>(from) + 2 * k_.state_size;
    V worst = T::broadcast(0);
    for (int d = 1; d <= p_.largest_d; ++d) {
      V size = T::broadcast(1), most = T::broadcast(0), invalid = most;
      bool any = false;
      for (std::size_t j = 0; j < p_.x.size(); ++j) {
        if (p_.d[j] < d) continue;
        const V* x = w_ + p_.x[j];
        size = larger(size, abs(x[d - 1] * T::broadcast(k_.factorial[static_cast<std::size_t>(d - 1)])));
        if (p_.d[j] > d) continue;
        const V change = x[d] * T::broadcast(k_.factorial[static_cast<std::size_t>(d)]) - guess[j];
        most = larger(most, abs(change));
        invalid += change - change;
        any = true;
      }
      if (any) worst = larger(worst, most / size) + invalid;
    }
    w_[k_.found.defect] = worst;
  }

 protected:
  static V abs(V v) { return T::of(T::bits(v) & 0x7fffffffffffffffULL); }
  static V larger(V a, V b) { return a < b ? b : a; }
  static V smaller(V a, V b) { return b < a ? b : a; }

  const KernelTables& k_;
  const Plan& p_;
  V* w_;

 private:
  // The coefficient of order k from a derivative. Up to 2! the product is exact.
  V coefficient_of(V derivative, int k) const {
    const auto i = static_cast<std::size_t>(k);
    return k <= 2 ? V(derivative * T::broadcast(k_.inverse_factorial[i]))
                  : V(derivative / T::broadcast(k_.factorial[i]));
  }

  void weigh() {
    const V h = w_[k_.step], square = h * h;
    V* power = w_ + k_.weight(0, 0);
    const int most = p_.stages + p_.largest_d;
    power[1] = h;
    for (int i = 2; i <= most; ++i)
      power[i] = i == 2        ? square
                 : i == 3      ? V(square * h)
                 : i == kBlock ? V(square * square)
                               : V(power[i - kBlock] * power[kBlock]);
    for (int k = 1; k <= p_.largest_d; ++k)
      for (int i = 1; i <= most - k; ++i) w_[k_.weight(k, i)] = power[i] * T::broadcast(k_.rising(k, i));
  }

  // The error of a sum, rounded to the digits that a long double keeps of sum and error.
  static V rest(V sum, V error) {
    const V grid = T::of(T::bits(sum) & 0x7ff0000000000000ULL) * T::broadcast(1.5 * 0x1p-11);
    return (error + grid) - grid;
  }

  // c_0 + c_1 x
  static V line(const double* c, V x) { return T::fma(T::broadcast(c[1]), x, T::broadcast(c[0])); }

  static V cubic(const double* c, V x) { return T::fma(line(c + 2, x), x * x, line(c, x)); }

  // log2(weight^(-1 / by)) + margin
  static V reach(V weight, int by, V margin) {
    const B exponent = T::exponent(T::bits(weight) - kRootOfHalf);
    const V u = T::of(T::bits(weight) - (exponent << 52)) - T::broadcast(1), each = T::broadcast(-1.0 / by);
    const V whole = T::fma(T::of(exponent + T::bits(T::broadcast(kInteger))) - T::broadcast(kInteger), each, margin);
    return weight > T::broadcast(0) ? T::fma(cubic(kLog2, u), u * each, whole) : T::broadcast(kFarthest);
  }

  // Requires |x| < 1000.
  static V exp2(V x) {
    const V n = x + T::broadcast(kInteger), f = x - (n - T::broadcast(kInteger));
    return T::of(T::bits(cubic(kExp2, f)) + ((T::bits(n) - T::bits(T::broadcast(kInteger))) << 52));
  }
};

}  // namespace
}  // namespace anholon
