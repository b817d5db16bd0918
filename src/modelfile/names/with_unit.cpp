#include "modelfile/names/with_unit.h"

#include <algorithm>

#include "modelfile/names/names.h"
#include "modelfile/text/toml.h"

namespace anholon {

namespace {

const Item* find_key(const Item& in, Span key) {
  for (const Item& i : in.items) {
    if (i.key_span.line == key.line && i.key_span.column == key.column && !i.key.empty()) return &i;
    if (const Item* found = find_key(i, key)) return found;
  }
  return nullptr;
}

}  // namespace

bool is_with_unit(const SourceText& source, Span key) {
  try {
    const Item root = read_toml(source.of(key), key.file);
    const Item* item = find_key(root, key);
    if (!item || item->kind != Item::Kind::string) return false;
    const std::vector<Syntax> sides = parse_plain(item->formula);
    return std::any_of(sides.begin(), sides.end(), has_unit);
  } catch (const Failure&) {  // the text is read in another way, for example with indices
    return false;
  }
}

}  // namespace anholon
