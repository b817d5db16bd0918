// The formats in which expressions and names are printed.
#pragma once
#include <cstdint>

namespace anholon {

enum class Format : std::uint8_t { text, latex, mathml };

}  // namespace anholon
