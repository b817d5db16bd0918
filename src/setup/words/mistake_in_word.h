// A mistake in a word that is given beside a model: a range, a variation, a line of a table of cases, a reduction.
#pragma once
#include <algorithm>
#include <string>

#include "base/diagnostic.h"

namespace anholon {

struct MistakeInWord {
  Diagnostic diagnostic;  // with its place in the word
  std::string word;
  std::string file = {};  // the file of the word, if it is from a file
};

// Throws MistakeInWord, which marks a part of the word.
[[noreturn]] inline void mistake_in(const std::string& word, std::size_t at, std::size_t length,
                                    const std::string& message, const std::string& hint) {
  Span span;
  span.line = 1;
  span.column = static_cast<decltype(span.column)>(at + 1);
  span.length = static_cast<decltype(span.length)>(std::max<std::size_t>(length, 1));
  throw MistakeInWord{{Severity::error, span, message, hint}, word};
}

}  // namespace anholon
