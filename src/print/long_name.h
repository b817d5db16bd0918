// Names of several letters in MathML, which need a space in products and primes instead of dots.
#pragma once
#include <string_view>

namespace anholon {

// True if an element is such a name: <mi>sin</mi>, <mi mathvariant="normal">mass</mi>.
bool is_long_name(std::string_view element);

}  // namespace anholon
