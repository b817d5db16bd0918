// The warning of a motion that passes near a singular configuration.
#pragma once
#include <algorithm>
#include <string_view>

#include "observe/report.h"

namespace anholon {

// The beginning of its message.
inline constexpr std::string_view kPassesNearSingular = "the motion passes near a singular configuration";

// Removes the warning and the smallest singular value from the report of a motion, because the singularity belongs to a
// choice that is made anew.
inline void forget_singularity(SimulationReport& r) {
  std::erase_if(r.warnings, [](const Warning& w) { return w.message.starts_with(kPassesNearSingular); });
  r.smallest_sigma = 1;
  r.smallest_sigma_t = r.t;
}

}  // namespace anholon
