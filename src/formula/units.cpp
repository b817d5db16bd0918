#include "formula/units.h"

#include <algorithm>
#include <cctype>

#include "base/assert.h"

namespace anholon {

namespace {

struct Prefix {
  const char* name;
  int power;
};
constexpr Prefix kPrefixes[] = {{"Y", 24},  {"Z", 21}, {"E", 18},  {"P", 15},  {"T", 12},  {"G", 9},   {"M", 6},
                                {"k", 3},   {"h", 2},  {"da", 1},  {"d", -1},  {"c", -2},  {"m", -3},  {"u", -6},
                                {"mu", -6}, {"n", -9}, {"p", -12}, {"f", -15}, {"a", -18}, {"z", -21}, {"y", -24}};

Rational power_of_ten(int n) {
  mpz_class p;
  mpz_ui_pow_ui(p.get_mpz_t(), 10, static_cast<unsigned long>(std::abs(n)));
  return n < 0 ? Rational(mpz_class(1), p) : Rational(p);
}

Rational integer_power(const Rational& base, long n) {
  Rational out = 1;
  for (long k = std::abs(n); k > 0; --k) out *= base;
  return n < 0 ? Rational(1 / out) : out;
}

// The usual name of a quantity of this dimension.
struct Named {
  const char* unit;
  const char* name;
};
constexpr Named kQuantities[] = {{"m", "a length"},
                                 {"kg", "a mass"},
                                 {"s", "a time"},
                                 {"A", "a current"},
                                 {"K", "a temperature"},
                                 {"m^2", "an area"},
                                 {"m^3", "a volume"},
                                 {"m/s", "a velocity"},
                                 {"m/s^2", "an acceleration"},
                                 {"m/s^3", "a jerk"},
                                 {"1/s", "an angular velocity or frequency"},
                                 {"1/s^2", "an angular acceleration"},
                                 {"N", "a force"},
                                 {"N*m", "a torque or energy"},
                                 {"W", "a power"},
                                 {"Pa", "a pressure"},
                                 {"N/m", "a stiffness"},
                                 {"kg*m^2", "a moment of inertia"},
                                 {"kg/m^3", "a density"},
                                 {"kg/s", "a mass flow or damping"},
                                 {"N*s", "a momentum"},
                                 {"N*m*s", "an angular momentum"},
                                 {"V", "a voltage"},
                                 {"ohm", "a resistance"},
                                 {"C", "a charge"}};

}  // namespace

const std::vector<UnitRow>& unit_table() {
  static const std::vector<UnitRow> table = {
      // m, kg, s, A, K, mol, cd
      {"m", "1", 0, {1}, true, "metre"},
      {"g", "1/1000", 0, {0, 1}, true, "gram"},
      {"t", "1000", 0, {0, 1}, false, "tonne; right after the number only, elsewhere t is the time"},
      {"s", "1", 0, {0, 0, 1}, true, "second"},
      {"A", "1", 0, {0, 0, 0, 1}, true, "ampere"},
      {"K", "1", 0, {0, 0, 0, 0, 1}, true, "kelvin"},
      {"mol", "1", 0, {0, 0, 0, 0, 0, 1}, true, "mole"},
      {"cd", "1", 0, {0, 0, 0, 0, 0, 0, 1}, true, "candela"},
      {"rad", "1", 0, {}, true, "radian, the pure number 1"},
      {"deg", "1/180", 1, {}, false, "degree"},
      {"arcmin", "1/10800", 1, {}, false, "minute of arc"},
      {"arcsec", "1/648000", 1, {}, false, "second of arc"},
      {"rev", "2", 1, {}, false, "revolution"},
      {"min", "60", 0, {0, 0, 1}, false, "minute"},
      {"h", "3600", 0, {0, 0, 1}, false, "hour"},
      {"day", "86400", 0, {0, 0, 1}, false, "day of 24 hours"},
      {"Hz", "1", 0, {0, 0, -1}, true, "hertz, 1/s"},
      {"rpm", "1/30", 1, {0, 0, -1}, false, "revolution per minute"},
      {"N", "1", 0, {1, 1, -2}, true, "newton"},
      {"J", "1", 0, {2, 1, -2}, true, "joule"},
      {"W", "1", 0, {2, 1, -3}, true, "watt"},
      {"Pa", "1", 0, {-1, 1, -2}, true, "pascal"},
      {"bar", "100000", 0, {-1, 1, -2}, true, "bar"},
      {"atm", "101325", 0, {-1, 1, -2}, false, "standard atmosphere"},
      {"C", "1", 0, {0, 0, 1, 1}, true, "coulomb"},
      {"V", "1", 0, {2, 1, -3, -1}, true, "volt"},
      {"ohm", "1", 0, {2, 1, -3, -2}, true, "ohm"},
      {"F", "1", 0, {-2, -1, 4, 2}, true, "farad"},
      {"H", "1", 0, {2, 1, -2, -2}, true, "henry"},
      {"T", "1", 0, {0, 1, -2, -1}, true, "tesla"},
      {"Wb", "1", 0, {2, 1, -2, -1}, true, "weber"},
      {"L", "1/1000", 0, {3}, true, "litre"},
      {"AU", "149597870700", 0, {1}, false, "astronomical unit"},
      {"kn", "463/900", 0, {1, 0, -1}, false, "knot, nautical mile per hour"},
      {"nmi", "1852", 0, {1}, false, "nautical mile"},
      {"in", "127/5000", 0, {1}, false, "inch"},
      {"ft", "381/1250", 0, {1}, false, "foot"},
      {"yd", "1143/1250", 0, {1}, false, "yard"},
      {"mi", "201168/125", 0, {1}, false, "mile"},
      {"lb", "45359237/100000000", 0, {0, 1}, false, "pound (mass)"},
      {"lbf", "8896443230521/2000000000000", 0, {1, 1, -2}, false, "pound (force)"},
      {"kp", "980665/100000", 0, {1, 1, -2}, false, "kilopond, kilogram-force"},
      {"hp", "37284993579113511/50000000000000", 0, {2, 1, -3}, false, "horsepower, 550 ft lbf/s"},
      {"PS", "588399/800", 0, {2, 1, -3}, false, "metric horsepower, 75 kp m/s"},
  };
  return table;
}

static const UnitRow* find_row(const std::string& name) {
  for (const UnitRow& r : unit_table())
    if (name == r.name) return &r;
  return nullptr;
}

static Unit of(const UnitRow& r) {
  Unit u;
  u.factor = Rational(r.factor);
  u.pi = r.pi;
  for (std::size_t k = 0; k < 7; ++k) u.dimension[k] = r.dimension[k];
  return u;
}

std::optional<Unit> find_unit(const std::string& name) {
  const UnitRow* row = find_row(name);
  if (!row && name == "Omega") row = find_row("ohm");
  if (row) return of(*row);
  for (const Prefix& p : kPrefixes) {
    const std::string prefix = p.name;
    if (name.size() <= prefix.size() || name.compare(0, prefix.size(), prefix) != 0) continue;
    const UnitRow* base = find_row(name.substr(prefix.size()));
    if (!base || !base->prefixes) continue;
    Unit u = of(*base);
    u.factor *= power_of_ten(p.power);
    return u;
  }
  return std::nullopt;
}

std::optional<Unit> read_unit(const std::string& text) {
  constexpr long kMostPower = 20;
  constexpr int kMostFactors = 20;
  Unit total;
  std::size_t i = 0;
  int factors = 0, sign = 1;
  if (text.starts_with("1/")) sign = -1, i = 2;
  for (;;) {
    if (++factors > kMostFactors) return std::nullopt;
    std::string name;
    for (; i < text.size() && std::isalpha(static_cast<unsigned char>(text[i])); ++i) name += text[i];
    const std::optional<Unit> u = find_unit(name);
    if (!u) return std::nullopt;
    long power = 1;
    if (i < text.size() && text[i] == '^') {
      std::string digits;
      for (++i;
           i < text.size() && (std::isdigit(static_cast<unsigned char>(text[i])) || (digits.empty() && text[i] == '-'));
           ++i)
        digits += text[i];
      if (digits.empty() || digits == "-" || digits.size() > 3) return std::nullopt;
      power = std::stol(digits);
      if (std::abs(power) > kMostPower) return std::nullopt;
    }
    power *= sign;
    total.factor *= integer_power(u->factor, power);
    total.pi += static_cast<int>(power) * u->pi;
    for (std::size_t k = 0; k < 7; ++k) total.dimension[k] += power * u->dimension[k];
    if (i == text.size()) return total;
    if (text[i] != '*' && text[i] != '/') return std::nullopt;
    sign = text[i++] == '/' ? -1 : 1;
  }
}

std::vector<std::string> unit_names() {
  std::vector<std::string> list = {"kg", "mg", "km", "cm",  "mm",  "ms",  "kN",
                                   "kJ", "kW", "MW", "kPa", "MPa", "kHz", "mrad"};
  for (const UnitRow& r : unit_table()) list.emplace_back(r.name);
  return list;
}

std::string print(const Dimension& d) {
  static const char* const kBase[] = {"m", "kg", "s", "A", "K", "mol", "cd"};
  for (const Named& q : kQuantities)
    if (const auto u = read_unit(q.unit); u && u->dimension == d) return q.unit;
  std::string top, bottom;
  // The order of print: kg first, as in kg*m.
  for (const std::size_t k : {1U, 0U, 2U, 3U, 4U, 5U, 6U}) {
    if (d[k] == 0) continue;
    std::string& list = d[k] > 0 ? top : bottom;
    const Rational p = abs(d[k]);
    list += (list.empty() ? ""
             : d[k] > 0   ? "*"
                          : "/") +
            std::string(kBase[k]) + (p == 1 ? "" : "^" + (p.is_integer() ? p.get_str() : "(" + p.get_str() + ")"));
  }
  if (top.empty()) top = "1";
  return bottom.empty() ? top : top + "/" + bottom;
}

std::string describe(const Dimension& d) {
  if (std::all_of(d.begin(), d.end(), [](const Rational& r) { return r == 0; })) return "a pure number";
  const std::string unit = print(d);
  for (const Named& q : kQuantities) {
    if (unit == q.unit) return std::string(q.name) + " (" + unit + ")";
  }
  return "a quantity in " + unit;
}

}  // namespace anholon
