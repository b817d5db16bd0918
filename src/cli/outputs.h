// The files that a command writes must not be those that it reads.
#pragma once
#include <string>
#include <vector>

#include "cli/input.h"

namespace anholon::cli {

// An output: the option that names it, and its path. An empty path and "-" are no files.
struct OutputFile {
  std::string option, path;
};

// Throws UsageError if an output is the file of the model, a file to which the model refers, or one of `read`, or if
// two outputs are one file. Called before anything is computed. A run may be written over the run that gives the model.
void must_spare_inputs(const ModelCommand& o, const Reader& in, const std::vector<std::string>& read,
                       const std::vector<OutputFile>& outputs);

}  // namespace anholon::cli
