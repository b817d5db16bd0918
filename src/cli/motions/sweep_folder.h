// Sweeps in folders: they are computed part by part, looked at, and collected into one file. (doc/sweeps.md)
#pragma once
#include "cli/input.h"
#include "ensemble/parts/fill.h"
#include "ensemble/variation.h"

namespace anholon::cli {

// True if -o names a folder: the name ends with a slash, or a folder of that name exists.
bool names_folder(const std::string& output);

struct FolderSweep {
  std::vector<SweepPiece> pieces;
  std::vector<std::pair<std::string, std::string>> asked;  // as in SweepRequest
  std::size_t cases = 0;
  const Variation* variation = nullptr;  // the variation of the only piece; null if there are several pieces
};

// Computes the missing parts of the folder, or of the share that --shard names. Returns the exit status.
int sweep_into_folder(const SweepCommand& o, const FolderSweep& sweep);

}  // namespace anholon::cli
