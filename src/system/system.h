// The implicit system F(t, x, x', …) = 0: n equations of motion and s constraints in the unknown
// functions q_1..q_n, lambda_1..lambda_s. Masses are put in; no form is ever solved symbolically.
#pragma once
#include <memory>

#include "formulation/formulation.h"

namespace anholon {

struct System {
  std::shared_ptr<const Model> model;
  const Formulation* form = nullptr;
  std::size_t coordinates = 0;            // n
  std::vector<std::size_t> constraints;   // indices of the model's constraints that take part
  Column equations;                       // n of motion, then one per constraint that takes part
  std::vector<std::string> equation_names;
  std::vector<std::string> variable_names;  // q_a, then lambda.NAME

  std::size_t size() const { return equations.size(); }
  // The symbol of the k-th derivative of variable j.
  Expr symbol(std::size_t variable, unsigned k) const;
  // The variable of which a symbol is a derivative, or nothing (t, parameters).
  std::optional<std::size_t> variable(NodeId symbol) const;
};

// Constraints that are left out (redundant ones) have their multipliers set to zero.
System implicit_system(std::shared_ptr<const Model> model, const Mechanics& mechanics,
                       const Formulation& form, const std::vector<std::size_t>& constraints);

}  // namespace anholon
