// Models for tests, from shipped files and from texts.
#pragma once
#include <algorithm>
#include <filesystem>
#include <fstream>
#include <memory>
#include <sstream>

#include <gtest/gtest.h>

#include "modelfile/read.h"

namespace anholon::test {

inline std::string file_text(const std::filesystem::path& path) {
  std::ifstream in(path);
  std::ostringstream text;
  text << in.rdbuf();
  return text.str();
}

inline std::filesystem::path source_dir() { return ANHOLON_SOURCE_DIR; }

// The names of the shipped models, sorted, such as "zoo/rocket" for models/zoo/rocket.toml. Templates of new models are
// left out (tools/reference.py runs them), and so are models with contacts, whose motions do not follow from their
// equations alone (tools/readme.py runs them in doc/contact.md).
inline std::vector<std::string> shipped_models() {
  std::vector<std::string> names;
  const std::filesystem::path folder = source_dir() / "models";
  for (const auto& entry : std::filesystem::recursive_directory_iterator(folder))
    if (entry.path().extension() == ".toml" && entry.path().parent_path().filename() != "templates" &&
        entry.path().parent_path().filename() != "contacts")
      names.push_back(std::filesystem::relative(entry.path(), folder).replace_extension().generic_string());
  std::sort(names.begin(), names.end());
  return names;
}

// The shipped models that have a formula for every function. The others, models/papers/*-symbolic.toml, can be derived,
// proved and compared, but not simulated.
inline std::vector<std::string> moving_models() {
  std::vector<std::string> names = shipped_models();
  std::erase_if(names, [](const std::string& name) { return name.ends_with("-symbolic"); });
  return names;
}

inline std::string shipped_text(const std::string& name) {
  return file_text(source_dir() / "models" / (name + ".toml"));
}

// The model. Throws the reader's messages if the text is refused, so that the test fails.
inline std::shared_ptr<const Model> model_of(const std::string& text, const Overrides& overrides = {}) {
  const SourceText source{"test.toml", text};
  Diagnostics diagnostics;
  std::optional<Model> m = read_model(source, diagnostics, overrides);
  if (!m) throw std::runtime_error("the model of this test is refused:\n" + diagnostics.print(source));
  return std::make_shared<const Model>(std::move(*m));
}

inline std::shared_ptr<const Model> shipped(const std::string& name) { return model_of(shipped_text(name)); }

inline std::string replaced(std::string text, const std::string& from, const std::string& to) {
  const std::size_t at = text.find(from);
  if (at == std::string::npos) throw std::runtime_error("'" + from + "' does not occur");
  return text.replace(at, from.size(), to);
}

// Makes a part of a test name from a model name.
inline std::string test_name(std::string name) {
  std::replace_if(name.begin(), name.end(), [](char c) { return !std::isalnum(static_cast<unsigned char>(c)); }, '_');
  return name;
}

}  // namespace anholon::test
