// Names in LaTeX and MathML: Greek letters, subscripts, indices, derivatives.
#pragma once
#include <optional>
#include <string>
#include <utility>

#include "base/escape.h"
#include "print/format.h"

namespace anholon {

// Converts "theta" -> "\theta", "x1" -> "x_{1}", "front_wheel" -> "\mathrm{front\_wheel}".
std::string latex_name(const std::string& name);
// Converts "theta" -> <mi>θ</mi>, "x1" -> <msub><mi>x</mi><mn>1</mn></msub>.
std::string mathml_name(const std::string& name);
// Returns the name of the k-th derivative: "x''", "D(x,4)"; "\ddot{x}", "x^{(4)}".
std::string derivative_name(const std::string& name, unsigned order, Format format);

inline std::string row(const std::string& mathml) { return "<mrow>" + mathml + "</mrow>"; }
// Splits a name: "th[3]" is th with the index 3, "rolling[2].x" is rolling.x with the index 2; nullopt if there is no
// bracket.
std::optional<std::pair<std::string, std::string>> indexed_name(const std::string& name);

}  // namespace anholon
