// Functions that the printer and the writing of names share.
#pragma once
#include <optional>
#include <string>
#include <utility>

#include "base/escape.h"

namespace anholon {

inline std::string row(const std::string& mathml) { return "<mrow>" + mathml + "</mrow>"; }
// "th[3]" is th with the index 3, "rolling[2].x" is rolling.x with the index 2; nullopt if there is no bracket.
std::optional<std::pair<std::string, std::string>> indexed_name(const std::string& name);

}  // namespace anholon
