// The keys of a section: known to the language, or a slip.
#pragma once
#include <string>

#include "base/diagnostic.h"
#include "modelfile/text/toml.h"

namespace anholon {

// Reports keys of `table` that the language does not have there (language_section(section)); `where` is what the author
// knows the table by.
void check_keys(const Item& table, const std::string& where, const std::string& section, Diagnostics& diagnostics);

// The section of that name; null where there is none, or what stands there is none (reported).
const Item* find_section(const Item& root, const char* key, Diagnostics& diagnostics);

// The text of unit = "km/h"; throws if it is none.
std::string unit_text(const Item& item);

}  // namespace anholon
