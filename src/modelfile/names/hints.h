// Hints about names of a model file that other readers of formulas replace by their own words.
#pragma once

namespace anholon {

// The hint for an unknown name that resembles no known name.
inline constexpr const char* kGiveItAValue = "give it a value under [parameters] or [define]";

}  // namespace anholon
