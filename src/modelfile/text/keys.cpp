#include "modelfile/text/keys.h"

#include <algorithm>
#include <string_view>
#include <vector>

#include "formula/units.h"
#include "modelfile/language/language.h"

namespace anholon {

namespace {

// The hints for words of textbooks and other programs in a section; "" is the top of a model.
struct OtherWord {
  const char* section;
  std::vector<std::string_view> words;
  const char* hint;
};

const std::vector<OtherWord>& other_words() {
  static const std::vector<OtherWord> list = {
      {"",
       {"T", "kinetic", "kinetic_energy"},
       "the kinetic energy is that of the masses: write [[body]] or [[particle]]"},
      {"",
       {"L", "lagrangian", "Lagrangian"},
       "write the masses as [[body]] or [[particle]], and the potential energy under [potential] as V = \"…\""},
      {"", {"V", "U", "potential_energy"}, "[potential] with V = \"m*g*y\", or [gravity]"},
      {"", {"q", "variables", "generalized_coordinates", "dofs"}, "coordinates = [\"x\", \"y\"]"},
      {"",
       {"let", "var", "const", "def", "definitions"},
       "numbers stand under [parameters], formulas under [define], functions of t under [functions]"},
      {"", {"constants", "values"}, "[parameters] with m = \"2 kg\""},
      {"", {"generalized_forces", "Q"}, "[[force]] with generalized = {x = \"-k*x\"}"},
      {"", {"initial_conditions", "x0", "ic"}, "[initial] with x = 1 and \"x'\" = 0"},
      {"particle",
       {"inertia", "axes", "orientation", "angle", "shape"},
       "a particle is a point; with an orientation it is a [[body]], whose place is 'center'"},
      {"contact", {"distance", "penetration"}, "gap = \"P.z - R\", which is not negative"},
      {"contact", {"bodies", "body1"}, "body = \"NAME\" for the body that touches"},
      {"contact",
       {"mu", "mu_k", "mu_d", "kinetic_friction", "dynamic_friction", "sliding_friction", "friction_coefficient"},
       "friction = 0.3"},
      {"contact", {"radius", "size"}, "shape = \"ball(R)\", or the shape of the body"},
      {"contact",
       {"with", "other", "body2", "against", "to"},
       "'body' names one body, which touches a plane; on = \"ball(R)\" with through = \"B.center\" where the other "
       "body B is a ball"},
      {"contact", {"mu_s", "mu_0", "sticking_friction"}, "static_friction = 0.4"},
      {"contact", {"e", "epsilon", "cor", "coefficient_of_restitution"}, "restitution = 0.5"},
      {"contact",
       {"stiffness", "damping", "k", "c"},
       "contacts are rigid; a soft one is a [[force]] with vector = \"-k*min(P.z, 0)*ez\""},
  };
  return list;
}

// Returns the hint for such a word; empty for any other word.
std::string hint_for_other_word(const std::string& section, const std::string& word) {
  for (const OtherWord& o : other_words())
    if (section == o.section && std::find(o.words.begin(), o.words.end(), word) != o.words.end()) return o.hint;
  return "";
}

bool is_among(const std::vector<std::string>& known, const std::string& key) {
  return std::find(known.begin(), known.end(), key) != known.end();
}

std::string list_of(const std::vector<std::string>& known) {
  std::string list = "known here: ";
  for (std::size_t k = 0; k < known.size(); ++k) list += (k ? ", " : "") + known[k];
  return list;
}

}  // namespace

void check_keys(const Item& table, const std::string& where, const std::string& section, Diagnostics& diagnostics) {
  const std::vector<std::string> known = known_keys(language_section(section));
  for (const Item& i : table.items) {
    if (is_among(known, i.key)) continue;
    const std::string other = hint_for_other_word(section, i.key),
                      near = other.empty() ? did_you_mean(i.key, known) : "";
    diagnostics.error(i.key_span,
                      "unknown key '" + i.key.substr(0, 60) + "' in " + where +
                          (near.empty() ? "" : "; did you mean '" + near + "'?"),
                      !other.empty() ? other
                      : near.empty() ? list_of(known)
                                     : "");
  }
}

bool is_misspelt(const std::string& key, const Item& table, const std::string& section) {
  const std::vector<std::string> known = known_keys(language_section(section));
  return std::any_of(table.items.begin(), table.items.end(), [&](const Item& i) {
    if (is_among(known, i.key)) return false;
    const std::string other = hint_for_other_word(section, i.key);
    return other.empty() ? did_you_mean(i.key, known) == key : other.starts_with(key + " = ");
  });
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
