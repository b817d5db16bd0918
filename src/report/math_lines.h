// MathML that wraps: a long formula as many short ones on a line of text, between which a browser may begin a new line.
//
// MathML Core has no line breaking. A formula of ours is a row of elements; it may be broken before every + and − that
// stands free, and, where what stands in brackets is long, within them. A long numerator is taken out of its fraction:
// a/b = (1/b)(a).
#pragma once
#include <string>
#include <vector>

namespace anholon {

// The pieces of a row of presentation MathML as print() makes it, without <math> round them.
std::vector<std::string> math_pieces(const std::string& row);
// All of them in <math> elements, with places to break between them.
std::string wrapping_math(const std::string& row);

}  // namespace anholon
