// Descriptions of a system in words, for terminal and pages.
#pragma once
#include "setup/explain.h"

namespace anholon {

// The parts of the model beyond classical mechanics.
std::vector<std::string> effects(const Model& model);
std::vector<std::string> external_forces(const Model& model);

// "order 1, linear homogeneous"
std::string description(const ConstraintClass& c, int order);
// "does no work", "may do work, of power …", "servo"; a formula longer than `longest` is omitted.
std::string work(const Scenario& s, const ConstraintFacts& facts, std::size_t constraint, std::size_t longest);
// Names of constraints as a list.
std::string listed(const Model& model, const std::vector<std::size_t>& constraints);
// The hypothesis on the reactions: "ideal, no work in virtual displacements (d'Alembert, Lagrange)".
const char* in_words(Hypothesis hypothesis);

// An entry of the state beyond positions and velocities: a state of the model, a higher derivative, a multiplier.
struct StateEntry {
  std::string name;
  double value;
  Origin origin;
  bool multiplier = false;
};
std::vector<StateEntry> higher_state(const Scenario& s);

// The power of a constraint's reaction.
std::string power_text(const Scenario& s, const ConstraintFacts& facts, std::size_t constraint);

}  // namespace anholon
