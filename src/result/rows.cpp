#include "result/rows.h"

#include <charconv>
#include <cmath>

#include "numeric/number.h"

namespace anholon {

void append_number(std::string& to, const Row& row, std::size_t k) {
  if (k < row.texts.size() && !row.texts[k].empty()) {
    to += row.texts[k];
    return;
  }
  const double value = row.values[k];
  if (!std::isfinite(value)) {
    to += number_text(value);
    return;
  }
  char buffer[32];
  to.append(buffer, std::to_chars(buffer, buffer + sizeof buffer, value).ptr);
}

}  // namespace anholon
