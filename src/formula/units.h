// Units of measurement: exact factors to SI. A number with a unit is the number in SI units, so no later computation
// involves units; the degree is pi/180, not a decimal. Dimensions are exponents of the seven SI base units; they may be
// fractions (the square root of a length); an angle is a pure number.
#pragma once
#include <array>
#include <optional>
#include <string>
#include <vector>

#include "numeric/rational.h"

namespace anholon {

using Dimension = std::array<Rational, 7>;  // m, kg, s, A, K, mol, cd

struct Unit {
  Rational factor = 1;  // factor to SI
  int pi = 0;           // exponent of the factor pi
  Dimension dimension;
};

// One row of the table, for the reference page.
struct UnitRow {
  const char* name;
  const char* factor;  // exact: "5/18", not "1/3.6"
  int pi;
  std::array<int, 7> dimension;
  bool prefixes;  // the prefixes k, M, m, … are allowed
  const char* meaning;
};
const std::vector<UnitRow>& unit_table();

// Looks up "km", "rad"; nullopt if there is no such unit.
std::optional<Unit> find_unit(const std::string& name);
// Reads "m^3/s^2", "kg*m^2", "1/s", as written after a number; nullopt if the text is not a unit.
std::optional<Unit> read_unit(const std::string& text);
// Returns the names of the table and common ones with prefixes, for "did you mean".
std::vector<std::string> unit_names();

// Returns "kg*m/s^2", or "1" for a pure number.
std::string print(const Dimension& d);
// Returns "a force (N)", "a length (m)", "a pure number" or "a quantity in kg*m".
std::string describe(const Dimension& d);

}  // namespace anholon
