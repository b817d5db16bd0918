// TOML -> Model: names resolved, formulas typed, constraints classified, every error collected.
#pragma once
#include <map>
#include <optional>
#include <string>

#include "model/model.h"

namespace anholon {

// Parameter values given from outside (--set M=3): name -> exact formula.
using Overrides = std::map<std::string, std::string>;

// Reads the text of a model file. Nothing on errors, which are then in `diagnostics`.
std::optional<Model> read_model(const SourceText& source, Diagnostics& diagnostics,
                                const Overrides& overrides = {});

}  // namespace anholon
