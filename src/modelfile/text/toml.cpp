#include "modelfile/text/toml.h"

#include <algorithm>
#include <sstream>
#include <stdexcept>

// On invalid input the parser may violate its own invariants: a violation is reported as a syntax error.
#define TOML_ASSERT(condition)                                                                                         \
  do {                                                                                                                 \
    if (!(condition)) throw std::invalid_argument("a syntax that is not TOML");                                        \
  } while (false)
#pragma GCC diagnostic push
#ifndef __clang__
#pragma GCC diagnostic ignored "-Wterminate"
#endif
#include <toml++/toml.h>
#pragma GCC diagnostic pop

#include "base/utf8.h"
#include "modelfile/text/syntax_error.h"

namespace anholon {

namespace {

constexpr std::size_t kLongestFile = 4 << 20;

Span span_of(const toml::source_region& r) {
  Span s;
  s.line = static_cast<std::uint32_t>(r.begin.line);
  s.column = static_cast<std::uint32_t>(r.begin.column);
  if (r.end.line == r.begin.line && r.end.column > r.begin.column)
    s.length = static_cast<std::uint32_t>(r.end.column - r.begin.column);
  return s;
}

// Walks the raw text of a value to find the position of each of its characters.
class Places {
 public:
  explicit Places(const SourceText& source) : text_(source.text) {
    // The parser counts columns after a byte order mark.
    starts_ = {0, text_.compare(0, 3, "\xEF\xBB\xBF") == 0 ? 3U : 0U};
    for (std::size_t i = 0; i < text_.size(); ++i)
      if (text_[i] == '\n') starts_.push_back(i + 1);
  }

  // Values of one line are looked up from left to right: the search continues at its last position.
  std::size_t offset(Span s) const {
    if (s.line == 0 || s.line >= starts_.size()) return text_.size();
    if (s.line != last_.line || s.column < last_.column) last_ = {s.line, 1, 1}, last_offset_ = starts_[s.line];
    for (; last_.column < s.column && last_offset_ < text_.size(); ++last_.column)
      last_offset_ += utf8_width(text_, last_offset_);
    return last_offset_;
  }

  // Returns the characters of a number as written.
  std::string number(Span s) const {
    std::size_t i = offset(s);
    std::string out;
    for (; i < text_.size(); ++i) {
      const char c = text_[i];
      if (c == '_') continue;
      if (!(std::isalnum(static_cast<unsigned char>(c)) || c == '+' || c == '-' || c == '.')) break;
      out += c;
    }
    return out;
  }

  FormulaText string(const std::string& value, Span s) const {
    std::size_t i = offset(s);
    const auto starts = [&](const char* p) { return text_.compare(i, std::string(p).size(), p) == 0; };
    const bool multiline = starts("\"\"\"") || starts("'''");
    const bool basic = i < text_.size() && text_[i] == '"';
    const std::size_t quote = multiline ? 3 : 1;
    Span at = s;
    at.length = 1;
    at.column += static_cast<std::uint32_t>(quote);
    i += quote;
    const bool plain = !multiline && text_.compare(i, value.size(), value) == 0;
    if (plain) return FormulaText(value, at);
    if (multiline && i < text_.size() && text_[i] == '\r') ++i;
    if (multiline && i < text_.size() && text_[i] == '\n') ++i, ++at.line, at.column = 1;
    std::vector<Span> places;
    for (std::size_t v = 0; v < value.size(); v += utf8_width(value, v)) {
      places.push_back(at);
      if (i >= text_.size()) continue;
      std::size_t width = utf8_width(text_, i), columns = 1;
      if (basic && text_[i] == '\\' && i + 1 < text_.size()) {
        const char e = text_[i + 1];
        width = columns = e == 'u' ? 6 : e == 'U' ? 10 : 2;
      }
      if (text_[i] == '\n')
        ++at.line, at.column = 1;
      else
        at.column += static_cast<std::uint32_t>(columns);
      i += width;
    }
    if (places.empty()) return FormulaText(value, at);
    return FormulaText(value, std::move(places));
  }

