#include "base/escape.h"

#include <array>
#include <cstdint>
#include <cstdio>
#include <optional>

#include "base/utf8.h"

namespace anholon {

namespace {

constexpr const char* kUnknown = "\uFFFD";

// Returns the code of the character of these bytes; nullopt if they are not UTF-8: too long, beyond U+10FFFF, a
// surrogate, or an incomplete sequence.
std::optional<std::uint32_t> code_point(std::string_view c) {
  const auto byte = [&](std::size_t k) { return static_cast<std::uint32_t>(static_cast<unsigned char>(c[k])); };
  if (c.size() == 1) return byte(0) < 0x80 ? std::optional(byte(0)) : std::nullopt;
  constexpr std::array<std::uint32_t, 5> kLeast = {0, 0, 0x80, 0x800, 0x10000};
  std::uint32_t code = byte(0) & (0x7Fu >> c.size());
  for (std::size_t k = 1; k < c.size(); ++k) code = code << 6 | (byte(k) & 0x3F);
  const bool valid =
      byte(0) < 0xF8 && code >= kLeast[c.size()] && code <= 0x10FFFF && !(code >= 0xD800 && code <= 0xDFFF);
  return valid ? std::optional(code) : std::nullopt;
}

bool is_control(std::uint32_t c) { return c < 0x20 || (c >= 0x7F && c < 0xA0); }

// True for characters without a visible sign: direction marks, zero width, line separators, tags, noncharacters.
bool is_hidden(std::uint32_t c) {
  struct Range {
    std::uint32_t first, last;
  };
  constexpr std::array kHidden = {Range{0xAD, 0xAD},     Range{0x61C, 0x61C},   Range{0x180E, 0x180E},
                                  Range{0x200B, 0x200B}, Range{0x200E, 0x200F}, Range{0x2028, 0x202E},
                                  Range{0x2060, 0x206F}, Range{0xFDD0, 0xFDEF}, Range{0xFEFF, 0xFEFF},
                                  Range{0xFFF9, 0xFFFB}, Range{0xFFFE, 0xFFFF}, Range{0xE0000, 0xE007F}};
  for (const Range& r : kHidden)
    if (c >= r.first && c <= r.last) return true;
  return (c & 0xFFFE) == 0xFFFE;
}

// Returns the picture of a control character.
std::string picture(std::uint32_t c) {
  if (c >= 0x80) return kUnknown;
  const std::uint32_t code = c == 0x7F ? 0x2421 : 0x2400 + c;
  return {static_cast<char>(0xE0 | code >> 12), static_cast<char>(0x80 | (code >> 6 & 63)),
          static_cast<char>(0x80 | (code & 63))};
}

// Replaces each character; f(bytes of the character, its code if it is valid) returns the replacement.
template <class F>
std::string each(std::string_view text, F f) {
  std::string out;
  out.reserve(text.size());
  for (std::size_t i = 0; i < text.size();) {
    const std::string_view bytes = text.substr(i, utf8_width(text, i));
    const auto code = code_point(bytes);
    // A byte that is not part of a character is replaced by itself.
    const std::string_view c = code ? bytes : text.substr(i, 1);
    out += f(c, code);
    i += c.size();
  }
  return out;
}

std::string visible(std::string_view c, std::optional<std::uint32_t> code) {
  return !code || is_hidden(*code) ? kUnknown : is_control(*code) ? picture(*code) : std::string(c);
}

std::string visible_lines(std::string_view c, std::optional<std::uint32_t> code) {
  return c == "\n" ? "\n" : c == "\t" ? " " : visible(c, code);
}

// Replaces CR LF by LF at the end of lines.
std::string without_cr(std::string_view text) {
  std::string out;
  for (std::size_t i = 0; i < text.size(); ++i)
    if (text[i] != '\r' || i + 1 == text.size() || text[i + 1] != '\n') out += text[i];
  return out;
}

std::string markup(std::string_view c, std::string plain) {
  if (c == "<") return "&lt;";
  if (c == ">") return "&gt;";
  if (c == "&") return "&amp;";
  if (c == "\"") return "&quot;";
  if (c == "'") return "&#39;";
  return plain;
}

std::string hexadecimal(const char* format, std::uint32_t code) {
  char buffer[16];
  std::snprintf(buffer, sizeof buffer, format, static_cast<unsigned>(code));
  return buffer;
}

// A JSON escape has four digits; a larger code needs a surrogate pair.
std::string json_code(std::uint32_t c) {
  return c < 0x10000 ? hexadecimal("\\u%04x", c)
                     : hexadecimal("\\u%04x", 0xD800 + ((c - 0x10000) >> 10)) +
                           hexadecimal("\\u%04x", 0xDC00 + ((c - 0x10000) & 0x3FF));
}

std::string toml_code(std::uint32_t c) { return hexadecimal(c < 0x10000 ? "\\u%04x" : "\\U%08x", c); }

std::string quoted(std::string_view text, std::string (*number)(std::uint32_t)) {
  return each(text, [&](std::string_view c, std::optional<std::uint32_t> code) -> std::string {
    if (!code) return kUnknown;
    switch (*code) {
    case '"':
      return "\\\"";
    case '\\':
      return "\\\\";
    case '\n':
      return "\\n";
    case '\t':
      return "\\t";
    case '\r':
      return "\\r";
    default:
      return is_control(*code) || is_hidden(*code) ? number(*code) : std::string(c);
    }
  });
}

}  // namespace

std::string shown(std::string_view text) { return each(text, visible); }

std::string shown_lines(std::string_view text) { return each(without_cr(text), visible_lines); }

std::string json_escape(std::string_view text) { return quoted(text, json_code); }

std::string toml_escape(std::string_view text) { return quoted(text, toml_code); }

std::string markup_escape(std::string_view text) {
  return each(text, [](std::string_view c, std::optional<std::uint32_t> code) { return markup(c, visible(c, code)); });
}

std::string markup_lines(std::string_view text) {
  return each(without_cr(text), [](std::string_view c, std::optional<std::uint32_t> code) {
    return markup(c, c == "\t" ? "\t" : visible_lines(c, code));
  });
}

std::string latex_escape(std::string_view text) {
  return each(text, [](std::string_view c, std::optional<std::uint32_t> code) -> std::string {
    switch (c[0]) {
    case '\\':
      return "\\textbackslash{}";
    case '~':
      return "\\textasciitilde{}";
    case '^':
      return "\\textasciicircum{}";
    case '_':
    case '%':
    case '&':
    case '#':
    case '$':
    case '{':
    case '}':
      return "\\" + std::string(c);
    default:
      return visible(c, code);
    }
  });
}

std::string comment_line(std::string_view text) {
  char before = ' ';
  bool asked = false;  // the text ends with ??, which makes a trigraph of C with some characters
  return each(text, [&](std::string_view c, std::optional<std::uint32_t> code) {
    const bool trigraph = asked && std::string_view("=/'()!<>-").find(c) != std::string_view::npos;
    const bool mark = (before == '*' && c == "/") || (before == '/' && c == "*") || trigraph;
    asked = before == '?' && c == "?";
    before = c[0];
    return (mark ? " " : "") + visible(c, code);
  });
}

std::string code_string(std::string_view text) {
  return each(text, [](std::string_view c, std::optional<std::uint32_t> code) -> std::string {
    return c == "\"" || c == "\\" ? "\\" + std::string(c) : visible(c, code);
  });
}

std::string csv_cell(std::string_view text) {
  const std::string cell = each(text, visible);
  if (cell.find_first_of(",\"") == std::string::npos) return cell;
  std::string quoted = "\"";
  for (const char c : cell) quoted += c == '"' ? "\"\"" : std::string(1, c);
  return quoted + "\"";
}

std::string hdf5_text(std::string_view text) {
  return each(text, [](std::string_view c, std::optional<std::uint32_t> code) {
    return !code || *code == 0 ? std::string(kUnknown) : std::string(c);
  });
}

}  // namespace anholon
