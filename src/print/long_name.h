// Names of several letters in MathML, beside which products need a space and over which dots have no place.
#pragma once
#include <string_view>

namespace anholon {

// Whether an element is such a name: <mi>sin</mi>, <mi mathvariant="normal">mass</mi>.
bool is_long_name(std::string_view element);

}  // namespace anholon
