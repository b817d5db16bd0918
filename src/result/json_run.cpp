// Rows from the JSON of `simulate`. Numbers are taken as written, and the text beside the rows is kept: a general
// reader would round the numbers and reformat the rest.
#include "base/diagnostic.h"
#include "base/utf8.h"
#include "result/run_file.h"

namespace anholon {

namespace {

class JsonReader {
 public:
  explicit JsonReader(std::string_view text) : text_(text) {}

  RunFile read() {
    space();
    if (!take('{')) fail("this is not the JSON of a run", "anholon simulate MODEL --to T -o run.json writes one");
    run_.report = "{";
    bool kept = false;
    for (bool first = true;; first = false) {
      std::size_t begin = at_;
      space();
      if (take('}')) break;
      if (!first) {
        if (!take(',')) fail("a comma is missing");
        begin = at_;
        space();
      }
      const std::string key = string();
      space();
      if (!take(':')) fail("a colon is missing");
      space();
      if (key == "columns")
        columns();
      else if (key == "rows")
        rows();
      else {
        if (key == "model" && peek() == '"')
          run_.title = string();
        else
          skip(0);
        run_.report += (kept ? "," : "") + std::string(text_.substr(begin, at_ - begin));
        kept = true;
      }
    }
    run_.report += kept ? "\n}" : "}";
    space();
    if (at_ < text_.size()) fail("text after the end");
    if (run_.table.columns.empty())
      throw Failure(Span{}, "this is not the JSON of a run: it has no columns",
                    "anholon simulate MODEL --to T -o run.json writes them");
    return std::move(run_);
  }

 private:
  static constexpr int kDeepest = 200;

  char peek() const { return at_ < text_.size() ? text_[at_] : '\0'; }
  bool take(char c) {
    if (peek() != c || at_ >= text_.size()) return false;
    ++at_;
    return true;
  }
  void space() {
    while (at_ < text_.size() && (text_[at_] == ' ' || text_[at_] == '\n' || text_[at_] == '\t' || text_[at_] == '\r'))
      ++at_;
  }

  [[noreturn]] void fail(const std::string& message, const std::string& hint = {}) const {
    std::uint32_t line = 1;
    std::size_t begin = 0;
    for (std::size_t i = 0; i < at_ && i < text_.size(); ++i)
      if (text_[i] == '\n') ++line, begin = i + 1;
    throw Failure(Span{line, static_cast<std::uint32_t>(utf8_length(text_.substr(begin, at_ - begin)) + 1)}, message,
                  hint);
  }

  std::string string() {
    if (!take('"')) fail("a text in quotes is missing");
    std::string out;
    while (!take('"')) {
      if (at_ >= text_.size()) fail("a text is never closed");
      const char c = text_[at_++];
      if (c != '\\') {
        out += c;
        continue;
      }
      const char e = peek();
      ++at_;
      switch (e) {
      case 'n':
        out += '\n';
        break;
      case 't':
        out += '\t';
        break;
      case 'r':
        out += '\r';
        break;
      case 'b':
        out += '\b';
        break;
      case 'f':
        out += '\f';
        break;
      case 'u':
        code_point(out);
        break;
      case '"':
      case '\\':
      case '/':
        out += e;
        break;
      default:
        --at_, fail("an unknown escape");
      }
    }
    return out;
  }

  std::uint32_t four_digits() {
    std::uint32_t code = 0;
    for (int k = 0; k < 4; ++k) {
      const char c = peek();
      const int digit = c >= '0' && c <= '9'   ? c - '0'
                        : c >= 'a' && c <= 'f' ? c - 'a' + 10
                        : c >= 'A' && c <= 'F' ? c - 'A' + 10
                                               : -1;
      if (digit < 0) fail("\\u has four hexadecimal digits");
      code = 16 * code + static_cast<std::uint32_t>(digit);
      ++at_;
    }
    return code;
  }

  void code_point(std::string& out) {
    std::uint32_t c = four_digits();
    if (c >= 0xD800 && c < 0xDC00 && text_.substr(at_, 2) == "\\u") {
      at_ += 2;
      c = 0x10000 + ((c - 0xD800) << 10) + ((four_digits() - 0xDC00) & 0x3FF);
    }
    const auto byte = [&](std::uint32_t b) { out += static_cast<char>(b); };
    if (c < 0x80)
      byte(c);
    else if (c < 0x800)
      byte(0xC0 | c >> 6), byte(0x80 | (c & 63));
    else if (c < 0x10000)
      byte(0xE0 | c >> 12), byte(0x80 | (c >> 6 & 63)), byte(0x80 | (c & 63));
    else
      byte(0xF0 | c >> 18), byte(0x80 | (c >> 12 & 63)), byte(0x80 | (c >> 6 & 63)), byte(0x80 | (c & 63));
  }

  std::string_view number() {
    const std::size_t begin = at_;
    while (at_ < text_.size() && text_[at_] != ',' && text_[at_] != ']' && text_[at_] != '}' &&
           static_cast<unsigned char>(text_[at_]) > ' ')
      ++at_;
    std::string_view written = text_.substr(begin, at_ - begin);
    double ignored = 0;
    if (written == "null") return "nan";
    if (written.empty() || written.find('n') != std::string_view::npos || !parse_number(written, ignored))
      at_ = begin, fail("a number is missing");
    return written;
  }

  // Calls `element` for each one.
  template <class F>
  void array(F element) {
    if (!take('[')) fail("a list [ … ] is missing");
    for (bool first = true; space(), !take(']'); first = false) {
      if (!first && !take(',')) fail("a comma is missing");
      space();
      element();
    }
  }

  void columns() {
    std::vector<std::string> names;
    array([&] { names.push_back(string()); });
    run_.table.set_columns(std::move(names));
  }

  void rows() {
    RunTable& table = run_.table;
    array([&] {
      std::size_t column = 0;
      array([&] {
        if (column >= table.columns.size())
          fail(table.columns.empty() ? "the columns come before the rows"
                                     : "this row is longer than the list of columns");
        table.add(column++, number());
      });
      if (column != table.columns.size()) fail("this row is shorter than the list of columns");
    });
  }

  // Skips any value.
  void skip(int depth) {
    if (depth > kDeepest) fail("nested too deeply");
    space();
    if (peek() == '"') {
      string();
    } else if (peek() == '[') {
      array([&] { skip(depth + 1); });
    } else if (take('{')) {
      for (bool first = true; space(), !take('}'); first = false) {
        if (!first && !take(',')) fail("a comma is missing");
        space();
        string();
        space();
        if (!take(':')) fail("a colon is missing");
        skip(depth + 1);
      }
    } else {
      for (const std::string_view word : {"true", "false"})
        if (text_.substr(at_, word.size()) == word) {
          at_ += word.size();
          return;
        }
      number();
    }
  }

  std::string_view text_;
  std::size_t at_ = 0;
  RunFile run_;
};

}  // namespace

RunFile read_json_run(std::string_view text) { return JsonReader(text).read(); }

}  // namespace anholon
