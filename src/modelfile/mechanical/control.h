// [input] and [output]: the inputs of a control, and recorded quantities.
//
// An input is a formula in any symbols. It is a symbol of its own while the equations are derived; its formula is
// substituted when the system is made. An input without a formula, named in `by = "u"` of a constraint, maintains that
// constraint: the input is an unknown in place of lambda (servo constraint).
#pragma once
#include "modelfile/names/names.h"

namespace anholon {

void declare_controls(const Item& root, Scope& scope, Model& model, Diagnostics& diagnostics);
// REQUIRES: all names are declared, and no constraint is read yet.
void read_controls(const Item& root, Scope& scope, Model& model, Diagnostics& diagnostics);
// Reads `by` of the constraints from `first` on: one input without a formula for each of them.
void keep_by(const Item& by, std::size_t first, const Scope& scope, Model& model);
// Checks that an input without a formula maintains a constraint.
void check_kept(const Model& model, Diagnostics& diagnostics);
// Substitutes the inputs whose formulas hold coordinates: in a constraint or a potential they are not functions of
// time. Such an input keeps the name of the element (Control::put_into).
Expr with_feedback(Model& model, Expr e, const std::string& element);

void read_outputs(const Item& root, Scope& scope, Model& model, Diagnostics& diagnostics);

}  // namespace anholon
