// Syntax errors of TOML in the words of a user.
#pragma once
#include <string_view>

#include "base/diagnostic.h"

namespace anholon {

// The mistake that the parser found at this place and describes in its own words. Common mistakes are known by the text
// of the line; of others the parser's description is given.
Failure syntax_error(std::string_view description, Span span, const SourceText& source);

}  // namespace anholon
