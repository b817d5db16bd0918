// All unknown names of a file at once. The readers stop at the first mistake of an element, and the evaluation of a
// formula stops at its first unknown name; this check looks at the syntax trees of all formulas.
#pragma once
#include <map>

#include "base/diagnostic.h"
#include "modelfile/names/names.h"

namespace anholon {

// Adds an error for each unknown name, unknown function and syntax error in the formulas of the file that is not
// reported yet. Values of parameters that `overrides` replaces are not looked at. Is called for files that have errors.
void report_unknown_names(const Item& root, Scope& scope, const std::map<std::string, std::string>& overrides,
                          Diagnostics& diagnostics);

}  // namespace anholon
