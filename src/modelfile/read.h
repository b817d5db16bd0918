// TOML -> Model: names resolved, formulas typed, constraints classified, every error collected.
#pragma once
#include <map>
#include <optional>
#include <string>

#include "model/model.h"

namespace anholon {

// Values of parameters and index integers given from outside (--set M=3): name -> exact formula.
using Overrides = std::map<std::string, std::string>;

// Reads the text of a model file, and the files that it builds on, with these scenarios one after the other. Nothing on
// errors, which are then in `diagnostics`.
std::optional<Model> read_model(const SourceText& source, Diagnostics& diagnostics, const Overrides& overrides = {},
                                const std::vector<std::string>& cases = {});

// A model whose names can still be asked what they mean, for formulas beyond its file.
struct OpenModel {
  std::shared_ptr<const Model> model;
  std::shared_ptr<Names> names;  // those of the file; lambda, lambda.NAME and m_NAME
};
std::optional<OpenModel> open_model(const SourceText& source, Diagnostics& diagnostics, const Overrides& overrides = {},
                                    const std::vector<std::string>& cases = {});

}  // namespace anholon
