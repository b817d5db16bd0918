// MathML that wraps: a long formula is written as many short ones in a line of text, and a browser may break the line
// between them.
//
// MathML Core has no line breaking. A formula of this program is a row of elements; it may be broken before every + and
// − outside brackets, and within long brackets. A long numerator is taken out of its fraction: a/b = (1/b)(a).
#pragma once
#include <string>
#include <vector>

namespace anholon {

// The pieces of a row of presentation MathML from print(), without the enclosing <math>.
std::vector<std::string> math_pieces(const std::string& row);
// All pieces in <math> elements, with places for line breaks between them.
std::string wrapping_math(const std::string& row);

}  // namespace anholon
