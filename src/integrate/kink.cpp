#include "integrate/kink.h"

#include <algorithm>

namespace anholon {

namespace {

template <Number N>
N value_at(const N* c, int degree, const N& x) {
  N s(0);
  for (int k = degree; k >= 0; --k) s = s * x + c[k];
  return s;
}

template <Number N>
N slope_at(const N* c, int degree, const N& x) {
  N s(0);
  for (int k = degree; k >= 1; --k) s = s * x + c[k] * N(k);
  return s;
}

}  // namespace

template <Number N>
Kink<N> first_kink(const Machine<N>& machine, int degree, const N& h) {
  constexpr int kSamples = 8, kHalvings = 80;
  constexpr double kTouches = 1e-8;  // a step may end anywhere: at a narrow miss, too
  const Tape& tape = machine.tape();
  Kink<N> first;
  for (std::uint32_t slot = 0; slot < tape.main_end; ++slot) {
    const Instruction& in = tape.code[slot];
    const bool jump = in.op == Op::function && (in.index == static_cast<std::uint32_t>(Function::abs) || in.index == static_cast<std::uint32_t>(Function::sign));
    const bool root = in.op == Op::power && tape.rationals[in.index].get_den() % 2 == 0;
    if ((!jump && !root) || tape.code[in.a].constant) continue;
    const N* c = machine.series(in.a);
    if (jump && !(c[0] > N(0)) && !(c[0] < N(0))) {
      first.at_start = first.at_start || std::any_of(c + 1, c + degree + 1, [](const N& x) { return x > N(0) || x < N(0); });
      continue;
    }
    const bool positive = jump ? c[0] > N(0) : c[1] > N(0);
    if (root && positive == (h > N(0))) continue;  // it grows
    const auto passed = [&](const N& x) {
      const N v = jump ? value_at(c, degree, x) : slope_at(c, degree, x);
      return positive ? !(v > N(0)) : !(v < N(0));
    };
    N low(0), high(0);
    bool found = false;
    for (int k = 1; k <= kSamples && !found; ++k) {
      low = high;
      high = h * N(k) / N(kSamples);
      found = passed(high);
    }
    for (int k = 0; found && k < kHalvings; ++k) {
      const N middle = (low + high) / N(2);
      if (middle == low || middle == high) break;
      (passed(middle) ? high : low) = middle;
    }
    if (!found || (root && value_at(c, degree, high) > c[0] * N(kTouches))) continue;
    if (!first.ahead || abs(high) < abs(first.where)) first.where = high;
    first.ahead = true;
  }
  return first;
}

template Kink<double> first_kink(const Machine<double>&, int, const double&);
template Kink<long double> first_kink(const Machine<long double>&, int, const long double&);
template Kink<Quad> first_kink(const Machine<Quad>&, int, const Quad&);
template Kink<Multi> first_kink(const Machine<Multi>&, int, const Multi&);

}  // namespace anholon
