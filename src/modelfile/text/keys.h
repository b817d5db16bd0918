// Checks the keys of a section, which are known to the language or mistakes.
#pragma once
#include <string>

#include "base/diagnostic.h"
#include "modelfile/text/toml.h"

namespace anholon {

// Reports keys of `table` that the language does not have there (language_section(section)); `where` is the author's
// name for the table.
void check_keys(const Item& table, const std::string& where, const std::string& section, Diagnostics& diagnostics);

// True if a key that check_keys() reports was meant to be `key`: it resembles it, or its hint is about it.
bool is_misspelt(const std::string& key, const Item& table, const std::string& section);

// Returns the section of that name; nullptr if there is none, or if its value is not a section (reported).
const Item* find_section(const Item& root, const char* key, Diagnostics& diagnostics);

// Returns the text of unit = "km/h"; throws Failure if it is not a unit.
std::string unit_text(const Item& item);

}  // namespace anholon
