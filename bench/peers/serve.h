// An integrator on the systems of the speed table; in __float128 also the check of the reference.
//
//   PROGRAM SYSTEM N END     (N = 1 where there is none) then one position or velocity per line of standard input, 36 digits each, coordinate by
//                            coordinate (of the chain: th[1], th[1]', …; as anholon's models in bench/models have them)
//   run TOLERANCE SECONDS    as many motions as fit the time; answers with a line of JSON
//   exact STEPS              the end in __float128 by extrapolation of order 24, in so many equal steps
#pragma once
#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <iostream>
#include <string>
#include <vector>

#include "../stopwatch.h"
#include "reduced_systems.h"

namespace peers {

// Gragg's midpoint rule extrapolated to the order 24, in so many equal steps.
template <class System, class State>
State extrapolated(const System& system, State x, double end, int steps) {
  constexpr int kColumns = 12;
  for (int step = 0; step < steps; ++step) {
    const Quad H = Quad(end) / steps, t = H * step;
    std::array<State, kColumns> table;
    for (int j = 0; j < kColumns; ++j) {
      const int n = 2 * (j + 1);
      const Quad h = H / n;
      State before = x, now, rate;
      system(x, rate, t);
      for (std::size_t i = 0; i < x.size(); ++i) now[i] = x[i] + h * rate[i];
      for (int k = 1; k < n; ++k) {
        system(now, rate, t + h * k);
        for (std::size_t i = 0; i < x.size(); ++i) before[i] += 2 * h * rate[i];
        std::swap(before, now);
      }
      system(now, rate, t + H);
      for (std::size_t i = 0; i < x.size(); ++i) now[i] = (now[i] + before[i] + h * rate[i]) / 2;
      for (int k = 1; k <= j; ++k) {  // Aitken and Neville, in h^2; the table holds the row above
        State& above = table[static_cast<std::size_t>(k - 1)];
        const Quad r = Quad(n) / (n - 2 * k), weight = 1 / (r * r - 1);
        for (std::size_t i = 0; i < x.size(); ++i) {
          const Quad better = now[i] + (now[i] - above[i]) * weight;
          above[i] = now[i];
          now[i] = better;
        }
      }
      table[static_cast<std::size_t>(j)] = now;
    }
    x = table[kColumns - 1];
  }
  return x;
}

template <class Values>
void print(const Values& values) {
  std::printf("\"state\": [");
  for (std::size_t i = 0; i < values.size(); ++i) {
    char text[64];
    quadmath_snprintf(text, sizeof text, "%.32Qe", values[i]);
    std::printf("%s\"%s\"", i ? ", " : "", text);
  }
  std::printf("]}\n");
  std::fflush(stdout);
}

// Integrator: made of a system, a tolerance and the end; takes a state there, and tells its steps.
template <template <class, class> class Integrator, template <class, std::size_t> class System, std::size_t n>
int serve(double end) {
  using Narrow = System<double, n>;
  using Exact = System<Quad, n>;
  typename Exact::Given given;
  std::string line;
  for (Quad& x : given) {
    if (!std::getline(std::cin, line)) return 1;
    x = strtoflt128(line.c_str(), nullptr);
  }
  const Narrow system;
  const Exact exact;
  const auto begin = exact.reduce(given);
  typename Narrow::State start;
  std::transform(begin.begin(), begin.end(), start.begin(), [](const Quad& x) { return static_cast<double>(x); });
  while (std::getline(std::cin, line)) {
    double tolerance = 0, seconds = 0;
    int quad_steps = 0;
    if (std::sscanf(line.c_str(), "exact %d", &quad_steps) == 1) {
      const Stopwatch watch;
      const auto x = extrapolated(exact, begin, end, quad_steps);
      std::printf("{\"seconds\": %.3g, ", watch.seconds());
      print(exact.expand(x));
    } else if (std::sscanf(line.c_str(), "run %lf %lf", &tolerance, &seconds) == 2) {
      std::vector<double> times;
      auto x = start;
      Integrator<Narrow, typename Narrow::State> go(system, tolerance, end);
      std::size_t steps = 0;
      try {
        for (const Stopwatch all; times.empty() || all.wall_seconds() < seconds;) {
          x = start;
          const Stopwatch watch;
          steps = go(x);
          times.push_back(watch.seconds());
        }
      } catch (const std::exception& problem) {
        std::printf("{\"failed\": \"%s\"}\n", problem.what());
        std::fflush(stdout);
        continue;
      }
      typename Exact::State last;
      std::copy(x.begin(), x.end(), last.begin());
      std::printf("{\"us\": %.6g, \"runs\": %zu, \"steps\": %zu, ", 1e6 * median(times), times.size(), steps);
      print(exact.expand(last));
    }
  }
  return 0;
}

template <template <class, class> class Integrator>
int serve(int argc, char** argv) {
  if (argc != 4) return 2;
  const std::string system = std::string(argv[1]) + argv[2];
  const double end = std::strtod(argv[3], nullptr);
  if (system == "sleigh1") return serve<Integrator, Sleigh, 1>(end);
  if (system == "disc1") return serve<Integrator, Disc, 1>(end);
  if (system == "trailers3") return serve<Integrator, Trailers, 3>(end);
  if (system == "trailers10") return serve<Integrator, Trailers, 10>(end);
  if (system == "chain4") return serve<Integrator, Chain, 4>(end);
  if (system == "chain8") return serve<Integrator, Chain, 8>(end);
  if (system == "chain16") return serve<Integrator, Chain, 16>(end);
  if (system == "chain32") return serve<Integrator, Chain, 32>(end);
  if (system == "chain64") return serve<Integrator, Chain, 64>(end);
  std::fprintf(stderr, "%s: no system %s\n", argv[0], system.c_str());
  return 2;
}

}  // namespace peers
