#include "proof/difference.h"

namespace anholon {

const char* name(Verdict v) {
  switch (v) {
  case Verdict::proved:
    return "proved";
  case Verdict::refuted:
    return "refuted";
  case Verdict::unknown:
    return "unknown";
  }
  return "";
}

Expr Difference::expression() const {
  std::vector<Expr> terms = {left};
  for (const auto& [coefficient, term] : right) terms.push_back(-(coefficient * term));
  return sum(terms);
}

}  // namespace anholon
