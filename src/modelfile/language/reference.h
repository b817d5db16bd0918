// The documentation of the language of model files, for people and for editors, from the table that the reader uses.
#pragma once
#include <string>
#include <vector>

namespace anholon {

// Returns the page doc/language.md.
std::string reference_page();
// Returns the part of one section, of which the word is the name or the subject ("contact", "friction"), or the part of
// formulas, with the model that its examples complete. Throws Failure if there is no such section.
std::string reference_section(const std::string& word);
bool is_in_reference(const std::string& word);
// Returns the words that are names or subjects of sections.
std::vector<std::string> reference_words();

// Returns a JSON Schema (draft 7) for language servers of TOML: doc/anholon.schema.json.
std::string reference_schema();

}  // namespace anholon
