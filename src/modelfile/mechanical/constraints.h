// [[constraint]]: equations of numbers or vectors, along axes, kept by inputs; the unit norms that quaternions need.
#pragma once
#include <set>
#include <string>

#include "modelfile/mechanical/quaternions.h"
#include "modelfile/names/names.h"

namespace anholon {

// Coordinates, or coordinates and constraints, beyond these are refused: matrices of their equations would not fit in
// memory, and their factors would take minutes.
inline constexpr std::size_t kMostCoordinates = 2000, kMostUnknowns = 2500;

class ConstraintReader {
 public:
  ConstraintReader(Scope& scope, Model& model, Diagnostics& diagnostics)
      : scope_(scope), model_(model), diagnostics_(diagnostics) {}

  void read(const Item& root);
  // What quaternions need to be rotations, after all that may hold one was read.
  std::vector<UnitNorm> norms_of_quaternions();

 private:
  int true_order(Expr& phi) const;
  void add_constraint(const std::string& name, Expr phi, const std::string& equation, Span place);
  Vector evaluate_vector_side(const Value& side, const Syntax& s) const;

  Scope& scope_;
  Model& model_;
  Diagnostics& diagnostics_;
  std::set<std::string> names_;
};

}  // namespace anholon
