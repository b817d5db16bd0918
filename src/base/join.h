// Lists as text.
#pragma once
#include <string>
#include <string_view>
#include <vector>

namespace anholon {

// Returns "a, b, c".
std::string joined(const std::vector<std::string>& parts, std::string_view between = ", ");

}  // namespace anholon
