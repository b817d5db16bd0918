// Computes the parts of a sweep that its folder does not hold. (doc/sweeps.md)
//
// A sweep has pieces, the motions of one model each; most have one. The cases of all missing parts of a piece are one
// ensemble, which is planned and compiled once; its results are cut at the boundaries of the parts, and a thread of its
// own writes a part while the next one is computed.
#pragma once
#include <span>

#include "ensemble/cases/ensemble.h"
#include "ensemble/store/sweep_store.h"
#include "ensemble/table.h"

namespace anholon {

// The cases of a piece follow on those of the piece before.
struct SweepPiece {
  const Scenario* scenario = nullptr;
  const EnsembleOptions* options = nullptr;  // of its cases, numbered from 0; progress and cancelled are not used
  SweepTable* table = nullptr;
  std::string word;  // in the added column of the table
};

struct FillOptions {
  std::vector<std::size_t> parts;  // in the order in which they are computed; those that are there are left out
  std::function<void(std::size_t done)> progress;  // cases, by one thread at a time
  std::function<bool()> cancelled;                 // called by many threads at once
};

struct Filled {
  std::size_t parts = 0;  // of those asked for that the folder holds now
  std::string error;      // the reason why a part could not be written
  EnsembleReport report;  // of the cases computed here; neither error nor residuals
};

Filled fill(const SweepStore& store, std::span<const SweepPiece> pieces, const FillOptions& options);

// The number of cases of a part that takes some seconds on one core, or holds some megabytes: 1, 2 or 5 times a power of
// ten. By the CPU time of trials of more and more cases, whose difference leaves out what the computation takes to begin.
std::size_t cases_in_part(std::span<const SweepPiece> pieces);
// The most cases of a part.
inline constexpr std::size_t kMostInPart = 1'000'000;

// The parts of a share in the order in which this process takes them. The process that made the folder takes them in
// ascending order; others take them in an order of their own, so that processes on one folder seldom meet.
std::vector<std::size_t> parts_to_do(const SweepStore& store, std::size_t share, std::size_t shares);

}  // namespace anholon
