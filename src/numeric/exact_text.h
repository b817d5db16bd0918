// Numbers as text that reads back to the same bits in any number type: hexadecimal, as C's %a prints them.
#pragma once
#include <optional>
#include <string>

#include "numeric/number.h"

namespace anholon {

template <Number N>
std::string exact_text(const N& x);

// Reads a number; nullopt if the text is no number. A Multi has the working precision.
template <Number N>
std::optional<N> parse_exact(const std::string& text);

}  // namespace anholon
