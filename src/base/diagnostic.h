// Diagnostics: mistakes in the user's input, collected, with positions and with hints that work when pasted.
//
// A Diagnostic points into one source text. Code that finds something wrong inside one formula throws it as a Failure,
// which the reader of the enclosing element catches and collects, so that all errors of a file are reported at once.
#pragma once
#include <cstdint>
#include <exception>
#include <functional>
#include <string>
#include <vector>

namespace anholon {

// A place in a source text: 1-based line and column (in characters), length in characters.
// line 0 means "the text as a whole". A model may be read from several files: file 0 is the one that was named, file k
// > 0 the (k-1)th of SourceText::others.
struct Span {
  std::uint32_t line = 0, column = 0, length = 1, file = 0;
};

enum class Severity : std::uint8_t { error, warning, note };

struct Diagnostic {
  Severity severity = Severity::error;
  Span span;
  std::string message;
  std::string hint;
};

struct Failure : std::exception {
  Diagnostic diagnostic;
  explicit Failure(Diagnostic d) : diagnostic(std::move(d)) {}
  Failure(Span span, std::string message, std::string hint = {})
      : diagnostic{Severity::error, span, std::move(message), std::move(hint)} {}
  const char* what() const noexcept override { return diagnostic.message.c_str(); }
};

// A text with a name, as read from a file; lines are looked up for printing.
struct SourceText {
  std::string name;
  std::string text;
  std::string path = {};                // the path of the file, if it differs from the name
  std::vector<SourceText> others = {};  // the files that this text refers to
  // The data files of its tables, under the names by which tables refer to them; such a file is not read from disk again.
  std::vector<SourceText> tables = {};
  std::string line(std::uint32_t number) const;
  const SourceText& of(Span span) const {
    return span.file == 0 || span.file > others.size() ? *this : others[span.file - 1];
  }
};

class Diagnostics {
 public:
  void add(Diagnostic d) { list_.push_back(std::move(d)); }
  void error(Span span, std::string message, std::string hint = {});
  void warning(Span span, std::string message, std::string hint = {});
  bool has_errors() const;
  const std::vector<Diagnostic>& list() const { return list_; }
  // Replaces all reports whose message satisfies `is_one` and that differ only in their position by the first of them,
  // with their number in its message.
  void gather(const std::function<bool(const std::string&)>& is_one);
  // Removes the errors whose message is a consequence of others.
  void leave_out(const std::function<bool(const std::string&)>& is_consequence);
  // Returns `file:line:col: error: …`, the source line, a caret range, `hint: …`; in order of position.
  std::string print(const SourceText& source) const;
  // The files besides the main one, if the code that reports here has found them.
  std::vector<SourceText> others;

 private:
  std::vector<Diagnostic> list_;
};

std::string print(const Diagnostic& d, const SourceText& source);
// Returns `file:line:col:`, the source line, a caret range; empty without a line.
std::string print_place(Span span, const SourceText& source);
// Returns "line 12", and the file if it is not the main one.
std::string line_of(Span span, const SourceText& source);

// Returns the candidate closest to `name` by edit distance if it is close enough to be a typing error, else "".
std::string did_you_mean(const std::string& name, const std::vector<std::string>& candidates);

}  // namespace anholon
