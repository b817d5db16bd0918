// Powers whose exponents are formulas of parameters.
//
// a^b is read as exp(b*log(a)), which has a value for a > 0 alone. If b is known to be a whole number k, a^k has one for
// every a, so k is put in. Parameters in such an exponent become numbers wherever they occur, so that x^(n + 1)/(n + 1)
// is x^4/4.
#pragma once
#include "model/model.h"
#include "print/powers.h"

namespace anholon {

// Puts whole exponents in, up to 1000, in a model whose graph may still grow: those of parameters that no event sets and
// that do not depend on one of `open`.
void put_whole_exponents(Model& model, const std::vector<std::size_t>& open);

// The exponents of such powers that depend on one of these parameters, and on parameters alone that no event sets.
Column exponents_of(Model& model, const std::vector<std::size_t>& parameters);
// Whether there are any.
bool any_exponents(const Model& model);

}  // namespace anholon
