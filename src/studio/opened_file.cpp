#include "studio/opened_file.h"

#include <filesystem>

#include "base/hash.h"
#include "base/read_file.h"
#include "modelfile/text/toml.h"
#include "result/file.h"

namespace anholon {

namespace {

void collect(const Item& item, std::vector<NamedFile>& list) {
  if (item.kind == Item::Kind::string && (item.key == "base" || item.key == "file"))
    list.push_back({item.text(), item.span});
  for (const Item& i : item.items) collect(i, list);
}

}  // namespace

std::vector<NamedFile> files_named(const SourceText& source) {
  std::vector<NamedFile> list;
  collect(read_toml(source), list);
  return list;
}

OpenedFile::OpenedFile(SourceText source, bool shipped) : source_(std::move(source)), last_(source_.text) {
  try {
    for (const NamedFile& f : files_named(source_)) readable_.push_back(f.name);
  } catch (const Failure&) {
    // The page shows the mistake. Files that the corrected text names become readable after a restart.
  }
  if (shipped) {
    no_saving_ = "this model comes with the program and is not changed; copy its text, or open a file of your own";
    return;
  }
  std::error_code error;
  target_ = std::filesystem::canonical(source_.name, error).string();
  if (error || !std::filesystem::is_regular_file(target_, error))
    no_saving_ = "'" + source_.name + "' is not a file that can be written";
  else
    no_saving_ = obstacle_to_writing(target_);
}

bool OpenedFile::read(std::string& text) const {
  std::error_code error;
  return std::filesystem::is_regular_file(target_, error) && read_file(target_, text);
}

OpenedFile::Text OpenedFile::text() {
  const std::lock_guard<std::mutex> turn(turn_);
  if (std::string now; read(now)) last_ = std::move(now);
  return {last_, sha256_text(last_)};
}

OpenedFile::Saving OpenedFile::save(const std::string& text, const std::string& known, bool anyway) {
  const std::lock_guard<std::mutex> turn(turn_);
  if (!no_saving_.empty()) return {Saved::failed, no_saving_, {}};
  std::string now;
  if (!anyway && read(now) && now != text && sha256_text(now) != known)
    return {Saved::changed_by_others,
            "'" + source_.name + "' was changed by another page or program since this page read or saved it",
            {}};
  if (const std::string why = write_whole(target_, text); !why.empty()) return {Saved::failed, why, {}};
  last_ = text;
  return {Saved::saved, {}, sha256_text(text)};
}

}  // namespace anholon
