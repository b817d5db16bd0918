#include "result/shortest.h"

#include <array>
#include <bit>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <cstring>

#include "numeric/rational.h"

namespace anholon {

namespace {

__extension__ using Wide = unsigned __int128;

constexpr int kLeast = -122, kMost = 122;  // powers of ten that the numbers between these need
constexpr double kSmall = 1e-100, kLarge = 1e100, kWhole = 0x1p53;

// floor(log2(10^e)), floor(log10(2^e)) and floor(log10(3/4 2^e)), exact for |e| < 1233.
constexpr int log2_of_ten(int e) { return (e * 1741647) >> 19; }
constexpr int log10_of_two(int e) { return (e * 1262611) >> 22; }
constexpr int log10_of_less(int e) { return (e * 1262611 - 524031) >> 22; }

// 10^k times the power of two that makes it a number of 128 bits, rounded up.
struct Power {
  std::uint64_t high, low;
};

using Powers = std::array<Power, kMost - kLeast + 1>;

Powers make_powers() {
  Powers list{};
  for (int k = kLeast; k <= kMost; ++k) {
    mpz_class ten, value;
    mpz_ui_pow_ui(ten.get_mpz_t(), 10, static_cast<unsigned long>(std::abs(k)));
    const int shift = 127 - log2_of_ten(k);
    mpz_class two = mpz_class(1) << static_cast<unsigned long>(std::abs(shift));
    if (k < 0)
      mpz_cdiv_q(value.get_mpz_t(), two.get_mpz_t(), ten.get_mpz_t());
    else if (shift < 0)
      mpz_cdiv_q(value.get_mpz_t(), ten.get_mpz_t(), two.get_mpz_t());
    else
      value = ten * two;
    const mpz_class high = value >> 64, low = value - (high << 64);
    list[static_cast<std::size_t>(k - kLeast)] = {high.get_ui(), low.get_ui()};
  }
  return list;
}

const Power* powers() {
  static const Powers list = make_powers();
  return list.data() - kLeast;
}

// Returns the whole part of g c 2^-128, made odd if it is not the whole product.
std::uint64_t round_to_odd(const Power& g, std::uint64_t c) {
  const Wide low = Wide(g.low) * c, product = Wide(g.high) * c + (low >> 64);
  return static_cast<std::uint64_t>(product >> 64) | (static_cast<std::uint64_t>(product) > 1 ? 1 : 0);
}

struct Decimal {
  std::uint64_t digits;
  int exponent;
};

// Returns the shortest decimal between the half-way marks around a normal number, the nearest one if several are as
// short. `fraction`: the bits of the number below the first; `exponent`: biased.
Decimal shortest_decimal(std::uint64_t fraction, int exponent) {
  const bool first_of_its_power = fraction == 0;  // the number below is half as far
  const std::uint64_t c = fraction | (std::uint64_t{1} << 52);
  const int q = exponent - 1075;
  if (q <= 0 && q > -53 && std::countr_zero(c) >= -q) return {c >> -q, 0};
  const bool even = c % 2 == 0;
  const int k = first_of_its_power ? log10_of_less(q) : log10_of_two(q), h = q + log2_of_ten(-k) + 1;
  const Power& g = powers()[-k];
  const std::uint64_t below = round_to_odd(g, (4 * c - (first_of_its_power ? 1 : 2)) << h),
                      here = round_to_odd(g, (4 * c) << h), above = round_to_odd(g, (4 * c + 2) << h);
  const std::uint64_t lower = below + (even ? 0 : 1), upper = above - (even ? 0 : 1), s = here / 4, t = s / 10;
  // The decimal has one digit less if that one is unique, otherwise all digits. The choice has no branches, because
  // both cases are equally likely.
  const bool down_less = lower <= 40 * t, up_less = 40 * t + 40 <= upper, less = (down_less != up_less) & (s >= 10);
  const bool down = lower <= 4 * s, up = 4 * s + 4 <= upper;
  const std::uint64_t half = 4 * s + 2;
  const bool nearer_up = (here > half) | ((here == half) & (s % 2 != 0));
  const std::uint64_t all = s + ((down != up) ? up : nearer_up);
  return {less ? t + up_less : all, k + less};
}

// Returns the eight digits of n < 10^8 as characters, in the order of memory: halves, pairs and digits are split side
// by side.
std::uint64_t eight_digits(std::uint64_t n) {
  std::uint64_t x = n / 10'000 | (n % 10'000) << 32;
  const std::uint64_t hundreds = (x * 10'486 >> 20) & 0x7f'0000'007f;
  x = hundreds | (x - 100 * hundreds) << 16;
  const std::uint64_t tens = (x * 103 >> 10) & 0xf'000f'000f'000f;
  return (tens | (x - 10 * tens) << 8) + 0x3030'3030'3030'3030;
}

constexpr int kDigits = 17;  // of any double
constexpr std::uint64_t kEight = 100'000'000;

// Writes the digits of n < 10^17 with leading zeros.
void write_digits(char* to, std::uint64_t n) {
  const std::uint64_t rest = n % (kEight * kEight), high = eight_digits(rest / kEight),
                      low = eight_digits(rest % kEight);
  *to = static_cast<char>('0' + n / (kEight * kEight));
  std::memcpy(to + 1, &high, 8);
  std::memcpy(to + 9, &low, 8);
}

constexpr auto kPowersOfTen = [] {
  std::array<std::uint64_t, kDigits + 1> list{};
  std::uint64_t power = 1;
  for (std::uint64_t& p : list) p = power, power *= 10;
  return list;
}();

int count_digits(std::uint64_t n) {
  const int guess = std::bit_width(n) * 1233 >> 12;  // by log10(2)
  return guess + (n >= kPowersOfTen[static_cast<std::size_t>(guess)] ? 1 : 0);
}

char* write_exponent(char* to, int e) {
  *to++ = 'e';
  *to++ = e < 0 ? '-' : '+';
  const int size = std::abs(e);
  if (size >= 100) *to++ = static_cast<char>('0' + size / 100);
  *to++ = static_cast<char>('0' + size / 10 % 10);
  *to++ = static_cast<char>('0' + size % 10);
  return to;
}

// Texts are moved in pieces of this size, whatever their length, so that no call is needed.
struct Piece {
  char text[24];
};

// Writes in fixed notation if that is not longer. `to` has room for a piece after the number.
char* write_decimal(char* to, const Decimal& d) {
  const int n = count_digits(d.digits);
  const std::uint64_t digits = d.digits * kPowersOfTen[static_cast<std::size_t>(kDigits - n)];
  const bool single = n == 1;  // without a point in scientific notation
  if (d.exponent < -(n + 3) + single || d.exponent > 5 - single) {
    write_digits(to + 1, digits);
    to[0] = to[1];
    to[1] = '.';
    return write_exponent(single ? to + 1 : to + n + 1, d.exponent + n - 1);
  }
  const int whole = n + d.exponent;  // digits before the point
  if (whole <= 0) {
    std::memcpy(to, "0.000000", 8);
    write_digits(to + 2 - whole, digits);
    return to + 2 - d.exponent;
  }
  write_digits(to, digits);  // with zeros after them
  if (d.exponent >= 0) return to + whole;
  Piece rest;
  std::memcpy(&rest, to + whole, sizeof rest);
  std::memcpy(to + whole + 1, &rest, sizeof rest);
  to[whole] = '.';
  return to + n + 1;
}

}  // namespace

char* write_shortest(char* to, double value) {
  const double size = std::abs(value);
  if (!(size >= kSmall && size < kLarge) || (size >= kWhole && size < 1e23))
    return std::to_chars(to, to + kShortestRoom, value).ptr;
  const std::uint64_t bits = std::bit_cast<std::uint64_t>(size);
  *to = '-';
  to += std::signbit(value);
  Decimal d = shortest_decimal(bits & ((std::uint64_t{1} << 52) - 1), static_cast<int>(bits >> 52));
  while (d.digits % 10 == 0) d.digits /= 10, ++d.exponent;
  return write_decimal(to, d);
}

}  // namespace anholon
