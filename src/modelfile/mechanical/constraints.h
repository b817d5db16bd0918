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
  // The unit norms that quaternions need; call it after everything that may contain a quaternion has been read.
  std::vector<UnitNorm> norms_of_quaternions();
  // The constraints with 'active', which hold in some modes. Those of the modes at the start become constraints of the
  // model, behind all others; call it when the values of the parameters are known.
  std::vector<Contact> switched();

 private:
  int true_order(Expr& phi) const;
  // `named`: where the name stands, if the file gives it.
  void add_constraint(const std::string& name, Expr phi, const std::string& equation, Span place,
                      std::optional<Span> named = std::nullopt);
  // Takes the constraints from this one on out of the model: they hold while the formula is positive.
  void switch_by(const Item& active, std::size_t first);
  Vector evaluate_vector_side(const Value& side, const Syntax& s) const;

  Scope& scope_;
  Model& model_;
  Diagnostics& diagnostics_;
  std::set<std::string> names_;
  std::vector<Contact> switched_;
};

}  // namespace anholon
