// What `check` says, in its two dresses.
#pragma once
#include "run/explain.h"

namespace anholon::cli {

// What the model contains beyond classical mechanics, in words.
std::vector<std::string> effects(const Model& model);
std::vector<std::string> external_forces(const Model& model);

// An entry of the state beyond positions and velocities.
struct Entry {
  std::string name;
  double value;
  Origin origin;
};
std::vector<Entry> higher_state(const Scenario& s);

// The power of a constraint's reaction.
std::string power_text(const Scenario& s, const Explanation& x, std::size_t r);

void check_text(const Scenario& s, const Explanation& x, const Outcome& outcome);
void check_json(const Scenario& s, const Explanation& x, const Outcome& outcome);

}  // namespace anholon::cli
