// Computes the missing parts of a sweep in a folder (doc/sweeps.md).
//
// A sweep has pieces, the motions of one model each; most sweeps have one. The cases of all missing parts of a piece
// are one ensemble, which is planned and compiled once. Its results are cut at the boundaries of the parts, and a
// separate thread writes a part while the next one is computed.
#pragma once
#include <span>

#include "ensemble/cases/ensemble.h"
#include "ensemble/store/sweep_store.h"
#include "ensemble/table.h"

namespace anholon {

// The cases of a piece follow those of the piece before.
struct SweepPiece {
  const Scenario* scenario = nullptr;
  const EnsembleOptions* options = nullptr;  // of its cases, numbered from 0; progress and cancelled are not used
  SweepTable* table = nullptr;
  std::string word;  // the word in the added column of the table
};

struct FillOptions {
  std::vector<std::size_t> parts;  // in the order of their computation; parts that are there are skipped
  std::function<void(std::size_t done)> progress;  // the number of cases, by one thread at a time
  std::function<bool()> cancelled;                 // called by many threads at once
};

struct Filled {
  std::size_t parts = 0;  // the requested parts that the folder contains now
  std::string error;      // the reason why a part could not be written
  EnsembleReport report;  // of the cases computed here, without error and residuals
};

Filled fill(const SweepStore& store, std::span<const SweepPiece> pieces, const FillOptions& options);

// Returns the number of cases of a part that takes some seconds on one core, or some megabytes: 1, 2 or 5 times a power
// of ten. It comes from the CPU time of trials of more and more cases, whose differences leave out the time to start.
std::size_t cases_in_part(std::span<const SweepPiece> pieces);
// The most cases of a part.
inline constexpr std::size_t kMostInPart = 1'000'000;

// The parts of a share in the order in which this process computes them. The process that made the folder takes them in
// ascending order, other processes in random order, so that processes on one folder seldom meet.
std::vector<std::size_t> parts_to_do(const SweepStore& store, std::size_t share, std::size_t shares);

}  // namespace anholon
