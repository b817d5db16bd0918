// A sweep that is asked for, ready to be computed.
#pragma once
#include <deque>

#include "anholon/sweep.h"
#include "api/data.h"
#include "ensemble/cases/ensemble.h"
#include "ensemble/parts/fill.h"
#include "ensemble/variation.h"

namespace anholon::v1 {

// The motions of one model: of a system, or of a model with one of its scenarios. Its options point into it, so it stays
// where it is.
struct PreparedPiece {
  // `start` tells whether the system has a consistent start. Throws Failure.
  PreparedPiece(System system, const inner::Outcome& start, std::string scenario_name, const SweepOptions& asked);
  PreparedPiece(const PreparedPiece&) = delete;
  PreparedPiece& operator=(const PreparedPiece&) = delete;

  System system;
  std::string word;      // the name of the scenario; empty if scenarios do not vary
  inner::Outcome start;  // not ok: neither the model nor one of its first cases has a consistent start
  const inner::Scenario* scenario = nullptr;
  std::optional<inner::Variation> variation;
  inner::MotionSettings settings;
  inner::EnsembleOptions options;

 private:
  const inner::Scenario* scenario_for(const std::vector<std::string>& reductions, const inner::Outcome& of_system);
  const std::vector<inner::Contact>& moving() const;
  std::optional<inner::OpenModel> open_;  // in whose graph the formulas of the reductions are
  inner::Scenario own_;                   // with these formulas, or of the first case that has a start
};

struct PreparedSweep {
  std::shared_ptr<const Model::Data> model;  // without the scenarios that vary
  SweepOptions asked;                        // likewise
  std::vector<std::string> scenarios;        // that vary; empty: there is one piece
  std::deque<PreparedPiece> pieces;
  std::size_t cases = 0;
  // Of the only piece; null if there are several, which are no grid.
  const inner::Variation* variation() const { return pieces.size() == 1 ? &*pieces.front().variation : nullptr; }
};

// Errors: mistakes in what is asked; an inconsistent start (an outcome).
Result<std::shared_ptr<const PreparedSweep>> prepared_sweep(const System& system, const SweepOptions& asked);
// A Vary named "case" names scenarios.
Result<std::shared_ptr<const PreparedSweep>> prepared_sweep(const Model& model, const PrepareOptions& prepare,
                                                            const SweepOptions& asked);

// The pieces of a sweep with tables of their own, so that several threads may compute at once.
struct TabledPieces {
  // Throws Failure: there is no such column, or the scenarios have different ones.
  explicit TabledPieces(const PreparedSweep& sweep);
  TabledPieces(const TabledPieces&) = delete;
  TabledPieces& operator=(const TabledPieces&) = delete;

  std::deque<inner::EnsembleOptions> options;
  std::deque<inner::SweepTable> tables;
  std::vector<inner::SweepPiece> pieces;
};

// What varies, as the command line writes it: NAME=A,B, NAME=FROM:TO:COUNT or NAME~LAW(…).
std::string text_of(const Vary& vary);

// The places of the columns that are asked for; all without a name. Throws Failure.
std::vector<std::size_t> chosen_places(const std::vector<std::string>& asked, const std::vector<std::string>& all);

}  // namespace anholon::v1
