// The language of model files as one table: its sections, their keys, the types of their values, and their
// documentation. The reader takes the known keys from this table, `anholon reference` prints it, and editors get it as
// a JSON Schema, so all three agree.
#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "formula/functions.h"

namespace anholon {

// The type of a key's value.
enum class Content : std::uint8_t {
  text,
  name,
  names,
  formula,
  vector,
  rotation,
  equation,
  equations,
  number,
  numbers,
  truth,
  choice,
  inertia,
  place,
  columns,
  formulas,  // a table of formulas by name
  values,    // like formulas, and tables of them by name
  any,
};

struct LanguageKey {
  const char* name;
  Content content;
  const char* meaning;                    // in Markdown, without full stop
  std::vector<std::string> choices = {};  // the values of a choice
};

struct LanguageSection {
  enum class Form : std::uint8_t {
    top,       // the file itself
    keys,      // [gravity]: these keys
    elements,  // [[body]]: a list of tables with these keys
    named,     // [define]: names chosen by the author, all with the same content, or with a table of these keys
    part,      // a table within a section, called NAME of that section and the key: "force.on"
  };
  const char* name;
  Form form;
  Content content;  // the content of each name of a `named` section
  std::vector<LanguageKey> keys;
  const char* page;                     // Markdown: examples first, then the rules for doubtful cases
  std::vector<std::string> words = {};  // further words for its subject, by which a reader can find its page
};

// Returns the sections in the order of the reference page.
const std::vector<LanguageSection>& language();
const LanguageSection& language_section(const std::string& name);
// Returns the section with this name, with its plural, or with this word for its subject, in small or capital letters;
// nullptr if there is none.
const LanguageSection* find_subject(const std::string& word);

// Returns the keys of a section; for the file itself also the names of the sections.
std::vector<std::string> known_keys(const LanguageSection& section);

// A name that has a meaning everywhere and cannot be declared.
struct ReservedName {
  const char* name;
  const char* meaning;
};
const std::vector<ReservedName>& reserved_names();
bool is_reserved(const std::string& name);

// Returns the functions of formulas that need the model: velocities, angular velocities, the field of gravity.
const std::vector<FunctionRow>& kinematic_functions();

// The parts of the table, each in a file of its own.
std::vector<LanguageSection> language_of_files();
std::vector<LanguageSection> language_of_names();
std::vector<LanguageSection> language_of_bodies();
std::vector<LanguageSection> language_of_motion();

}  // namespace anholon
