// The values of a quantity for which motions or linear models are requested: "v=0:10:11", "v=0..10:1" or "v=1,2,5".
// Sweeps and linear models share this notation.
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "numeric/rational.h"
#include "setup/choice.h"

namespace anholon {

// A part of a word, with its place.
struct WordPart {
  std::size_t at;
  std::string text;
};

// Returns the parts of the word between two places. Separators within brackets belong to a part.
std::vector<WordPart> parts_of(const std::string& word, std::size_t from, std::size_t to, char separator);

// Reads a number, a formula of numbers and pi, or a number with a unit. Throws MistakeInWord.
Constant constant_of(const std::string& word, const WordPart& part);
Rational number_of(const std::string& word, const WordPart& part);
// Reads the same; a unit must be that of the quantity, whose number it is (GivenQuantity::number).
Rational number_of(const std::string& word, const WordPart& part, GivenQuantity& of);

// Equidistant points, which are computed on demand, or a list.
class ValueRange {
 public:
  // The points from `from` to `to`. REQUIRES: points >= 1; from == to if there is one point.
  ValueRange(Rational from, Rational to, std::size_t points) : from_(from), to_(to), points_(points) {}
  explicit ValueRange(std::vector<Rational> list) : list_(std::move(list)), points_(list_.size()) {}

  std::size_t size() const { return points_; }
  bool is_grid() const { return list_.empty(); }
  Rational operator[](std::size_t k) const;

 private:
  std::vector<Rational> list_;  // empty for equidistant points
  Rational from_, to_;
  std::size_t points_;
};

// Reads the text after the sign of NAME=FROM:TO:COUNT, NAME=FROM..TO:STEP or NAME=A,B,…. The last point of a range with
// a step is the last one that is not beyond TO. Throws MistakeInWord, also if a grid has more than `most` points.
ValueRange read_value_range(const std::string& word, std::size_t sign, GivenQuantity& of, std::size_t most);

}  // namespace anholon
