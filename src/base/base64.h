// Bytes as text and back (RFC 4648, section 4).
#pragma once
#include <string>
#include <string_view>

namespace anholon {

std::string to_base64(std::string_view bytes);
// Returns an empty string if the text is not base64.
std::string from_base64(std::string_view text);

}  // namespace anholon
