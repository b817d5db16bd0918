// Sweeps in folders: computed part by part, looked at, collected into one file. (doc/sweeps.md)
#pragma once
#include <functional>

#include "cli/input.h"
#include "cli/motions/sweep_output.h"
#include "ensemble/store/sweep_store.h"

namespace anholon::cli {

// Whether -o names a folder: by a slash at its end, or because a folder of that name is there.
bool names_folder(const std::string& output);

// Computes the cases from one number to the one before another and gives them to the output.
using ComputeCases = std::function<EnsembleReport(std::size_t from, std::size_t to, SweepOutput& output)>;

struct FolderSweep {
  std::vector<SweepColumn> columns;
  std::vector<std::pair<std::string, std::string>> asked;  // as in SweepRequest
  std::size_t cases = 0;
  ComputeCases compute;
};

// Computes what is missing in the folder, or what is missing in the share that --shard names. Returns the exit status.
int sweep_into_folder(const Options& o, const FolderSweep& sweep);

}  // namespace anholon::cli
