// The functions of formulas as a table: call, meaning, an example. Functions of one argument with an explicit
// derivative come from elementary.def.
#pragma once
#include <string>
#include <vector>

namespace anholon {

struct FunctionRow {
  std::string name;
  std::string call;     // "atan2(y, x)"
  std::string meaning;  // in Markdown, without full stop
  std::string example;  // in a model with the coordinates x, y, theta, the frame B, the point P, the body plate
};

// The functions of pure mathematics, which need no model.
const std::vector<FunctionRow>& function_table();
std::vector<std::string> function_names();

}  // namespace anholon
