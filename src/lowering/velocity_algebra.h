// Formulas that are linear in velocities, and kept short while they are put together.
#pragma once
#include "expr/diff.h"

namespace anholon {

std::size_t node_count(Expr e);
// Of those that vary in time; 0: e is constant.
std::size_t varying_nodes(Expr e);
bool is_constant(Expr e);
bool contains(Expr e, const Column& symbols);

// Jets of coordinates from `first` on, which stand for these expressions and their total derivatives (System::rates),
// written out.
Expr written_out(Expr e, std::size_t first, const Column& rates);

Expr dot(const Column& a, const Column& b);  // sum_i a_i b_i

// As short as a person would write it, if that is soon found; else as it is.
class Tidy {
 public:
  Expr operator()(Expr e);

 private:
  std::unordered_map<NodeId, Expr> known_;
};

// sum_j by[j] v_j + rest
struct Linear {
  Column by;
  Expr rest;
};
// Of what is linear in the symbols v; what many of them have in common stays so.
Linear linear(Expr e, const Column& v, Tidy& tidy);

}  // namespace anholon
