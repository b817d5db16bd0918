// A sweep that is prepared for its computation.
#pragma once
#include <deque>

#include "anholon/sweep.h"
#include "api/data.h"
#include "ensemble/cases/ensemble.h"
#include "ensemble/parts/fill.h"
#include "ensemble/variation.h"

namespace anholon::v1 {

// The motions of one model: of a system, or of a model with one of its scenarios. Not movable, because its options
// point into it.
struct PreparedPiece {
  // `start` tells whether the system has a consistent start. Throws Failure.
  PreparedPiece(System system, const inner::Outcome& start, std::string scenario_name, const SweepOptions& asked);
  PreparedPiece(const PreparedPiece&) = delete;
  PreparedPiece& operator=(const PreparedPiece&) = delete;

  System system;
  std::string word;  // the name of the scenario; empty if scenarios do not vary
  const inner::Scenario* scenario = nullptr;
  std::optional<inner::Variation> variation;
  inner::MotionSettings settings;
  inner::EnsembleOptions options;

 private:
  const inner::Scenario* scenario_for(const std::vector<std::string>& reductions, const inner::Outcome& of_system);
  const std::vector<inner::Contact>& moving() const;
  std::optional<inner::OpenModel> open_;  // the graph of this model holds the formulas of the reductions
  inner::Scenario own_;                   // the scenario with these formulas or another start
  inner::Outcome own_start_;
};

struct PreparedSweep {
  std::shared_ptr<const Model::Data> model;  // without the scenarios that vary applied
  SweepOptions asked;                        // without the scenarios that vary
  std::vector<std::string> scenarios;        // the scenarios that vary; empty if there is one piece
  std::deque<PreparedPiece> pieces;
  std::size_t cases = 0;
  // Returns the variation of the only piece; nullptr if there are several pieces, which are no grid.
  const inner::Variation* variation() const { return pieces.size() == 1 ? &*pieces.front().variation : nullptr; }
};

// The errors are mistakes in the request; a start that no case has is the outcome of each case.
Result<std::shared_ptr<const PreparedSweep>> prepared_sweep(const System& system, const SweepOptions& asked);
// A Vary named "case" names scenarios.
Result<std::shared_ptr<const PreparedSweep>> prepared_sweep(const Model& model, const PrepareOptions& prepare,
                                                            const SweepOptions& asked);

// The pieces of a sweep with tables of their own, so that several threads may compute sweeps at once.
struct TabledPieces {
  // Throws Failure if a column does not exist or the scenarios have different columns.
  explicit TabledPieces(const PreparedSweep& sweep);
  TabledPieces(const TabledPieces&) = delete;
  TabledPieces& operator=(const TabledPieces&) = delete;

  std::deque<inner::EnsembleOptions> options;
  std::deque<inner::SweepTable> tables;
  std::vector<inner::SweepPiece> pieces;
};

// Returns the variation as the command line writes it: NAME=A,B, NAME=FROM:TO:COUNT or NAME~LAW(…).
std::string text_of(const Vary& vary);

// Returns the places of the columns in `asked` among all columns; all places if `asked` is empty. Throws Failure.
std::vector<std::size_t> chosen_places(const std::vector<std::string>& asked, const std::vector<std::string>& all);

}  // namespace anholon::v1
