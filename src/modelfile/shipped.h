// The models, templates and published equations that come with the program.
#pragma once
#include <string>
#include <vector>

#include "base/diagnostic.h"

namespace anholon {

struct ShippedFile {
  std::string name, path, title;
};
enum class Shipped : std::uint8_t { models, templates, equations };
// Sorted by path. `in_source` is the folder of a build that is not installed.
std::vector<ShippedFile> shipped_files(Shipped kind, const char* in_source);

// The text of a model file, or else of the shipped model of that name, with the name for messages. Throws
// Failure without a place, with the nearest name.
SourceText model_text(const std::string& path_or_name, const char* in_source);
// The same for published equations: a file, or shipped ones by their name, with or without ".eq".
SourceText equation_text(const std::string& path_or_name, const char* in_source);

}  // namespace anholon
