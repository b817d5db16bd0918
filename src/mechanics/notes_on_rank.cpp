#include "mechanics/notes_on_rank.h"

namespace anholon {

std::vector<std::string> notes_on_rank(const Model& model, const Elimination& e) {
  std::vector<std::string> notes;
  for (std::size_t r : e.left_out)
    notes.push_back("constraint '" + model.constraints[r].name +
                    "' depends on the others at the initial state: it is left out");
  const std::string full = "the constraints have rank " + std::to_string(e.constraints.size());
  switch (e.full_rank) {
  case FullRank::here:
    break;
  case FullRank::beside:
    notes.push_back("it is assumed that " + full +
                    ": at the initial state, a singular one, it is lower, and there are more degrees of "
                    "freedom than equations");
    break;
  case FullRank::assumed:
    notes.push_back("it is assumed that " + full + ": no state of the constraints is known at which it is");
    break;
  }
  return notes;
}

}  // namespace anholon
