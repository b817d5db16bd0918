// The tokens of a formula, in order: names with Greek letters written out, numbers, operators in all their spellings.
#pragma once
#include "formula/formula.h"

namespace anholon {

enum class Token : std::uint8_t {
  number,
  name,
  plus,
  minus,
  times,
  over,
  caret,
  prime,
  superscript,
  open,
  close,
  left,
  right,
  comma,
  point,
  equals,
  middle_dot,
  cross_sign,
  compare,
  end,
};

struct Lexeme {
  Token token = Token::end;
  std::string text;
  std::size_t offset = 0, length = 1;  // in characters
};

// Returns the tokens, the last of which is Token::end. Throws Failure at a character without meaning.
std::vector<Lexeme> lexemes(const FormulaText& source);

}  // namespace anholon
