// The hash by which certificates, pages and saved runs name a model: of its text and of the files that it refers to.
#pragma once
#include "base/diagnostic.h"
#include "base/hash.h"

namespace anholon {

inline std::string model_hash(const SourceText& source) {
  std::string text = source.text;
  for (const SourceText& s : source.others) text += s.text;
  return sha256_text(text);
}

}  // namespace anholon
