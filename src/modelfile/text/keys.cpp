#include "modelfile/text/keys.h"

#include <algorithm>

#include "formula/units.h"
#include "modelfile/language/language.h"

namespace anholon {

void check_keys(const Item& table, const std::string& where, const std::string& section, Diagnostics& diagnostics) {
  const std::vector<std::string> known = known_keys(language_section(section));
  for (const Item& i : table.items) {
    if (std::find(known.begin(), known.end(), i.key) != known.end()) continue;
    const std::string near = did_you_mean(i.key, known);
    std::string hint;
    if (near.empty()) {
      hint = "known here: ";
      for (std::size_t k = 0; k < known.size(); ++k) hint += (k ? ", " : "") + known[k];
    }
    diagnostics.error(i.key_span,
                      "unknown key '" + i.key.substr(0, 60) + "' in " + where +
                          (near.empty() ? "" : "; did you mean '" + near + "'?"),
                      hint);
  }
}

const Item* find_section(const Item& root, const char* key, Diagnostics& diagnostics) {
  const Item* section = root.find(key);
  if (!section || section->kind == Item::Kind::table) return section;
  diagnostics.error(section->span, std::string("'") + key + "' is a section", std::string("write [") + key + "]");
  return nullptr;
}

std::string unit_text(const Item& item) {
  if (item.kind != Item::Kind::string) throw Failure(item.span, "a unit is a text", "unit = \"km\"");
  const std::string text = normal_name(item.text());
  if (read_unit(text)) return text;
  const std::string near = did_you_mean(text, unit_names());
  throw Failure(item.formula.whole(),
                "'" + text.substr(0, 40) + "' is no unit" + (near.empty() ? "" : "; did you mean '" + near + "'?"),
                "unit = \"km\", \"m/s^2\", \"N*m\"");
}

}  // namespace anholon
