// [input] and [output]: what a control acts by, and what is recorded.
//
// An input is a formula of anything, held as a symbol of its own while the equations are derived; it is put in when the
// system is made. An input named in `by = "u"` of a constraint keeps that constraint: it is an unknown in the place of
// lambda (servo constraint), and any formula it has is not used.
#pragma once
#include "modelfile/names/names.h"

namespace anholon {

void declare_controls(const Item& root, Scope& scope, Model& model, Diagnostics& diagnostics);
// After all names are declared, before constraints are read.
void read_controls(const Item& root, Scope& scope, Model& model, Diagnostics& diagnostics);
// `by` of the constraints from `first` on: one input for each of them.
void keep_by(const Item& by, std::size_t first, const Scope& scope, Model& model);
// An input without a formula is one that keeps a constraint.
void check_kept(const Model& model, Diagnostics& diagnostics);
// Inputs whose formulas hold coordinates are put in: in a constraint or a potential they are no functions of time.
Expr with_feedback(const Model& model, Expr e);

void read_outputs(const Item& root, Scope& scope, Model& model, Diagnostics& diagnostics);

}  // namespace anholon
