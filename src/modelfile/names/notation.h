// [notation] theta = "\\vartheta": the spelling of a name in LaTeX and MathML.
#pragma once
#include "model/model.h"
#include "modelfile/text/toml.h"

namespace anholon {

// Converts a sign from LaTeX to MathML. Accepts letters, digits, Greek and some other letters by their commands,
// \mathrm{…}, accents, subscripts and superscripts. Throws Failure.
std::string mathml_of(const FormulaText& latex);

// Reports names that the file does not declare.
void read_notation(const Item& section, Model& model, const std::vector<std::string>& declared,
                   Diagnostics& diagnostics);

}  // namespace anholon
