// A sweep that is asked for, ready to be computed.
#pragma once
#include "anholon/sweep.h"
#include "api/data.h"
#include "ensemble/ensemble.h"
#include "ensemble/variation.h"

namespace anholon::v1 {

// Its options point into it, so it stays where it is.
struct PreparedSweep {
  PreparedSweep(const System::Data& system, const SweepOptions& asked);  // throws Failure
  PreparedSweep(const PreparedSweep&) = delete;
  PreparedSweep& operator=(const PreparedSweep&) = delete;

  inner::Outcome start;  // not ok: the model with the formulas of the reductions has no consistent start
  inner::Scenario with_formulas;
  const inner::Scenario* scenario = nullptr;
  std::optional<inner::Variation> variation;
  inner::MotionSettings settings;
  inner::EnsembleOptions options;
};

// What varies, as the command line writes it: NAME=A,B, NAME=FROM:TO:COUNT or NAME~LAW(…).
std::string text_of(const Vary& vary);

// The places of the columns that are asked for; all without a name. Throws Failure.
std::vector<std::size_t> chosen_places(const std::vector<std::string>& asked, const std::vector<std::string>& all);

}  // namespace anholon::v1
