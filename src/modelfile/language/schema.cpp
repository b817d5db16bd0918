#include "base/json.h"
#include "modelfile/language/language.h"
#include "modelfile/language/reference.h"

namespace anholon {

namespace {

using Form = LanguageSection::Form;

void type(JsonWriter& j, std::initializer_list<const char*> types) {
  j.key("type");
  if (types.size() == 1) {
    j.string(*types.begin());
    return;
  }
  j.open_array();
  for (const char* t : types) j.string(t);
  j.close();
}

void keys(JsonWriter& j, const LanguageSection& s, bool others = false);

void list_of(JsonWriter& j, std::initializer_list<const char*> types) {
  type(j, {"array"});
  j.key("items").open_object();
  type(j, types);
  j.close();
}

// Writes the schema of a key's value; `list`: values for the members of a family are allowed.
void content(JsonWriter& j, Content c, const std::vector<std::string>& choices = {}) {
  switch (c) {
  case Content::text:
  case Content::name:
  case Content::rotation:
  case Content::equation:
    return type(j, {"string"});
  case Content::names:
    return type(j, {"string", "array"});
  case Content::formula:
  case Content::number:
    return type(j, {"string", "number"});
  case Content::vector:
  case Content::inertia:
    return type(j, {"string", "number", "array"});
  case Content::equations:
    return list_of(j, {"string"});
  case Content::numbers:
    return list_of(j, {"string", "number"});
  case Content::columns:
    return list_of(j, {"string", "number"});
  case Content::truth:
    return type(j, {"boolean"});
  case Content::choice:
    j.key("enum").open_array();
    for (const std::string& w : choices) j.string(w);
    j.close();
    return;
  case Content::place:
    j.key("anyOf").open_array().open_object();
    type(j, {"string"});
    j.close().open_object();
    keys(j, language_section("force.on"));
    j.close().close();
    return;
  case Content::formulas:
  case Content::values:
    return type(j, {"object"});
  case Content::any:
    return;
  }
}

// Returns the description of a key without the marks of Markdown.
std::string plain(const std::string& markdown) {
  std::string out;
  for (char c : markdown)
    if (c != '`') out += c;
  return out;
}

void properties(JsonWriter& j, const LanguageSection& s) {
  for (const LanguageKey& k : s.keys) {
    j.key(k.name).open_object();
    if (*k.meaning) j.key("description").string(plain(k.meaning));
    if (std::string(s.name) == "body" && std::string(k.name) == "axes") {
      type(j, {"array"});
      j.key("items").open_object();
      keys(j, language_section("body.axes"));
      j.close();
    } else {
      content(j, k.content, k.choices);
    }
    j.close();
  }
}

// Writes the schema of a table of these keys and, if `others`, of names chosen by the author.
void keys(JsonWriter& j, const LanguageSection& s, bool others) {
  type(j, {"object"});
  j.key("properties").open_object();
  properties(j, s);
  j.close();
  j.key("additionalProperties").boolean(others);
}

void section(JsonWriter& j, const LanguageSection& s) {
  switch (s.form) {
  case Form::top:
  case Form::part:
    return;
  case Form::keys:
    return keys(j, s);
  case Form::elements:
    // In a file with a base, and in a case, elements may be named: constraint.reel.equation = "…".
    j.key("anyOf").open_array().open_object();
    type(j, {"array"});
    j.key("items").open_object();
    keys(j, s);
    j.close().close().open_object();
    type(j, {"object"});
    j.key("additionalProperties").open_object();
    keys(j, s);
    j.close().close().close();
    return;
  case Form::named:
    if (std::string(s.name) == "initial" || std::string(s.name) == "view") return keys(j, s, true);
    type(j, {"object"});
    if (std::string(s.name) == "case") return;
    j.key("additionalProperties").open_object().key("anyOf").open_array();
    // The value is alone, a list of values for the members of a family, or a table of its keys.
    j.open_object();
    type(j, {"string", "number", "array"});
    j.close().open_object();
    if (s.keys.empty()) {
      type(j, {"object"});
      j.key("maxProperties").integer(0);  // {}: an unknown key
    } else {
      keys(j, s);
    }
    j.close().close().close();
    return;
  }
}

}  // namespace

std::string reference_schema() {
  JsonWriter j;
  j.open_object();
  j.key("$schema").string("http://json-schema.org/draft-07/schema#");
  j.key("title").string("Anholon model file");
  type(j, {"object"});
  j.key("properties").open_object();
  properties(j, language_section(""));
  for (const LanguageSection& s : language()) {
    if (s.form == Form::top || s.form == Form::part) continue;
    j.key(s.name).open_object();
    section(j, s);
    j.close();
  }
  j.close();
  j.key("additionalProperties").boolean(false);
  return j.close().text() + "\n";
}

}  // namespace anholon
