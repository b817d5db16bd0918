// Formulas that are linear in velocities, and are kept short during their construction.
#pragma once
#include "expr/diff.h"

namespace anholon {

std::size_t node_count(Expr e);
// Returns the number of nodes that vary in time; 0: e is constant.
std::size_t varying_nodes(Expr e);
bool is_constant(Expr e);
bool contains(Expr e, const Column& symbols);

// Returns e with the jets of coordinates from `first` on, which represent these expressions and their total derivatives
// (System::rates), written out.
Expr written_out(Expr e, std::size_t first, const Column& rates);

Expr dot(const Column& a, const Column& b);  // sum_i a_i b_i

// Returns e as short as a person would write it, if that form is found with little work; else unchanged.
class Tidy {
 public:
  Expr operator()(Expr e);

 private:
  std::unordered_map<NodeId, Expr> known_;
};

// The expression sum_j by[j] v_j + rest.
struct Linear {
  Column by;
  Expr rest;
};
// Returns an expression that is linear in the symbols v; parts that many of its terms have in common are kept.
Linear linear(Expr e, const Column& v, Tidy& tidy);

}  // namespace anholon
