#include "result/choose_columns.h"

#include <algorithm>

#include "base/diagnostic.h"

namespace anholon {

std::string list_of_columns(const std::vector<std::string>& names) {
  constexpr std::size_t kMost = 60;
  std::string list;
  for (std::size_t i = 0; i < names.size() && i < kMost; ++i) list += (i ? " " : "") + names[i];
  return list + (names.size() > kMost ? " …" : "");
}

// The hint for a name that is not a column: "; did you mean …"; "" if no name is near.
static std::string meant_by(const std::vector<std::string>& columns, const std::string& name) {
  for (const std::string& c : columns) {
    // The normal force of a contact is lambda.NAME in formulas.
    if (name.starts_with("lambda.") && c == name.substr(7) + ".normal") return "; did you mean '" + c + "'?";
    if (c.starts_with(name + "[")) return "; " + name + " has members such as '" + c + "'";
  }
  const std::string near = did_you_mean(name, columns);
  return near.empty() ? "" : "; did you mean '" + near + "'?";
}

void unknown_column(const std::vector<std::string>& columns, const std::string& name) {
  const bool pattern = name.find_first_of("*?") != std::string::npos;
  throw Failure(
      Span{}, pattern ? "no column fits '" + name + "'" : "there is no column '" + name + "'" + meant_by(columns, name),
      "the columns are " + list_of_columns(columns));
}

bool matches(const std::string& pattern, const std::string& name) {
  std::size_t p = 0, n = 0, star = std::string::npos, back = 0;
  while (n < name.size()) {
    if (p < pattern.size() && pattern[p] == '*')
      star = p++, back = n;
    else if (p < pattern.size() && (pattern[p] == '?' || pattern[p] == name[n]))
      ++p, ++n;
    else if (star != std::string::npos)
      p = star + 1, n = ++back;
    else
      return false;
  }
  while (p < pattern.size() && pattern[p] == '*') ++p;
  return p == pattern.size();
}

std::vector<std::size_t> chosen_columns(const std::vector<std::string>& columns, const std::vector<std::string>& names,
                                        std::size_t without) {
  std::vector<std::size_t> list;
  const auto add = [&](std::size_t k) {
    if (std::find(list.begin(), list.end(), k) == list.end()) list.push_back(k);
  };
  for (const std::string& name : names) {
    if (const auto at = std::find(columns.begin(), columns.end(), name); at != columns.end()) {
      add(static_cast<std::size_t>(at - columns.begin()));
      continue;
    }
    bool any = false;
    for (std::size_t k = 0; k < columns.size(); ++k)
      if (matches(name, columns[k])) {
        any = true;
        if (k != without) add(k);
      }
    if (!any) unknown_column(columns, name);
  }
  return list;
}

}  // namespace anholon
