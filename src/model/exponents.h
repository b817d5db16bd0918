// Powers whose exponents are formulas of parameters.
//
// a^b is read as exp(b*log(a)), which has a value for a > 0 alone. If b is known to be a whole number k, the formula
// becomes a^k, which has a value for every a. Parameters in such an exponent become numbers wherever they occur, so
// that x^(n + 1)/(n + 1) becomes x^4/4.
#pragma once
#include "model/model.h"
#include "print/powers.h"

namespace anholon {

// Replaces exponents by whole numbers, up to 1000, in a model whose graph may still grow. An exponent is replaced if no
// event sets its parameters and none of them depends on one of `open`.
void put_whole_exponents(Model& model, const std::vector<std::size_t>& open);
// Returns formulas in the graph of the model, which are no part of it, with their exponents replaced in the same way.
Column with_whole_exponents(const Model& model, const Column& formulas, const std::vector<std::size_t>& open);

// Returns the exponents of such powers that depend on one of these parameters, and only on parameters that no event
// sets.
Column exponents_of(Model& model, const std::vector<std::size_t>& parameters);
// Returns such exponents of formulas in the graph of the model.
Column exponents_of(const Model& model, const Column& formulas, const std::vector<std::size_t>& parameters);
// True if the model has exponents of parameters alone.
bool any_exponents(const Model& model);

}  // namespace anholon