 private:
  const std::string& text_;
  std::vector<std::size_t> starts_;
  mutable Span last_;
  mutable std::size_t last_offset_ = 0;
};

// A key with more parts is refused before the parser builds (and recursively destroys) a table for each part.
constexpr int kDeepestKey = 100;

void check_depth(const SourceText& source) {
  int dots = 0;
  std::uint32_t line = 1;
  for (const char c : source.text) {
    if (c == '\n') ++line;
    const bool part =
        std::isalnum(static_cast<unsigned char>(c)) || c == '_' || c == '-' || c == ' ' || c == '"' || c == '\'';
    if (c == '.')
      ++dots;
    else if (!part)
      dots = 0;
    if (dots > kDeepestKey)
      throw Failure(Span{line, 1, 1}, "a key of more than " + std::to_string(kDeepestKey) + " parts");
  }
}

// Returns the hint for the character c at s[i], which stands outside of quotes in this line.
std::string hint_outside_quotes(const std::string& line, const std::string& s, std::size_t i, const std::string& c) {
  for (const char* quote : {"“", "”", "„", "‟", "‘", "’", "‚", "«", "»", "″"})
    if (c == quote) return "a text stands between straight quotes: \"…\"";
  const std::size_t begin = s.rfind('\n', i) + 1;  // npos + 1 is 0
  const std::size_t equals = line.find('=');
  if (equals == std::string::npos || begin + equals > i)
    return "a key with letters beyond A-Z stands in quotes: \"" + c + "\" = …";
  std::size_t digits = i;
  while (digits > begin && (std::isdigit(static_cast<unsigned char>(s[digits - 1])) || s[digits - 1] == '.')) --digits;
  if (c == "°" && digits < i)
    return "an angle stands in quotes, with its unit: \"" + s.substr(digits, i - digits) + " deg\"";
  return "a formula stands in quotes: name = \"a*b\"";
}

// Refuses characters outside ASCII except in quotes and comments (a bare Greek key is the most likely mistake, and
// toml++ 3.3 fails on it).
void check_ascii(const SourceText& source) {
  const std::string& s = source.text;
  std::uint32_t line = 1, column = 1;
  std::string quote;  // the quotes that close the current text
  for (std::size_t i = 0; i < s.size();) {
    const std::size_t width = utf8_width(s, i);
    std::size_t step = width;
    if (s[i] == '\n') {
      ++line, column = 1, ++i;
      if (quote.size() == 1) quote.clear();
      continue;
    }
    if (!quote.empty()) {
      if (quote[0] == '"' && s[i] == '\\' && i + 1 < s.size() && s[i + 1] != '\n')
        step = 2;
      else if (s.compare(i, quote.size(), quote) == 0)
        step = quote.size(), quote.clear();
    } else if (s[i] == '#') {
      while (i < s.size() && s[i] != '\n') ++i;
      continue;
    } else if (s[i] == '"' || s[i] == '\'') {
      const std::string three(3, s[i]);
      quote = s.compare(i, 3, three) == 0 ? three : std::string(1, s[i]);
      step = quote.size();
    } else if (static_cast<unsigned char>(s[i]) >= 0x80) {
      const std::string c = s.substr(i, width);
      if (width == 1) throw Failure(Span{line, column, 1}, "this byte is no text");
      if (!(i == 0 && c == "\xEF\xBB\xBF"))
        throw Failure(Span{line, column, 1}, "'" + c + "' outside quotes",
                      hint_outside_quotes(source.line(line), s, i, c));
    }
    column += static_cast<std::uint32_t>(step == width ? 1 : step);
    i += step;
  }
}

Item convert(const toml::node& node, const Places& places) {
  Item item;
  item.span = span_of(node.source());
  if (const auto* s = node.as_string()) {
    item.kind = Item::Kind::string;
    item.formula = places.string(s->get(), item.span);
  } else if (node.is_integer() || node.is_floating_point()) {
    item.kind = Item::Kind::number;
    const std::string digits = places.number(item.span);
    if (digits.size() > 1 && digits[0] == '0' && std::isalpha(static_cast<unsigned char>(digits[1])) &&
        digits[1] != 'e')
      throw Failure(item.span, "hexadecimal, octal and binary numbers are not read");
    if (digits.find("nan") != std::string::npos || digits.find("inf") != std::string::npos)
      throw Failure(item.span, "'" + digits + "' is no value");
    item.formula = FormulaText(digits, item.span);
  } else if (const auto* b = node.as_boolean()) {
    item.kind = Item::Kind::boolean;
    item.truth = b->get();
  } else if (const auto* a = node.as_array()) {
    item.kind = Item::Kind::array;
    for (const toml::node& element : *a) item.items.push_back(convert(element, places));
  } else if (const auto* t = node.as_table()) {
    item.kind = Item::Kind::table;
    for (const auto& [key, value] : *t) {
      Item child = convert(value, places);
      child.key = normal_name(key.str());
      child.key_span = span_of(key.source());
      item.items.push_back(std::move(child));
    }
    std::stable_sort(item.items.begin(), item.items.end(), [](const Item& x, const Item& y) {
      return x.key_span.line != y.key_span.line ? x.key_span.line < y.key_span.line
                                                : x.key_span.column < y.key_span.column;
    });
  } else {
    item.kind = Item::Kind::other;
  }
  return item;
}

void put_in_file(Item& item, std::uint32_t file) {
  item.key_span.file = item.span.file = file;
  item.formula.set_file(file);
  for (Item& i : item.items) put_in_file(i, file);
}

}  // namespace

const Item* Item::find(const std::string& name) const {
  for (const Item& i : items)
    if (i.key == name) return &i;
  return nullptr;
}

static Item read_document(const SourceText& source) {
  if (source.text.size() > kLongestFile)
    throw Failure(Span{1, 1, 1}, "the file is larger than " + std::to_string(kLongestFile >> 20) + " MiB");
  check_depth(source);
  check_ascii(source);
  try {
    const toml::table document = toml::parse(source.text, source.name);
    return convert(document, Places(source));
  } catch (const toml::parse_error& e) {
    throw syntax_error(e.description(), span_of(e.source()), source);
  } catch (const std::invalid_argument& e) {
    throw Failure(Span{1, 1, 1}, e.what());
  }
}

Item read_toml(const SourceText& source, std::uint32_t file) {
  try {
    Item root = read_document(source);
    if (file > 0) put_in_file(root, file);
    return root;
  } catch (Failure& f) {
    f.diagnostic.span.file = file;
    throw;
  }
}

}  // namespace anholon
