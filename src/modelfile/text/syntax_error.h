// Describes syntax errors of TOML in words for users.
#pragma once
#include <string_view>

#include "base/diagnostic.h"

namespace anholon {

// Returns the mistake that the parser found at this place and describes in its own words. Common mistakes are
// recognized by the text of the line; for others the parser's description is given.
Failure syntax_error(std::string_view description, Span span, const SourceText& source);

}  // namespace anholon
