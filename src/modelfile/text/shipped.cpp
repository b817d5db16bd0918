#include "modelfile/text/shipped.h"

#include <algorithm>
#include <filesystem>

#include "base/platform/installed.h"
#include "base/read_file.h"

namespace anholon {

namespace fs = std::filesystem;

// Returns the value of the first line that is `title = "…"`.
static std::string title_of(const std::string& text) {
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t end = std::min(text.find('\n', at), text.size());
    const std::string_view line(text.data() + at, end - at);
    const std::size_t open = line.find('"'), close = line.rfind('"');
    if (line.starts_with("title") && open != std::string_view::npos && close > open)
      return std::string(line.substr(open + 1, close - open - 1));
    at = end + 1;
  }
  return {};
}

std::vector<ShippedFile> shipped_files(Shipped kind) {
  std::vector<ShippedFile> list;
  for (const fs::path& folder : data_folders("models", ANHOLON_MODELS_DIR)) {
    std::error_code error;
    if (!fs::is_directory(folder, error)) continue;
    for (const fs::directory_entry& e : fs::recursive_directory_iterator(folder, error)) {
      const bool template_file = e.path().parent_path().filename() == "templates";
      if (e.path().extension() != (kind == Shipped::equations ? ".eq" : ".toml") ||
          template_file != (kind == Shipped::templates))
        continue;
      std::string text;
      read_file(e.path(), text);
      list.push_back({e.path().stem().string(), e.path().string(), title_of(text)});
    }
    if (!list.empty()) break;
  }
  std::sort(list.begin(), list.end(), [](const ShippedFile& a, const ShippedFile& b) { return a.path < b.path; });
  return list;
}

std::optional<SourceText> shipped_model(const std::string& name) {
  SourceText source;
  for (const ShippedFile& m : shipped_files(Shipped::models)) {
    if ((m.name != name && m.name + ".toml" != name) || !read_file(m.path, source.text)) continue;
    source.name = m.name + ".toml";
    source.path = m.path;
    return source;
  }
  return std::nullopt;
}

SourceText model_text(const std::string& path_or_name) {
  SourceText source{path_or_name, {}};
  std::string why;
  if (read_file(path_or_name, source.text, &why)) return source;
  if (std::optional<SourceText> shipped = shipped_model(path_or_name)) return std::move(*shipped);
  std::vector<std::string> known;
  for (const ShippedFile& m : shipped_files(Shipped::models)) known.push_back(m.name);
  const std::string near = did_you_mean(path_or_name, known);
  throw Failure({}, "cannot read the model '" + path_or_name + "': " + why,
                near.empty() ? "a path to a .toml file, or a name that `anholon models` lists"
                             : "did you mean the shipped model '" + near + "'?");
}

SourceText equation_text(const std::string& path_or_name) {
  SourceText source{path_or_name, {}};
  std::string why;
  if (read_file(path_or_name, source.text, &why)) return source;
  std::vector<std::string> known;
  for (const ShippedFile& e : shipped_files(Shipped::equations)) {
    known.push_back(e.name);
    if (e.name != path_or_name && e.name + ".eq" != path_or_name) continue;
    source.name = e.name + ".eq";
    if (read_file(e.path, source.text, &why)) return source;
  }
  const std::string near = did_you_mean(path_or_name, known);
  throw Failure({}, "cannot read the equations '" + path_or_name + "': " + why,
                near.empty() ? "a file with one equation per line, LABEL: left = right"
                             : "did you mean the shipped equations '" + near + "'?");
}

}  // namespace anholon
