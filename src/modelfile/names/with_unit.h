// Numbers of a model file that are written with a unit.
#pragma once
#include "base/diagnostic.h"

namespace anholon {

// True if the value of the key at this place contains a number with a unit: theta = "45 rad". Reads the text again.
// False if there is no such key.
bool is_with_unit(const SourceText& source, Span key);

}  // namespace anholon
