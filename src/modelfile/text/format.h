// Formats a model file in its usual layout. The order, the comments and the text of every value are kept; blanks, blank
// lines, the alignment of = and of comments, and the lines of lists are changed.
//
//   key = value          consecutive lines have their = in one column, and their comments
//   [a, b], {k = v}      on one line up to 120 characters; a list that the author broke, or that is wider, has one element on each
//                        line, a list of numbers as many as fit. Blanks that align tables below each other stay.
//   [section]            with an empty line before it and none after it
#pragma once
#include <string>

#include "base/diagnostic.h"
#include "modelfile/text/toml.h"

namespace anholon {

// Returns the formatted text. Throws Failure if the text is not TOML, or if its layout cannot be changed without
// changing its content.
std::string formatted(const SourceText& source);

// True if both have the same content, apart from position and layout.
bool same_content(const Item& a, const Item& b);

}  // namespace anholon
