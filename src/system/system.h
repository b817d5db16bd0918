// The implicit system F(t, x, x', …) = 0: n equations of motion, s constraints and the rates of the model's states, in
// the unknown functions q_1..q_n, lambda_1..lambda_s, z_1, …. Masses are substituted; no form is ever solved
// symbolically.
//
// A form without multipliers gives n - s equations, which determine the motion together with the
// constraints. Routh's equations of the dependent coordinates, Phi_D^T lambda = a_D [L 3.4], are added
// for the multipliers: they take no part in the motion.
#pragma once
#include <memory>

#include "formulation/formulation.h"

namespace anholon {

struct System {
  std::shared_ptr<const Model> model;
  const Formulation* form = nullptr;
  std::size_t coordinates = 0;           // n
  std::vector<std::size_t> constraints;  // indices of the model's constraints that take part
  Column equations;                      // n of motion, then one per constraint that takes part
  // The number of the n equations that belong to the form; the others give lambda.
  std::size_t of_motion = 0;
  std::vector<std::string> equation_names;
  std::vector<std::string> variable_names;  // q_a, then lambda.NAME
  // A number for each variable: variables with the same number are measured against one size when the length of a step
  // is chosen, lengths against one and angles against another. Empty if all variables share one size.
  std::vector<std::uint32_t> scales;
  Column rates;  // the jets of coordinates n + k represent these formulas and their derivatives (by_rates.h)

  std::size_t size() const { return equations.size(); }
  // The equations and unknowns with smaller indices are those of motion and constraints; z' - rate = 0 follow.
  std::size_t mechanical() const { return coordinates + constraints.size(); }
  // Returns the symbol of the k-th derivative of variable j; its node need not be in the graph.
  Expr symbol(std::size_t variable, unsigned k) const;
  Node symbol_node(std::size_t variable, unsigned k) const;
  // Returns the variable of which a symbol is a derivative; nullopt if there is none (t, parameters).
  std::optional<std::size_t> variable(NodeId symbol) const;
};

// Returns the expressions with zeros for the multipliers of constraints that take no part.
Column taking_part(const System& s, const Column& es);

// The handles of the system (expr/handles.h), without those of its model.
void for_each_expression(System& s, const ExprVisitor& f);

// Constraints that are left out (redundant ones) have their multipliers set to zero. `elimination` is of these
// constraints; forms with multipliers ignore it.
System implicit_system(std::shared_ptr<const Model> model, const Mechanics& mechanics, const Formulation& form,
                       const std::vector<std::size_t>& constraints, const Elimination& elimination = {});

}  // namespace anholon
