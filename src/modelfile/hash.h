// The hash that identifies a model in certificates, pages, results and saved runs: the hash of its text, of its base
// files, and of the data files of its tables with their names.
#pragma once
#include "base/diagnostic.h"
#include "base/hash.h"

namespace anholon {

inline std::string model_hash(const SourceText& source) {
  std::string text = source.text;
  for (const SourceText& s : source.others) text += s.text;
  for (const SourceText& s : source.tables) text += '\0' + s.name + '\0' + s.text;
  return sha256_text(text);
}

}  // namespace anholon
