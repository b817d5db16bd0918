// Unknown dimensions and what is known of them: linear equations over Q^7, solved as they come.
#pragma once
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "formula/units.h"

namespace anholon {

// A known dimension times powers of unknown ones.
struct DimensionForm {
  Dimension known;
  std::map<std::size_t, Rational> unknowns;  // unknown -> power
};

DimensionForm operator*(const DimensionForm& a, const DimensionForm& b);
DimensionForm power(const DimensionForm& a, const Rational& exponent);
DimensionForm operator/(const DimensionForm& a, const DimensionForm& b);

class Dimensions {
 public:
  DimensionForm unknown(const std::string& name = "");   // of what, for messages
  DimensionForm resolved(const DimensionForm& f) const;  // with all that is known put in
  // Takes a and b to be equal from here on; false, and nothing is learned, if they cannot be.
  bool equate(const DimensionForm& a, const DimensionForm& b);
  std::optional<Dimension> known(const DimensionForm& f) const;
  std::string text(const DimensionForm& f) const;  // "a length (m)"

 private:
  std::vector<std::optional<DimensionForm>> solution_;
  std::vector<std::string> names_;
};

}  // namespace anholon
