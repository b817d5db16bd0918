// Unknown dimensions and the relations between them: linear equations over Q^7, solved as they are added.
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
  DimensionForm unknown(const std::string& name = "");   // the name is used in messages
  DimensionForm resolved(const DimensionForm& f) const;  // with all known relations substituted
  // Adds the equation a = b. Returns false, and adds nothing, if it is inconsistent.
  bool equate(const DimensionForm& a, const DimensionForm& b);
  std::optional<Dimension> known(const DimensionForm& f) const;
  std::string text(const DimensionForm& f) const;  // "a length (m)"

 private:
  std::vector<std::optional<DimensionForm>> solution_;
  std::vector<std::string> names_;
};

}  // namespace anholon
