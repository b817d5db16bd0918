#include "base/json.h"

namespace anholon {

void JsonWriter::separate() {
  if (after_key_) {
    after_key_ = false;
    return;
  }
  if (open_.empty()) return;
  if (!first_) out_ += ',';
  first_ = false;
  // Arrays of numbers stay on one line; objects get a line per entry.
  if (open_.back() == '{' || new_line_)
    out_ += "\n" + std::string(2 * open_.size(), ' ');
  else if (out_.back() == ',')
    out_ += ' ';
  new_line_ = false;
}

JsonWriter& JsonWriter::open(char bracket) {
  separate();
  out_ += bracket;
  open_.push_back(bracket);
  first_ = true;
  return *this;
}

JsonWriter& JsonWriter::close() {
  const char bracket = open_.back();
  open_.pop_back();
  if (bracket == '{' && !first_) out_ += "\n" + std::string(2 * open_.size(), ' ');
  out_ += bracket == '{' ? '}' : ']';
  first_ = false;
  return *this;
}

JsonWriter& JsonWriter::key(std::string_view name) {
  separate();
  out_ += '"' + json_escape(name) + "\": ";
  after_key_ = true;
  return *this;
}

JsonWriter& JsonWriter::raw(std::string_view text) {
  separate();
  out_ += text;
  return *this;
}

JsonWriter& JsonWriter::string(std::string_view value) { return raw('"' + json_escape(value) + '"'); }

JsonWriter& JsonWriter::number(std::string_view digits) {
  if (digits.find('n') != std::string_view::npos) return raw("null");  // nan, inf
  return raw(digits);
}

}  // namespace anholon
