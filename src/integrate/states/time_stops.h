// The times at which steps of methods without series have to end, because the time alone decides there which function
// holds: a piecewise with t < c, a sign or abs of t - c, a table in t. Such a method evaluates f at points of a step,
// so it would pass a force that acts between two of them.
//
// The deciding value is a + b t + c t^2, or made of such a polynomial by abs, exp, sin, cos, squares and constants. A
// step ends a few round-offs before the kink and the next one begins as many behind it, so each is on one side.
//
// A smooth function that is almost constant but for a short time (exp(-(t - c)^2), tanh(k (t - c))) has such times,
// too, if its argument is such a polynomial: those where the argument is zero or has its extremum, and those where it
// differs from these values by 1.
#pragma once
#include "integrate/series/time_kink.h"

namespace anholon {

class TimeStops {
 public:
  // A kink lies between `before` and `behind`; for a smooth function the two are equal.
  struct Stop {
    double before = 0, behind = 0;
    bool within(long double t) const { return (t > before && t < behind) || (t < before && t > behind); }
  };

  TimeStops() = default;
  // Reads the equations and the first `quadratures` of the program, for a motion from a time towards `end`. The program
  // outlives the object.
  TimeStops(const Program& program, const std::vector<double>& parameters, std::size_t quadratures, long double from,
            long double end);

  // Returns the first stop with `behind` beyond t and before the end; nullopt if there is none.
  std::optional<Stop> next(long double t, long double end) const;

 private:
  using W = long double;
  using Polynomial = TimePolynomial<W>;
  // A slot that decides: at zero, or at the knots of a table.
  struct Kink {
    std::uint32_t slot = 0;
    std::vector<W> knots;
  };

  void find_kinks(const std::vector<bool>& looked_at);
  void find_smooth(const std::vector<bool>& looked_at);
  void note_polynomials(std::uint32_t slot, std::vector<std::uint32_t>& noted) const;
  void keep_first(std::optional<W>& first, W time, W t) const;
  std::optional<W> passing(std::uint32_t slot, W value, W t, int depth = 0) const;
  std::optional<W> passing_sum(const Instruction& in, W value, W t, int depth) const;
  std::optional<W> passing_wave(const Instruction& in, W value, W t) const;
  std::optional<W> passing_kink(const Kink& kink, W t) const;
  W margin(W t) const;
  Stop around(W kink) const;

  const Program* program_ = nullptr;
  bool forward_ = true;
  W scale_ = 0;
  std::vector<bool> of_time_;  // slots of the time and constants alone
  std::vector<std::optional<Polynomial>> polynomials_;
  std::vector<Kink> kinks_;
  std::vector<W> smooth_;  // the times of smooth functions
};

}  // namespace anholon
