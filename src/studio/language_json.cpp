#include "base/json.h"
#include "modelfile/language/language.h"
#include "studio/answers.h"

namespace anholon {

std::string language_json() {
  JsonWriter json;
  json.open_object().key("sections").open_array();
  for (const LanguageSection& s : language()) {
    json.new_line().open_object().key("name").string(s.name);
    json.key("form").string(s.form == LanguageSection::Form::top        ? "top"
                            : s.form == LanguageSection::Form::keys     ? "keys"
                            : s.form == LanguageSection::Form::elements ? "elements"
                            : s.form == LanguageSection::Form::named    ? "named"
                                                                        : "part");
    json.key("keys").open_array();
    for (const LanguageKey& k : s.keys) {
      json.open_object().key("name").string(k.name).key("meaning").string(k.meaning).key("choices").open_array();
      for (const std::string& c : k.choices) json.string(c);
      json.close().close();
    }
    json.close().close();
  }
  json.close().key("functions").open_array();
  for (const std::vector<FunctionRow>* table : {&function_table(), &kinematic_functions()})
    for (const FunctionRow& f : *table)
      json.open_object().key("name").string(f.name).key("call").string(f.call).key("meaning").string(f.meaning).close();
  json.close().key("reserved").open_array();
  for (const ReservedName& r : reserved_names())
    json.open_object().key("name").string(r.name).key("meaning").string(r.meaning).close();
  return json.close().close().text();
}

}  // namespace anholon
