// --vary: the numbers that differ from case to case, and their values.
#pragma once
#include "cli/input.h"
#include "ensemble/ensemble.h"

namespace anholon::cli {

class Variation {
 public:
  // Throws UsageError with the position in the text.
  Variation(const Options& o, const Model& model);

  const std::vector<Varied>& varied() const { return varied_; }
  std::size_t cases() const { return cases_; }
  // The values depend only on the number of the case. Cases run through the grid, the last --vary fastest.
  std::vector<Rational> operator()(std::size_t number) const;

 private:
  struct Values {
    std::vector<Rational> list;  // for a grid; else empty
    enum class Law : std::uint8_t { normal, uniform } law = Law::normal;
    double a = 0, b = 0;  // parameters of the distribution
    std::uint32_t stream = 0;
  };
  Values law(const std::string& word, std::size_t sign, const std::string& unit);
  Values listed(const std::string& word, std::size_t sign, const std::string& unit);

  std::vector<Varied> varied_;
  std::vector<Values> values_;
  std::size_t grid_ = 1, cases_ = 0;
  std::uint64_t seed_ = 0;
  std::uint32_t streams_ = 0;  // of random values
};

}  // namespace anholon::cli
