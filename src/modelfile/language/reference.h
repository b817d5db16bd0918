// The language of model files, for people and for editors, from the table that the reader uses.
#pragma once
#include <string>

namespace anholon {

// The page doc/language.md, or the part of one section. Throws Failure if there is no section of that name.
std::string reference_page();
std::string reference_section(const std::string& name);

// A JSON Schema (draft 7) for language servers of TOML: doc/anholon.schema.json.
std::string reference_schema();

}  // namespace anholon
