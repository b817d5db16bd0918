#include "modelfile/language/language.h"

#include <algorithm>

#include "base/assert.h"

namespace anholon {

const std::vector<LanguageSection>& language() {
  static const std::vector<LanguageSection> all = [] {
    std::vector<LanguageSection> list;
    for (const auto& part : {language_of_files(), language_of_names(), language_of_bodies(), language_of_motion()})
      list.insert(list.end(), part.begin(), part.end());
    return list;
  }();
  return all;
}

const LanguageSection& language_section(const std::string& name) {
  for (const LanguageSection& s : language())
    if (name == s.name) return s;
  ANHOLON_ASSERT(false);
  return language().front();
}

// Returns the plural of a name: body, bodies; event, events.
static std::string plural(std::string name) {
  if (!name.ends_with('y')) return name + "s";
  name.pop_back();
  return name + "ies";
}

const LanguageSection* find_subject(const std::string& word) {
  std::string asked = word;
  for (char& c : asked) c = 'A' <= c && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
  for (const LanguageSection& s : language())
    if (s.form != LanguageSection::Form::top && (asked == s.name || word == s.name)) return &s;
  for (const LanguageSection& s : language())
    if (s.form != LanguageSection::Form::part &&
        ((*s.name && asked == plural(s.name)) || std::find(s.words.begin(), s.words.end(), asked) != s.words.end()))
      return &s;
  return nullptr;
}

std::vector<std::string> known_keys(const LanguageSection& section) {
  std::vector<std::string> known;
  for (const LanguageKey& k : section.keys) known.emplace_back(k.name);
  if (section.form == LanguageSection::Form::top)
    for (const LanguageSection& s : language())
      if (s.form != LanguageSection::Form::top && s.form != LanguageSection::Form::part) known.emplace_back(s.name);
  return known;
}

const std::vector<ReservedName>& reserved_names() {
  static const std::vector<ReservedName> list = {
      {"t", "time"},
      {"pi", "3.14159…, exactly"},
      {"ex", "the observer's axes, vectors"},
      {"ey", ""},
      {"ez", "upward, where the author wants it so"},
      {"here", "the place at which the field of `[gravity]` is asked for"},
      {"lambda", "`lambda.NAME`: the multiplier of the constraint NAME, or the normal force of the contact NAME"},
      {"inertial", "as seen inertially: `vel(P, inertial)`"},
  };
  return list;
}

const std::vector<FunctionRow>& kinematic_functions() {
  static const std::vector<FunctionRow> list = {
      {"vel", "vel(P)", "velocity of the point P relative to the observer, `P'`", "vel(P)", DimensionRule::velocity},
      {"vel", "vel(B, P)", "body first: velocity of the material point of the body B that is at P now",
       "vel(plate, P + R*ex)", DimensionRule::velocity},
      {"vel", "vel(P, B)", "point first: velocity of P as seen from the body B, `vel(P) - vel(B, P)`",
       "vel(P + R*ex, plate)", DimensionRule::velocity},
      {"vel", "vel(P, inertial)", "velocity as seen inertially; needs the velocity of the observer's origin",
       "vel(P, inertial)", DimensionRule::velocity},
      {"acc", "acc(P)", "acceleration relative to the observer, `P''`; `acc(P, inertial)` as seen inertially",
       "acc(P, inertial)", DimensionRule::acceleration},
      {"angvel", "angvel(B)",
       "angular velocity of a body or frame relative to the observer; `angvel(B, C)` as seen from C; `angvel(B, "
       "inertial)`",
       "angvel(B, inertial)", DimensionRule::angular_velocity},
      {"angacc", "angacc(B)", "its derivative", "angacc(plate)", DimensionRule::angular_acceleration},
      {"reaction", "reaction(B)",
       "force of all constraints on the body B, m·a less the given forces, in monitors, events and what these use; "
       "`reaction_torque(B)` is its torque about the mass centre",
       "", DimensionRule::force},
      {"reaction_torque", "reaction_torque(B)", "torque of all constraints on the body B about its mass centre", "",
       DimensionRule::torque},
      {"gravity", "gravity(P)", "the field of `[gravity]` at the point P", "", DimensionRule::gravity},
  };
  return list;
}

bool is_reserved(const std::string& name) {
  const auto& list = reserved_names();
  return std::any_of(list.begin(), list.end(), [&](const ReservedName& r) { return name == r.name; });
}

}  // namespace anholon
