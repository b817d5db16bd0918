#include "motion/saved.h"

#include "base/escape.h"
#include "base/hash.h"
#include "modelfile/text/toml.h"

namespace anholon {

static constexpr const char* kHash = "hash = [\"";

void SavedRun::unfit(const std::string& name) {
  throw Failure(Span{}, "the saved state does not fit this run: '" + name + "' is missing or has another size",
                "start the run anew, with --save");
}

const SavedRun::Texts& SavedRun::texts(const std::string& name) const {
  const auto it = entries_.find(name);
  if (it == entries_.end()) unfit(name);
  return it->second;
}

const std::string& SavedRun::one(const std::string& name) const {
  const Texts& t = texts(name);
  if (t.size() != 1) unfit(name);
  return t[0];
}

std::string print(const SavedRun& run) {
  std::string text = "# A run of anholon: anholon simulate MODEL --continue THIS_FILE --to T goes on with it.\n";
  for (const auto& [name, texts] : run.entries_) {
    text += name + " = [";
    for (std::size_t i = 0; i < texts.size(); ++i) text += (i ? ", \"" : "\"") + toml_escape(texts[i]) + "\"";
    text += "]\n";
  }
  return text + kHash + sha256_text(text) + "\"]\n";
}

SavedRun read_saved(const SourceText& source) {
  const std::size_t hash = source.text.rfind(kHash);
  if (hash == std::string::npos)
    throw Failure(Span{}, "this is not a saved run", "anholon simulate MODEL --to T --save FILE writes one");
  if (source.text.compare(hash, std::string::npos, kHash + sha256_text(source.text.substr(0, hash)) + "\"]\n") != 0)
    throw Failure(Span{}, "the saved run was changed after it was written, or is cut off",
                  "start the run anew, with --save");
  SavedRun run;
  for (const Item& i : read_toml(source).items) {
    SavedRun::Texts texts;
    for (const Item& t : i.items) texts.push_back(t.text());
    run.set(i.key, std::move(texts));
  }
  return run;
}

}  // namespace anholon
