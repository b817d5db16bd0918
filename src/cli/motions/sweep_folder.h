// Sweeps in folders: computed part by part, looked at, collected into one file. (doc/sweeps.md)
#pragma once
#include "cli/input.h"
#include "ensemble/parts/fill.h"
#include "ensemble/variation.h"

namespace anholon::cli {

// Whether -o names a folder: by a slash at its end, or because a folder of that name is there.
bool names_folder(const std::string& output);

struct FolderSweep {
  std::vector<SweepPiece> pieces;
  std::vector<std::pair<std::string, std::string>> asked;  // as in SweepRequest
  std::size_t cases = 0;
  const Variation* variation = nullptr;  // of the only piece; null if there are several
};

// Computes what is missing in the folder, or what is missing in the share that --shard names. Returns the exit status.
int sweep_into_folder(const SweepCommand& o, const FolderSweep& sweep);

}  // namespace anholon::cli
