// The block-triangular form of the system Jacobian: which unknowns are found together, and in which order.
//
// J_ij can be nonzero only where sigma_ij = d_j - c_i. With the transversal as matching, equation i needs the unknown
// of equation k where J_i,T(k) can be nonzero; the strongly connected components of that graph are the irreducible
// blocks (fine Dulmage-Mendelsohn decomposition; theory: dae-view).
#pragma once
#include "structure/structure.h"

namespace anholon {

// Equations that are solved together, for the unknowns that the transversal gives them.
struct Block {
  std::vector<std::size_t> equations, unknowns;  // ascending
};

// In an order in which they can be solved: each needs unknowns of itself and of earlier ones only.
std::vector<Block> blocks(const Structure& structure);

// What the state must satisfy: equation i and its derivatives of order k < c_i.
struct HiddenConstraint {
  std::size_t equation;
  std::vector<int> orders;  // of the highest derivative of a coordinate in the k-th of them; -1: multipliers only
};
std::vector<HiddenConstraint> hidden_constraints(const System& system, const Structure& structure);

std::string print(const System& system, const Structure& structure, const std::vector<Block>& blocks);

}  // namespace anholon
