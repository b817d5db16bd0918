#include "report/markup.h"

namespace anholon {

std::string user(const std::string& text) { return "<bdi>" + markup_escape(text) + "</bdi>"; }

std::string attribute(const char* name, const std::string& value) {
  return std::string(" ") + name + "=\"" + markup_escape(value) + "\"";
}

std::string math(const std::string& row) { return "<math>" + row + "</math>"; }

static std::string row(const std::vector<std::string>& cells, const char* tag) {
  std::string out = "<tr>";
  for (std::size_t k = 0; k < cells.size(); ++k)
    if (cells[k].empty())
      out += "<td></td>";  // a head without a text would be read out as one
    else
      out += k == 0 && tag[1] == 'd' ? "<th scope=\"row\">" + cells[k] + "</th>"
                                     : std::string("<") + tag + ">" + cells[k] + "</" + tag + ">";
  return out + "</tr>\n";
}

std::string table(const std::string& caption, const std::vector<std::string>& head,
                  const std::vector<std::vector<std::string>>& rows) {
  if (rows.empty()) return "";
  std::string out = "<div class=\"wide\" tabindex=\"0\" role=\"region\"" + attribute("aria-label", caption) +
                    "><table><caption>" + markup_escape(caption) + "</caption>";
  if (!head.empty()) out += "<thead>" + row(head, "th") + "</thead>";
  out += "<tbody>\n";
  for (const auto& r : rows) out += row(r, "td");
  return out + "</tbody></table></div>\n";
}

}  // namespace anholon
