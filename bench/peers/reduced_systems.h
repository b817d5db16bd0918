// The systems of the speed table with right-hand sides reduced and written by hand, O(n) in the links of a chain and in
// the trailers:
//   sleigh    x, y, th, v (along the blade), w
//   disc      x, y, psi, theta, phi and the angular velocities w1 (lean), w2, w3 (axle) along lean.x, lean.y, lean.z
//   trailers  x, y, ph, th[0..n], p = v sqrt(I) with 2T = I v^2 + Jp s^2, s = th[0]' + ph': then p' = (drive - tan(ph) steer/L)/sqrt(I)
//   chain     th, w; the tensions of the rods from their tridiagonal equations (acceleration along a rod = -l w^2), then w'
#pragma once
#include <array>
#include <cmath>
#include <cstddef>

#include <quadmath.h>

namespace peers {

using Quad = __float128;
using std::cos;
using std::sin;
using std::sqrt;
Quad sin(Quad x) { return sinq(x); }
Quad cos(Quad x) { return cosq(x); }
Quad sqrt(Quad x) { return sqrtq(x); }

template <class N, std::size_t size>
using Vec = std::array<N, size>;

// Reduced states; from positions and velocities, coordinate by coordinate, and back.
template <class N, std::size_t>
struct Sleigh {
  using State = Vec<N, 5>;
  using Given = Vec<N, 6>;
  static constexpr N m = 2, a = N(1) / 2, J = N(1) / 2;
  State reduce(const Given& g) const { return {g[0], g[2], g[4], g[1] * cos(g[4]) + g[3] * sin(g[4]), g[5]}; }
  Given expand(const State& x) const { return {x[0], x[3] * cos(x[2]), x[1], x[3] * sin(x[2]), x[2], x[4]}; }
  void operator()(const State& x, State& d, const N&) const {
    constexpr N k = m * a / (J + m * a * a);
    d[0] = x[3] * cos(x[2]);
    d[1] = x[3] * sin(x[2]);
    d[2] = x[4];
    d[3] = a * (x[4] * x[4]);
    d[4] = -k * (x[3] * x[4]);
  }
};

template <class N, std::size_t>
struct Disc {
  using State = Vec<N, 8>;
  using Given = Vec<N, 10>;
  static constexpr N R = N(1) / 2, g = N(157) / 16;  // moments of inertia m R^2/4 and m R^2/2
  State reduce(const Given& q) const {
    const N c = cos(q[6]), s = sin(q[6]);
    return {q[0], q[2], q[4], q[6], q[8], q[7], q[5] * s, q[5] * c + q[9]};
  }
  Given expand(const State& x) const {
    const N c = cos(x[3]), s = sin(x[3]), turn = x[6] / s, spin = x[7] - turn * c;
    return {x[0], -R * spin * cos(x[2]), x[1], -R * spin * sin(x[2]), x[2], turn, x[3], x[5], x[4], spin};
  }
  void operator()(const State& x, State& d, const N&) const {
    const N c = cos(x[3]), s = sin(x[3]), w1 = x[5], w2 = x[6], w3 = x[7];
    const N turn = w2 / s, axle = turn * c, spin = w3 - axle;
    d[0] = -R * (spin * cos(x[2]));
    d[1] = -R * (spin * sin(x[2]));
    d[2] = turn;
    d[3] = w1;
    d[4] = spin;
    d[5] = w2 * (N(1) / 5 * axle - N(6) / 5 * w3) - (4 * g / (5 * R)) * c;
    d[6] = w1 * (2 * w3 - axle);
    d[7] = w1 * w2 * (N(2) / 3);
  }
};

template <class N, std::size_t n>
struct Trailers {
  using State = Vec<N, n + 6>;
  using Given = Vec<N, 2 * (n + 4)>;
  static constexpr N M0 = 10, J0 = 2, Jp = N(1) / 8, L = 1, M = 3, J = N(3) / 4, d = N(7) / 8, drive = 5;
  using Bends = Vec<N, n + 1>;
  // 1/sqrt of the inertia of the whole train by the speed of the car; cosines and sines of the
  // angles at the hitches.
  N root(const State& x, const N& t, Bends& c, Bends& s) const {
    for (std::size_t i = 1; i <= n; ++i) {
      const N bend = x[2 + i] - x[3 + i];
      c[i] = cos(bend);
      s[i] = sin(bend);
    }
    N behind(0);
    for (std::size_t i = n; i >= 1; --i) behind = J / (d * d) + c[i] * c[i] * (M - J / (d * d) + behind);
    return 1 / sqrt(M0 + J0 * t * t + behind);
  }
  State reduce(const Given& g) const {
    constexpr std::size_t at = n + 4;
    State x;
    Bends c, s;
    x[0] = g[0], x[1] = g[2], x[2] = g[4];
    for (std::size_t i = 0; i <= n; ++i) x[3 + i] = g[6 + 2 * i];
    const N v = g[1] * cos(x[3]) + g[3] * sin(x[3]);
    x[at] = v / root(x, sin(x[2]) / cos(x[2]) / L, c, s);
    x[at + 1] = g[7] + g[5];
    return x;
  }
  Given expand(const State& x) const {
    State rate;
    Given g;
    (*this)(x, rate, N(0));  // t enters accelerations only
    for (std::size_t i = 0; i < n + 4; ++i) g[2 * i] = x[i], g[2 * i + 1] = rate[i];
    return g;
  }
  void operator()(const State& x, State& rate, const N& time) const {
    constexpr std::size_t at = n + 4;
    Bends c, s;
    const N t = sin(x[2]) / cos(x[2]) / L, r = root(x, t, c, s), v = x[at] * r, turn = v * t, w = x[at + 1] - turn;
    const N steer = -2 * x[2] + sin(time) - w / 2;
    rate[0] = v * cos(x[3]);
    rate[1] = v * sin(x[3]);
    rate[2] = w;
    rate[3] = turn;
    N speed = v;
    for (std::size_t i = 1; i <= n; ++i) {
      rate[3 + i] = speed * s[i] * (1 / d);
      speed *= c[i];
    }
    rate[at] = (drive - t * steer) * r;
    rate[at + 1] = steer * (1 / Jp);
  }
};

template <class N, std::size_t n>
struct Chain {
  using State = Vec<N, 2 * n>;
  using Given = Vec<N, 2 * n>;
  static constexpr N l = N(1) / 4, g = N(157) / 16;
  State reduce(const Given& given) const {
    State x;
    for (std::size_t i = 0; i < n; ++i) x[i] = given[2 * i], x[n + i] = given[2 * i + 1];
    return x;
  }
  Given expand(const State& x) const {
    Given given;
    for (std::size_t i = 0; i < n; ++i) given[2 * i] = x[i], given[2 * i + 1] = x[n + i];
    return given;
  }
  void operator()(const State& x, State& d, const N&) const {
    Vec<N, n + 1> c, s, q, r, tension;  // tensions over m l
    const N* th = x.data();
    const N* w = th + n;
    const N s0 = sin(th[0]), c0 = cos(th[0]);
    for (std::size_t i = 1; i < n; ++i) c[i] = cos(th[i] - th[i - 1]);
    for (std::size_t i = 1; i < n; ++i) s[i] = sin(th[i] - th[i - 1]);
    // T_0 - c_1 T_1 = w_0^2 + g cos(th_0)/l;  2 T_i - c_i T_(i-1) - c_(i+1) T_(i+1) = w_i^2.
    // Eliminated from both ends at once, which halves the chain of divisions that wait for each
    // other.
    constexpr std::size_t middle = n / 2;
    N pivot = 1, pivot_back = 2;
    r[0] = w[0] * w[0] + (g / l) * c0;
    r[n - 1] = w[n - 1] * w[n - 1];
    c[n] = 0;
    for (std::size_t i = 1, j = n - 1; j > middle; ++i, --j) {
      q[j] = 1 / pivot_back;
      const N share_back = c[j] * q[j];
      pivot_back = 2 - c[j] * share_back;
      r[j - 1] = w[j - 1] * w[j - 1] + share_back * r[j];
      if (i < middle) {
        q[i - 1] = 1 / pivot;
        const N share = c[i] * q[i - 1];
        pivot = 2 - c[i] * share;
        r[i] = w[i] * w[i] + share * r[i - 1];
      }
    }
    q[middle - 1] = 1 / pivot;
    const N share = c[middle] * q[middle - 1];
    tension[middle] = (r[middle] + share * r[middle - 1]) / (pivot_back - c[middle] * share);
    for (std::size_t i = middle, j = middle + 1; i-- > 0; ++j) {
      tension[i] = (r[i] + c[i + 1] * tension[i + 1]) * q[i];
      if (j < n) tension[j] = (r[j] + c[j] * tension[j - 1]) * q[j];
    }
    for (std::size_t i = 0; i < n; ++i) d[i] = w[i];
    s[n] = 0;
    d[n] = s[1] * tension[1] - (g / l) * s0;
    for (std::size_t i = 1; i < n; ++i) d[n + i] = s[i + 1] * tension[i + 1] - s[i] * tension[i - 1];
  }
};

}  // namespace peers
