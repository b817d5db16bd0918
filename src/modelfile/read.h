// TOML -> Model: names are resolved, formulas typed, constraints classified, all errors collected.
#pragma once
#include <map>
#include <optional>
#include <string>

#include "model/model.h"

namespace anholon {

// Values of parameters and index integers given on the command line (--set M=3): name -> exact formula.
using Overrides = std::map<std::string, std::string>;

// Reads the text of a model file and of its base files, with these cases applied in order. Returns nullopt on errors,
// which are then in `diagnostics`.
std::optional<Model> read_model(const SourceText& source, Diagnostics& diagnostics, const Overrides& overrides = {},
                                const std::vector<std::string>& cases = {});

// A model with its names, for formulas beyond its file.
struct OpenModel {
  std::shared_ptr<const Model> model;
  std::shared_ptr<Names> names;  // the names of the file; lambda, lambda.NAME and m_NAME
};
std::optional<OpenModel> open_model(const SourceText& source, Diagnostics& diagnostics, const Overrides& overrides = {},
                                    const std::vector<std::string>& cases = {});

}  // namespace anholon
