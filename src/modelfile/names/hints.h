// Hints about names of a model file that other readers of formulas put in their own words.
#pragma once

namespace anholon {

// Where a name is unknown and resembles none that is known.
inline constexpr const char* kGiveItAValue = "give it a value under [parameters] or [define]";

}  // namespace anholon
