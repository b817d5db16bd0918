// Numbers as text that reads back to the same bits in any number type: hexadecimal, as C's %a writes them.
#pragma once
#include <optional>
#include <string>

#include "numeric/number.h"

namespace anholon {

template <Number N>
std::string exact_text(const N& x);

// Nothing if the text is no number. In Multi the number has the working precision.
template <Number N>
std::optional<N> parse_exact(const std::string& text);

}  // namespace anholon
