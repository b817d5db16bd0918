// [notation] theta = "\\vartheta": how a name is written in LaTeX and MathML.
#pragma once
#include "model/model.h"
#include "modelfile/text/toml.h"

namespace anholon {

// The same sign as MathML. Read are letters, digits, Greek and a few other letters by their commands, \mathrm{…},
// accents, subscripts and superscripts. Throws Failure.
std::string mathml_of(const FormulaText& latex);

// Names that the file does not have are errors.
void read_notation(const Item& section, Model& model, const std::vector<std::string>& declared,
                   Diagnostics& diagnostics);

}  // namespace anholon
