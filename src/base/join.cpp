#include "base/join.h"

namespace anholon {

std::string joined(const std::vector<std::string>& parts, std::string_view between) {
  std::string text;
  for (std::size_t k = 0; k < parts.size(); ++k) text.append(k == 0 ? "" : between).append(parts[k]);
  return text;
}

}  // namespace anholon
