// The keys of a section: known, known but not read yet, or a slip.
#pragma once
#include <string>
#include <vector>

#include "base/diagnostic.h"
#include "spec/toml.h"

namespace anholon {

// Reports keys of `table` that are neither in `known` nor in `later`; those in `later` belong to the
// language but are not read by this version, and say so.
void check_keys(const Item& table, const std::string& where, const std::vector<std::string>& known,
                const std::vector<std::string>& later, Diagnostics& diagnostics);

// The section of that name; null where there is none, or what stands there is none (reported).
const Item* find_section(const Item& root, const char* key, Diagnostics& diagnostics);

// The text of unit = "km/h"; throws if it is none.
std::string unit_text(const Item& item);

}  // namespace anholon
