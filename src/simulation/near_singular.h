// The warning of a motion that passes near a singular configuration.
#pragma once
#include <algorithm>
#include <string_view>

#include "observe/report.h"

namespace anholon {

// Its message begins so.
inline constexpr std::string_view kPassesNearSingular = "the motion passes near a singular configuration";

// Takes the warning, and the smallest singular value of which it tells, out of the report of a motion whose singularity is
// one of a choice that is made anew.
inline void forget_singularity(SimulationReport& r) {
  std::erase_if(r.warnings, [](const Warning& w) { return w.message.starts_with(kPassesNearSingular); });
  r.smallest_sigma = 1;
  r.smallest_sigma_t = r.t;
}

}  // namespace anholon
