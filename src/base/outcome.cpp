#include "base/outcome.h"

namespace anholon {

const char* name(OutcomeKind kind) {
  switch (kind) {
  case OutcomeKind::finished:
    return "finished";
  case OutcomeKind::singular:
    return "singular";
  case OutcomeKind::step_collapse:
    return "step_collapse";
  case OutcomeKind::blow_up:
    return "blow_up";
  case OutcomeKind::negative_mass:
    return "negative_mass";
  case OutcomeKind::not_a_number:
    return "not_a_number";
  case OutcomeKind::no_convergence:
    return "no_convergence";
  case OutcomeKind::inconsistent:
    return "inconsistent";
  case OutcomeKind::interrupted:
    return "interrupted";
  case OutcomeKind::too_large:
    return "too_large";
  }
  return "";
}

}  // namespace anholon
