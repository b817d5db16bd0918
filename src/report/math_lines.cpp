#include "report/math_lines.h"

#include <algorithm>
#include <string_view>

namespace anholon {

namespace {

constexpr std::size_t kLongBrackets = 8;  // signs; a longer bracket is broken inside
// a longer numerator is taken out of its fraction: a browser cannot break a fraction
constexpr std::size_t kLongFraction = 24;

// The elements of `row`, in order.
std::vector<std::string_view> elements(std::string_view row) {
  std::vector<std::string_view> list;
  std::size_t at = 0;
  while (at < row.size()) {
    const std::size_t begin = at;
    int depth = 0;
    do {
      const std::size_t open = row.find('<', at), close = row.find('>', open);
      if (open == std::string_view::npos || close == std::string_view::npos) return {row};  // not made by print()
      if (row[open + 1] == '/')
        --depth;
      else if (row[close - 1] != '/')
        ++depth;
      at = close + 1;
    } while (depth > 0);
    list.push_back(row.substr(begin, at - begin));
  }
  return list;
}

// The approximate number of visible signs.
std::size_t width(std::string_view s) {
  std::size_t n = 0;
  bool tag = false, entity = false;
  for (char c : s) {
    if (c == '<') tag = true;
    if (!tag && !entity && c != '&') n += (static_cast<unsigned char>(c) & 0xC0) != 0x80;
    if (!tag && c == '&') entity = true;
    if (entity && c == ';') entity = false;
    if (c == '>') tag = false;
  }
  return n;
}

constexpr std::string_view kOpen = "<mo>(</mo>", kClose = "<mo>)</mo>", kRow = "<mrow>", kRowEnd = "</mrow>";

// The content of an element with brackets; empty for other elements.
std::string_view bracketed(std::string_view e) {
  if (e.substr(0, kRow.size()) != kRow) return {};
  e = e.substr(kRow.size(), e.size() - kRow.size() - kRowEnd.size());
  if (e.substr(0, kOpen.size()) != kOpen || e.size() < kOpen.size() + kClose.size() ||
      e.substr(e.size() - kClose.size()) != kClose)
    return {};
  return e.substr(kOpen.size(), e.size() - kOpen.size() - kClose.size());
}

struct Fraction {
  std::string_view top, bottom;  // bottom is an element, top a row
};
// Returns a fraction with a long numerator; for other elements its top is empty.
Fraction long_fraction(std::string_view e) {
  constexpr std::string_view open = "<mfrac>", close = "</mfrac>";
  if (e.substr(0, open.size()) != open) return {};
  const std::vector<std::string_view> parts = elements(e.substr(open.size(), e.size() - open.size() - close.size()));
  if (parts.size() != 2 || width(parts[0]) <= kLongFraction || parts[0].substr(0, kRow.size()) != kRow) return {};
  return {parts[0].substr(kRow.size(), parts[0].size() - kRow.size() - kRowEnd.size()), parts[1]};
}

bool is_sign(std::string_view e) { return e == "<mo>+</mo>" || e == "<mo>−</mo>"; }

class Breaker {
 public:
  void row(std::string_view s) {
    bool first = true;
    for (std::string_view e : elements(s)) {
      if (is_sign(e)) {
        // A leading sign belongs to its operand; other signs are at the head of a piece, spaced like a sign between two
        // terms.
        if (!first) next();
        // The blank between two pieces is the space to the left of the sign.
        piece_ += first ? "<mo form=\"prefix\">" : "<mo form=\"infix\" lspace=\"0\">";
        piece_ += e.substr(4);
      } else if (const std::string_view inner = bracketed(e); !inner.empty() && width(inner) > kLongBrackets) {
        piece_ += "<mo stretchy=\"false\">(</mo>";
        row(inner);
        piece_ += "<mo stretchy=\"false\">)</mo>";
      } else if (const Fraction f = long_fraction(e); !f.top.empty()) {
        const std::vector<std::string_view> top = elements(f.top);
        const bool is_sum = std::any_of(top.begin(), top.end(), is_sign);
        piece_ += "<mfrac><mn>1</mn>" + std::string(f.bottom) + "</mfrac>" +
                  (is_sum ? "<mo stretchy=\"false\">(</mo>" : "<mo>&#x2062;</mo>");
        row(f.top);
        if (is_sum) piece_ += "<mo stretchy=\"false\">)</mo>";
      } else {
        piece_ += e;
      }
      first = false;
    }
  }

  std::vector<std::string> pieces() {
    next();
    return std::move(pieces_);
  }

 private:
  void next() {
    if (!piece_.empty()) pieces_.push_back(std::move(piece_));
    piece_.clear();
  }

  std::string piece_;
  std::vector<std::string> pieces_;
};

}  // namespace

std::vector<std::string> math_pieces(const std::string& row) {
  Breaker b;
  b.row(row);
  return b.pieces();
}

std::string wrapping_math(const std::string& row) {
  std::string out;
  for (const std::string& p : math_pieces(row)) {
    if (!out.empty()) out += " ";
    out += "<math>" + p + "</math>";
  }
  return out;
}

}  // namespace anholon
