#include "result/rows.h"

#include <cmath>
#include <cstring>

#include "numeric/number.h"
#include "result/shortest.h"

namespace anholon {

static char* write_number(char* to, const Row& row, std::size_t k) {
  if (k < row.texts.size() && !row.texts[k].empty()) {
    std::memcpy(to, row.texts[k].data(), row.texts[k].size());
    return to + row.texts[k].size();
  }
  const double value = row.values[k];
  if (std::isfinite(value)) return write_shortest(to, value);
  const std::string text = number_text(value);
  std::memcpy(to, text.data(), text.size());
  return to + text.size();
}

void append_number(std::string& to, const Row& row, std::size_t k) {
  char text[kShortestRoom];
  if (k < row.texts.size() && !row.texts[k].empty())
    to += row.texts[k];
  else
    to.append(text, write_number(text, {row.values}, k));
}

std::size_t room_for(const Row& row) {
  std::size_t room = (kShortestRoom + 1) * row.values.size();
  for (const std::string& text : row.texts) room += text.size();
  return room;
}

char* write_numbers(char* to, const Row& row) {
  for (std::size_t k = 0; k < row.values.size(); ++k) {
    if (k > 0) *to++ = ',';
    to = write_number(to, row, k);
  }
  return to;
}

}  // namespace anholon
