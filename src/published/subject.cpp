#include "published/subject.h"

#include <algorithm>

#include "setup/eliminate.h"

namespace anholon {

namespace {

// Masses get the names that equations use for them.
SymbolNames names_of(const Model& model) {
  SymbolNames names = model.names;
  for (std::size_t i = 0; i < model.masses.size(); ++i) names.masses[i] = "m_" + model.masses[i].name;
  return names;
}

Alphabet alphabet_of(const Model& model) {
  Alphabet a{model.names.coordinates, {}, model.names.multipliers, {}, {}};
  for (const Parameter& p : model.parameters) a.others.push_back(p.name);
  std::vector<std::string> defined;
  for (const auto& [id, name] : model.names.defined) defined.push_back(name);
  std::sort(defined.begin(), defined.end());
  a.others.insert(a.others.end(), defined.begin(), defined.end());
  a.others.insert(a.others.end(), model.unknown_functions.begin(), model.unknown_functions.end());
  for (const VaryingMass& m : model.masses) a.masses.push_back(m.name);
  for (const QuasiVelocity& u : model.quasi) a.free.push_back(u.name);
  return a;
}

}  // namespace

Subject::Subject(OpenModel open, StateChoice choice)
    : open_(std::move(open)), choice_(std::move(choice)), mechanics_(anholon::mechanics(*open_.model)),
      words_(mechanics_, open_.names, [this](bool quasi) -> const Elimination& { return elimination(quasi); }),
      comparer_(mechanics_, elimination(false), names_of(*open_.model)), alphabet_(alphabet_of(*open_.model)) {}

const Elimination& Subject::elimination(bool quasi) {
  std::unique_ptr<const Elimination>& known = eliminations_[quasi];
  if (!known)
    known = std::make_unique<const Elimination>(elimination_for(
        mechanics_, quasi ? Unknowns::quasi_velocities : Unknowns::coordinates, choice_.overrides, choice_.eliminate));
  return *known;
}

}  // namespace anholon
