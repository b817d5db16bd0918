// The numbers that differ from case to case: grids, lists and random draws.
#pragma once
#include "ensemble/ensemble.h"

namespace anholon {

// A mistake in the words of a variation, with its place in them.
struct VariationMistake {
  Diagnostic diagnostic;
  std::string word;
};

class Variation {
 public:
  explicit Variation(std::uint64_t seed = 0) : seed_(seed) {}

  // NAME=FROM:TO:COUNT, NAME=A,B,…, NAME~normal(MEAN,DEVIATION) or NAME~uniform(FROM,TO). Throws VariationMistake.
  void add(const std::string& word, const Model& model);
  // A list of values in SI units. Throws VariationMistake.
  void add(const std::string& name, std::vector<Rational> values, const Model& model);
  // How many cases there are; without a number all points of the grid. Call it at the end. `called` is the name of the
  // number in messages. Throws Failure without a place if nothing varies or the number does not fit.
  void finish(std::optional<std::size_t> cases, const std::string& called);

  static constexpr std::size_t kMostCases = 1'000'000'000'000;

  const std::vector<Varied>& varied() const { return varied_; }
  std::size_t cases() const { return cases_; }
  // The values depend on the number of the case alone. Cases run through the grid, the last name fastest.
  std::vector<Rational> operator()(std::size_t number) const;

 private:
  struct Values {
    std::vector<Rational> list;  // for a grid; else empty
    enum class Law : std::uint8_t { normal, uniform } law = Law::normal;
    double a = 0, b = 0;  // parameters of the distribution
    std::uint32_t stream = 0;
  };
  Values law(const std::string& word, std::size_t sign, const std::string& unit);
  Values listed(const std::string& word, std::size_t sign, const std::string& unit) const;
  void name(const std::string& word, std::size_t sign, const Model& model);
  void take(Values values);

  std::vector<Varied> varied_;
  std::vector<Values> values_;
  std::size_t grid_ = 1, cases_ = 0;
  std::uint64_t seed_;
  std::uint32_t streams_ = 0;  // of random values
};

// Throws Failure without a place if a name is both varied and given in the state that all cases share.
void must_not_be_given(const std::vector<Varied>& varied, const StateChoice& state);

}  // namespace anholon
