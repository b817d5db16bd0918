// HTML in pieces. What is given as text is escaped; what is given as markup is ours.
#pragma once
#include <string>
#include <vector>

#include "base/escape.h"

namespace anholon {

// Text of a model or a run: escaped, and kept apart where it runs the other way.
std::string user(const std::string& text);
// " name="value"", escaped.
std::string attribute(const char* name, const std::string& value);
// A row of MathML as a formula.
std::string math(const std::string& row);
// A table with a caption, of markup; nothing without rows. The first cell of a row is its head; no head line where
// `head` is empty.
std::string table(const std::string& caption, const std::vector<std::string>& head,
                  const std::vector<std::vector<std::string>>& rows);

}  // namespace anholon
