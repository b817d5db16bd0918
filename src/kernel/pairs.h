// Straight-line code in pairs of doubles, for several motions side by side: the values of a tape at order 0.
//
// A number is the sum of two doubles, the first of which is the rounded sum. Sums, products and quotients keep 2^-100
// of their size, sines and cosines 2^-65; other functions are computed in long double, lane by lane. The bits of a lane
// depend neither on the other lanes nor on their number.
#pragma once
#include <cstdint>
#include <functional>
#include <memory>
#include <vector>

#include "tape/tape.h"

namespace anholon {

// The tape as steps; place i of a number is slot i of the tape, further places contain cosines.
struct PairProgram {
  enum class Act : std::uint8_t {
    linear,       // the sum of terms [first, first + count)
    multiply,     // a * b
    divide,       // a / b
    sine_cosine,  // out = sin a, b = cos a
    copy,         // a
    other,        // by long double: slot `out` of the tape
  };
  struct Step {
    Act act;
    std::uint32_t out, a = 0, b = 0, first = 0, count = 0;
  };
  struct Term {
    double high, low;  // the coefficient
    std::uint32_t place;
  };
  std::vector<Step> steps;
  std::vector<Term> terms;
  std::uint32_t places = 0;
};

// Computes the steps over numbers [place][high, low][lane]; `other` computes a step of that kind.
using PairSteps = void (*)(const PairProgram&, double* numbers, const std::function<void(std::uint32_t slot)>& other);
// One function for each instruction set (tiers/tier_*.cpp), with its number of lanes.
void run_pairs_plain(const PairProgram&, double*, const std::function<void(std::uint32_t)>&);
void run_pairs_avx2(const PairProgram&, double*, const std::function<void(std::uint32_t)>&);
void run_pairs_avx512(const PairProgram&, double*, const std::function<void(std::uint32_t)>&);

class PairMachine {
 public:
  // `lanes`: of a tier of this machine (kernel/arithmetic.h).
  PairMachine(const Tape& tape, const std::vector<long double>& parameters, int lanes);
  PairMachine(const PairMachine&) = delete;
  PairMachine& operator=(const PairMachine&) = delete;

  void set(std::uint32_t slot, int lane, long double x) { put(slot, lane, x); }
  void evaluate();
  long double value(std::size_t root, int lane) const { return get(tape_->roots[root], lane); }

 private:
  std::size_t at(std::uint32_t place, int lane) const {
    return 2 * static_cast<std::size_t>(place) * lanes_ + static_cast<std::size_t>(lane);
  }
  long double get(std::uint32_t place, int lane) const {
    return static_cast<long double>(numbers_[at(place, lane)]) + numbers_[at(place, lane) + lanes_];
  }
  void put(std::uint32_t place, int lane, long double x) {
    const double high = static_cast<double>(x);
    numbers_[at(place, lane)] = high;
    numbers_[at(place, lane) + lanes_] = static_cast<double>(x - high);
  }
  void add(const Instruction& in, std::uint32_t slot);
  void by_long_double(std::uint32_t slot);

  struct Free {
    void operator()(double* p) const;
  };
  const Tape* tape_;
  Machine<long double> wide_;  // of constants and of steps of the kind `other`
  std::size_t lanes_;
  PairSteps run_;
  PairProgram program_;
  std::vector<std::pair<std::uint32_t, std::uint32_t>> sines_;  // argument and step, while the program is made
  std::unique_ptr<double[], Free> numbers_;
  std::function<void(std::uint32_t)> other_;
};

}  // namespace anholon
