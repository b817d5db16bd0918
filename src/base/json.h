// JSON text, written in order. Numbers are given as text, so that any precision passes through.
#pragma once
#include <string>
#include <string_view>
#include <vector>

#include "base/escape.h"

namespace anholon {

class JsonWriter {
 public:
  JsonWriter& open_object() { return open('{'); }
  JsonWriter& open_array() { return open('['); }
  JsonWriter& close();
  JsonWriter& key(std::string_view name);
  JsonWriter& string(std::string_view value);
  JsonWriter& number(std::string_view digits);  // "nan" and "inf" become null
  JsonWriter& integer(long long value) { return raw(std::to_string(value)); }
  JsonWriter& boolean(bool value) { return raw(value ? "true" : "false"); }
  JsonWriter& null() { return raw("null"); }
  JsonWriter& new_line() {
    new_line_ = true;
    return *this;
  }  // before the next element of an array
  const std::string& text() const { return out_; }

 private:
  JsonWriter& open(char bracket);
  JsonWriter& raw(std::string_view text);
  void separate();
  std::string out_;
  std::vector<char> open_;
  bool first_ = true, after_key_ = false, new_line_ = false;
};

}  // namespace anholon
