// A TOML document as a tree in the order of the file, every formula with the place of each of its
// characters. This is the only face of toml++ in the house.
#pragma once
#include <string>
#include <vector>

#include "base/diagnostic.h"
#include "formula/formula.h"

namespace anholon {

struct Item {
  enum class Kind : std::uint8_t { string, number, boolean, array, table, other };
  Kind kind = Kind::table;
  std::string key;  // in a table; normal_name'd where it is one word
  Span key_span, span;
  FormulaText formula;      // of strings and numbers (the digits as written)
  bool truth = false;       // of booleans
  std::vector<Item> items;  // of arrays and tables
  std::string member;       // of a family: what it is called in messages, "P[3]"

  const Item* find(const std::string& name) const;
  bool is_formula() const { return kind == Kind::string || kind == Kind::number; }
  const std::string& text() const { return formula.text(); }
};

// Throws Failure on a syntax error of TOML itself. All its places are in this file (Span::file).
Item read_toml(const SourceText& source, std::uint32_t file = 0);

}  // namespace anholon
