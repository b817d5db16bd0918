// Formulas of parameters that have to vanish: what the reader demands of the numbers of a file, for other numbers of the
// parameters.
#pragma once
#include <functional>

#include "base/diagnostic.h"
#include "tape/tape.h"

namespace anholon {

struct Identity {
  Tape left;                                // the formula; its only symbols are parameters
  double slack = 0;                         // the largest absolute value that counts as round-off
  std::function<std::string(double)> what;  // what is wrong if the formula has this value
  std::string hint;
  Span span;
};

// Adds the identity e = 0 if e holds parameters and no other symbols.
void add_identity(std::vector<Identity>& list, Expr e, double slack, std::function<std::string(double)> what,
                  const std::string& hint, Span span);

// Returns the error of the first formula that does not vanish for these values of all parameters.
std::optional<Diagnostic> first_violated(const std::vector<Identity>& list, const std::vector<double>& parameters);

}  // namespace anholon
