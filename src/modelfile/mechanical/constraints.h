// [[constraint]]: equations of numbers or vectors, along axes, or maintained by inputs; the unit norms of quaternions.
#pragma once
#include <set>
#include <string>

#include "modelfile/mechanical/contacts.h"
#include "modelfile/mechanical/quaternions.h"
#include "modelfile/names/names.h"

namespace anholon {

// More coordinates, or coordinates and constraints, are refused: the matrices of their equations would not fit in
// memory, and their factorization would take minutes.
inline constexpr std::size_t kMostCoordinates = 2000, kMostUnknowns = 2500;

class ConstraintReader {
 public:
  ConstraintReader(Scope& scope, Model& model, Diagnostics& diagnostics)
      : scope_(scope), model_(model), diagnostics_(diagnostics) {}

  void read(const Item& root);
  // Adds the unit norms that quaternions need. REQUIRES: everything that may contain a quaternion has been read.
  std::vector<UnitNorm> norms_of_quaternions();
  // Returns the constraints with 'active', which hold in some modes. Those that hold in the modes at the start become
  // constraints of the model, behind all others. REQUIRES: the values of the parameters are known.
  std::vector<Contact> switched();

 private:
  int true_order(Expr& phi) const;
  // `named`: the place of the name, if the file gives a name.
  void add_constraint(const std::string& name, Expr phi, const std::string& equation, Span place,
                      std::optional<Span> named = std::nullopt);
  // Removes the constraints from index `first` on from the model: they hold while the formula is positive.
  void switch_by(const Item& active, std::size_t first);
  Vector evaluate_vector_side(const Value& side, const Syntax& s, const Syntax& other) const;

  Scope& scope_;
  Model& model_;
  Diagnostics& diagnostics_;
  std::set<std::string> names_;
  std::vector<Contact> switched_;
};

}  // namespace anholon
