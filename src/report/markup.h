// HTML in pieces. Arguments that are text are escaped; arguments that are markup must come from this program.
#pragma once
#include <string>
#include <vector>

#include "base/escape.h"

namespace anholon {

// Text of a model or a run: escaped, and isolated if its direction of writing differs.
std::string user(const std::string& text);
// " name="value"", escaped.
std::string attribute(const char* name, const std::string& value);
// Makes a formula of a row of MathML.
std::string math(const std::string& row);
// A table with a caption, of markup; empty if there are no rows. The first cell of a row is its head; there is no head
// line if `head` is empty.
std::string table(const std::string& caption, const std::vector<std::string>& head,
                  const std::vector<std::vector<std::string>>& rows);

}  // namespace anholon
