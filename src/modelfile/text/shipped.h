// The models, templates and published equations that come with the program.
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "base/diagnostic.h"

namespace anholon {

struct ShippedFile {
  std::string name, path, title;
};
enum class Shipped : std::uint8_t { models, templates, equations };
// Returns the files, sorted by path.
std::vector<ShippedFile> shipped_files(Shipped kind);

// Returns the text of a model file or, if there is none, of the shipped model of that name, with the name for messages.
// Throws Failure without a place, with the nearest name.
SourceText model_text(const std::string& path_or_name);
// Returns the shipped model of that name, with or without ".toml"; nullopt if there is none.
std::optional<SourceText> shipped_model(const std::string& name);
// Returns the text of published equations: a file, or shipped ones by their name, with or without ".eq".
SourceText equation_text(const std::string& path_or_name);

}  // namespace anholon
