// Units of measurement: exact factors to SI. A number with a unit is the number in SI units, so that all that follows
// is plain mathematics; the degree is pi/180, not a decimal. Dimensions are exponents of the seven SI base units; they
// may be fractions (the square root of a length); an angle is a pure number.
#pragma once
#include <array>
#include <optional>
#include <string>
#include <vector>

#include "numeric/rational.h"

namespace anholon {

using Dimension = std::array<Rational, 7>;  // m, kg, s, A, K, mol, cd

struct Unit {
  Rational factor = 1;  // to SI
  int pi = 0;           // and so many factors pi
  Dimension dimension;
};

// One row of the table, for the reference page.
struct UnitRow {
  const char* name;
  const char* factor;  // exact, "1/3.6" is not: "5/18"
  int pi;
  std::array<int, 7> dimension;
  bool prefixes;  // k, M, m, … may stand before it
  const char* meaning;
};
const std::vector<UnitRow>& unit_table();

// "km", "rad"; nothing if there is none.
std::optional<Unit> find_unit(const std::string& name);
// "m^3/s^2", "kg*m^2", as it stands after a number; nothing if it is not one.
std::optional<Unit> read_unit(const std::string& text);
// The names of the table and usual ones with prefixes, for "did you mean".
std::vector<std::string> unit_names();

// "kg*m/s^2"; "1" for a pure number.
std::string print(const Dimension& d);
// "a force (N)", "a length (m)", "a pure number", "a quantity in kg*m".
std::string describe(const Dimension& d);

}  // namespace anholon
