// Arithmetic as statements of Python: for one state in Python's own numbers, and for a block of states in arrays of
// NumPy, whose results go to existing rows (`out=`: a new array for each operation takes several times as long).
#pragma once
#include <string>

#include "emit/arithmetic.h"

namespace anholon::emit {

// Returns the body of a function of t and the list x, which returns the list of roots. Its functions are those of _One.
std::string python_of_one(const Arithmetic& arithmetic, std::size_t states);

struct PythonOfMany {
  std::string text;      // the body of a function of t, the rows x, out and w
  std::size_t rows = 0;  // the number of rows of w
};
PythonOfMany python_of_many(const Arithmetic& arithmetic);

}  // namespace anholon::emit
