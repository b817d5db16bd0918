// The block-triangular form of the system Jacobian: the groups of unknowns that are solved for together, and their
// order.
//
// J_ij can be nonzero only if sigma_ij = d_j - c_i. With the transversal as matching, equation i needs the unknown of
// equation k if J_i,T(k) can be nonzero; the strongly connected components of that graph are the irreducible blocks
// (fine Dulmage-Mendelsohn decomposition; theory: dae-view).
#pragma once
#include "structure/structure.h"

namespace anholon {

// Equations that are solved together for the unknowns that the transversal assigns to them.
struct Block {
  std::vector<std::size_t> equations, unknowns;  // ascending
};

// Returns the blocks in an order of solution: each needs only unknowns of itself and of earlier blocks.
std::vector<Block> blocks(const Structure& structure);

// A hidden constraint on the state: equation i with its derivatives of order k < c_i.
struct HiddenConstraint {
  std::size_t equation;
  // The order of the highest derivative of a coordinate in the k-th derivative of the equation; -1: multipliers only.
  std::vector<int> orders;
};
std::vector<HiddenConstraint> hidden_constraints(const System& system, const Structure& structure);

std::string print(const System& system, const Structure& structure, const std::vector<Block>& blocks);

}  // namespace anholon
