// A TOML document as a tree in the order of the file, every formula with the position of each of its characters. Only
// toml.cpp uses toml++.
#pragma once
#include <string>
#include <vector>

#include "base/diagnostic.h"
#include "formula/formula.h"

namespace anholon {

struct Item {
  enum class Kind : std::uint8_t { string, number, boolean, array, table, other };
  Kind kind = Kind::table;
  std::string key;  // in a table; as normal_name() gives it if it is one word
  Span key_span, span;
  FormulaText formula;      // for strings and numbers (the digits as written)
  bool truth = false;       // for booleans
  std::vector<Item> items;  // for arrays and tables
  std::string member;       // for a member of a family: its name in messages, "P[3]"

  const Item* find(const std::string& name) const;
  bool is_formula() const { return kind == Kind::string || kind == Kind::number; }
  const std::string& text() const { return formula.text(); }
};

// Reads a TOML text. Throws Failure on a syntax error of TOML itself. All positions have this file number (Span::file).
Item read_toml(const SourceText& source, std::uint32_t file = 0);

}  // namespace anholon
