// The language of model files, for people and for editors, from the table that the reader uses.
#pragma once
#include <string>
#include <vector>

namespace anholon {

// The page doc/language.md.
std::string reference_page();
// The part of one section, which a word names or is about ("contact", "friction"), or that of formulas, with the model that
// its examples complete. Throws Failure if there is no such section.
std::string reference_section(const std::string& word);
bool is_in_reference(const std::string& word);
// The words that name a section or are about one.
std::vector<std::string> reference_words();

// A JSON Schema (draft 7) for language servers of TOML: doc/anholon.schema.json.
std::string reference_schema();

}  // namespace anholon
