// A point of the manifold of the constraints at which a difference is not zero.
#pragma once
#include <optional>
#include <string>

#include "mechanics/elimination.h"
#include "proof/difference.h"

namespace anholon {

inline constexpr long kWitnessBits = 1024;

struct WitnessSearch {
  std::optional<WitnessPoint> witness;
  std::string detail;  // the value at the witness; or the size of the expression at the points tried
};

// Searches a witness. Free symbols get pseudo-random rational values, parameters those of the model if these are
// rational. Constraints that the elimination has not solved are satisfied by a verified root in the dependent
// derivatives. `bits`: maximal precision of the balls that distinguish the difference from zero.
WitnessSearch find_witness(const Difference& d, const Elimination& elimination, const Model& model,
                           long bits = kWitnessBits);

// The range of the coordinates that are tried: of one size and positive, or of either sign and up to three times as
// large.
enum class Where : std::uint8_t { positive, elsewhere };

// Searches a witness at a root of other equations, as many as unknowns. `starts`: approximate roots, near which roots
// are searched if there is none for arbitrary values of the free symbols.
WitnessSearch find_witness(const Difference& d, const Column& equations, const Column& unknowns, const Model& model,
                           Where where = Where::positive, std::vector<PointValues>* starts = nullptr);

}  // namespace anholon
