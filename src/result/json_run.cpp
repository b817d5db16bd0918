#include "result/json_run.h"

#include <cmath>
#include <cstdio>

#include "base/diagnostic.h"
#include "base/json.h"
#include "base/stop.h"
#include "base/utf8.h"
#include "numeric/number.h"
#include "result/file.h"
#include "result/format.h"
#include "result/shortest.h"

namespace anholon {

namespace {

// Takes numbers as they are written, and keeps the text beside the rows: a general reader would round the numbers and
// reformat the rest.
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

  // Calls `element` for each element.
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
        // The file of a sweep contains words, too: outcomes and events.
        if (peek() == '"')
          table.add(column++, string());
        else
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

// Appends the number, or the word, in JSON's syntax.
void append_json_number(std::string& to, const RunTable& table, std::size_t row, std::size_t column) {
  const bool has_text =
      column < table.texts.size() && row < table.texts[column].size() && !table.texts[column][row].empty();
  const double value = table.values[column][row];
  if (double ignored = 0; has_text && !parse_number(table.text(row, column), ignored)) {
    to += '"' + json_escape(table.text(row, column)) + '"';
  } else if (has_text) {
    const std::string number = json_number(table.text(row, column));
    to += number.find('n') == std::string::npos ? number : "null";
  } else if (std::isfinite(value)) {
    char text[kShortestRoom];
    to.append(text, write_shortest(text, value));
  } else {
    to += "null";
  }
}

// Calls write(text) for columns and rows piece by piece, in the form that they have in the JSON of `simulate`.
template <class F>
void write_json_rows(const RunTable& table, F write) {
  constexpr std::size_t kPiece = 1u << 20;
  JsonWriter head;
  head.open_object().key("columns").open_array();
  for (const std::string& n : table.columns) head.string(n);
  head.close().key("rows");
  std::string piece = head.text().substr(1) + "[";
  for (std::size_t i = 0; i < table.rows(); ++i) {
    piece += i == 0 ? "[" : ", [";
    for (std::size_t c = 0; c < table.columns.size(); ++c) {
      if (c > 0) piece += ", ";
      append_json_number(piece, table, i, c);
    }
    piece += ']';
    if (piece.size() < kPiece) continue;
    look_for_stop();
    write(piece), piece.clear();
  }
  write(piece += ']');
}

// Calls write(text) for the whole file piece by piece.
template <class F>
void write_json_run(const RunFile& run, F write) {
  const std::string& report = run.report;
  if (report.size() < 2) {
    write("{");
    write_json_rows(run.table, write);
    return write("\n}\n");
  }
  // The rows are at the place where `simulate` writes them: after the model and the form.
  const std::size_t found = report.find("\n  \"residuals\":"), place = found == std::string::npos ? 1 : found;
  write(report.substr(0, place));
  write_json_rows(run.table, write);
  write("," + report.substr(place) + "\n");
}

// Keeps the rows until there is a report.
class JsonRunWriter final : public RunWriter {
 public:
  JsonRunWriter(const std::string& path, const RunInfo& info) : file_(path) { static_cast<RunInfo&>(run_) = info; }
  const std::string& error() const override { return file_.error(); }
  void columns(const std::vector<RunColumn>& columns) override { rows_.columns(columns); }
  void row(const Row& row) override { rows_.row(row); }
  void step(double t) override { rows_.step(t); }
  void flush() override {}
  std::string close(const std::string& report) override {
    run_.report = report;
    write_json_run(run_, [&](const std::string& piece) { file_.write(piece); });
    return file_.close();
  }

 private:
  GrowingFile file_;
  RunFile run_;
  RunSink rows_{run_};
};

// Writes line by line, because there may be more cases than memory can contain.
class JsonSweepWriter final : public SweepWriter {
 public:
  JsonSweepWriter(const std::string& path, const SweepInfo& info) : file_(path), columns_(info.columns) {
    if (!error().empty()) return;
    std::string names;
    for (const SweepColumn& c : columns_) names += (names.empty() ? "\"" : ", \"") + json_escape(c.name) + "\"";
    file_.write("{\n  \"model\": \"" + json_escape(info.origin.title) + "\",\n  \"form\": \"" + json_escape(info.form) +
                "\",\n  \"columns\": [" + names + "],\n  \"rows\": [");
  }
  const std::string& error() const override { return file_.error(); }
  void row(std::span<const SweepCell> cells) override {
    JsonWriter j;
    j.open_array();
    for (std::size_t k = 0; k < cells.size(); ++k)
      if (columns_[k].holds == SweepColumn::Holds::words)
        cells[k].word.empty() ? j.null() : j.string(cells[k].word);
      else
        j.number(written_number(columns_[k], cells[k].number));
    file_.write((any_ ? ",\n    " : "\n    ") + j.close().text());
    any_ = true;
  }
  std::string close(const std::string& report) override {
    file_.write(std::string(any_ ? "\n  " : "") + "]," + report.substr(1) + "\n");
    return file_.close();
  }

 private:
  GrowingFile file_;
  std::vector<SweepColumn> columns_;
  bool any_ = false;
};

bool looks_like_json(std::string_view beginning) {
  const std::size_t first = beginning.find_first_not_of(" \t\r\n");
  return first != std::string_view::npos && beginning[first] == '{';
}

}  // namespace

RunFile read_json_run(std::string_view text) { return JsonReader(text).read(); }

std::string json_run(const RunFile& run) {
  std::string text;
  write_json_run(run, [&](const std::string& piece) { text += piece; });
  return text;
}

extern const ResultFormat json_format;
const ResultFormat json_format = {
    .name = "JSON",
    .endings = {".json"},
    .holds = Holds::report,
    .without_rows = true,
    .most_numbers = 5'000'000,
    .recognizes = looks_like_json,
    .read_text = read_json_run,
    .write =
        [](const std::string& path, const RunFile& run) {
          return write_stream(path, [&](std::FILE* file) {
            bool written = true;
            write_json_run(run, [&](const std::string& piece) {
              written = written && std::fwrite(piece.data(), 1, piece.size(), file) == piece.size();
            });
            return written;
          });
        },
    .open = [](const std::string& path, const RunInfo& info) -> std::unique_ptr<RunWriter> {
      return std::make_unique<JsonRunWriter>(path, info);
    },
    .open_sweep = [](const std::string& path, const SweepInfo& info) -> std::unique_ptr<SweepWriter> {
      return std::make_unique<JsonSweepWriter>(path, info);
    },
};

}  // namespace anholon
