#include "plot/ticks.h"

#include <algorithm>
#include <charconv>
#include <cmath>

#include "numeric/number.h"

namespace anholon::plot {

namespace {

std::string fixed(double x, int decimals) {
  char buffer[400];
  const auto r = std::to_chars(buffer, buffer + sizeof buffer, x, std::chars_format::fixed, decimals);
  std::string s(buffer, r.ptr);
  if (s.find_first_not_of("-0.") == std::string::npos && s[0] == '-') s.erase(0, 1);
  return s;
}

// Returns k m 10^e, rounded once if possible.
double multiple(double k, int m, int e) { return e < 0 ? k * m / std::pow(10.0, -e) : k * m * std::pow(10.0, e); }

constexpr double kNear = 1e-9;  // fraction of a step: the round-off of an axis

Ticks linear(const Axis& axis, int most) {
  Ticks t;
  const double length = axis.to - axis.from;
  if (!(length > 0) || !std::isfinite(length)) return t;
  const auto count = [&](int mantissa, int exponent) {
    const double by = multiple(1, mantissa, exponent);
    return std::floor(axis.to / by + kNear) - std::ceil(axis.from / by - kNear) + 1;
  };
  // The shortest round step that makes about `most` ticks; the previous one if only a single tick is left.
  int e = static_cast<int>(std::floor(std::log10(length / most))) - 1, m = 1;
  for (int last_e = e, last_m = m; count(m, e) > most + 1 || count(m, e) < 2;) {
    if (count(m, e) < 2) {
      e = last_e, m = last_m;
      break;
    }
    last_e = e, last_m = m;
    if (m == 5)
      m = 1, ++e;
    else
      m = m == 1 ? 2 : 5;
  }
  const double step = multiple(1, m, e), largest = std::max(std::abs(axis.from), std::abs(axis.to));
  if (!(largest / step < 1e15)) return t;  // a double cannot distinguish the ticks
  // If the numbers differ in late digits only, labels show the difference from a round number.
  constexpr double kLateDigits = 1e-4;
  const double offset = length < kLateDigits * largest ? std::round(axis.from / step / 100) * 100 : 0;
  const double beyond = std::max(std::abs(axis.from - offset * step), std::abs(axis.to - offset * step));
  constexpr double kLong = 1e5, kShort = 1e-3;
  const int factor = beyond >= kLong || beyond < kShort ? static_cast<int>(std::floor(std::log10(beyond))) : 0;
  const double first = std::ceil(axis.from / step - kNear), last = std::floor(axis.to / step + kNear);
  for (double k = first; k <= last; ++k) {
    t.at.push_back(multiple(k, m, e));
    t.labels.push_back(fixed(multiple(k - offset, m, e - factor), std::max(0, factor - e)));
  }
  if (factor != 0) t.note = "×" + power_of_ten(factor);
  if (offset != 0) {
    const double base = multiple(offset, m, e);
    const std::string digits =
        number_text(std::abs(base), std::clamp(static_cast<int>(std::log10(std::abs(base) / step)) + 1, 1, 16));
    t.note += (t.note.empty() ? "" : " ") + std::string(base < 0 ? "- " : "+ ") + digits;
  }
  return t;
}

Ticks logarithmic(const Axis& axis, int most) {
  Ticks t;
  const double from = std::log10(axis.from), to = std::log10(axis.to);
  const int first = static_cast<int>(std::ceil(from - 1e-9)), last = static_cast<int>(std::floor(to + 1e-9));
  const int decades = std::max(1, static_cast<int>(std::ceil((to - from) / std::max(1, most))));
  if (last - first >= 2) {
    for (int d = first; d <= last; ++d)
      if (((d % decades) + decades) % decades == 0)
        t.at.push_back(std::pow(10.0, d)), t.labels.push_back(power_of_ten(d));
    return t;
  }
  for (int d = first - 1; d <= last; ++d)
    for (const int m : {1, 2, 5})
      if (const double x = multiple(1, m, d); x >= axis.from * (1 - 1e-9) && x <= axis.to * (1 + 1e-9))
        t.at.push_back(x), t.labels.push_back(number_text(x, 3));
  if (t.at.size() >= 2) return t;
  return linear(axis, most);
}

}  // namespace

double Axis::place(double x) const { return log ? std::log(x / from) / std::log(to / from) : (x - from) / (to - from); }

Ticks ticks(const Axis& axis, int most) {
  return axis.log ? logarithmic(axis, std::max(2, most)) : linear(axis, std::max(2, most));
}

Axis axis_for(double least, double greatest, bool log, bool tight) {
  constexpr double kRoom = 0.04;
  if (log) {
    if (least == greatest) return {least / 2, greatest * 2, true};
    const double room = tight ? 1 : std::pow(greatest / least, kRoom);
    return {least / room, greatest * room, true};
  }
  // If numbers are equal up to the round-off of a double, a plot would show only round-off.
  const double size = std::max(std::abs(least), std::abs(greatest));
  if (!(greatest - least > 32 * 2.3e-16 * size)) {
    const double around = size > 0 ? 0.1 * size : 1;
    return {least - around, greatest + around, false};
  }
  const double room = tight ? 0 : kRoom * (greatest - least);
  return {least - room, greatest + room, false};
}

std::string power_of_ten(int exponent) {
  static const char* const kDigits[] = {"⁰", "¹", "²", "³", "⁴", "⁵", "⁶", "⁷", "⁸", "⁹"};
  std::string out = exponent < 0 ? "10⁻" : "10";
  for (const char c : std::to_string(std::abs(exponent))) out += kDigits[c - '0'];
  return out;
}

}  // namespace anholon::plot
