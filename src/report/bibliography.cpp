#include "report/bibliography.h"

#include <algorithm>
#include <cctype>
#include <map>
#include <string_view>

#include "formulation/formulation.h"
#include "report/assets.h"

namespace anholon {

namespace {

using Fields = std::map<std::string, std::string>;

// Converts {\`A}, {\"u}, {\o}, \v{s}, as they occur in refs.bib, to characters.
std::string plain(std::string s) {
  static const std::pair<const char*, const char*> marks[] = {
      {"{\\`A}", "À"}, {"{\\\"u}", "ü"}, {"{\\\"o}", "ö"}, {"{\\\"a}", "ä"}, {"{\\o}", "ø"},
      {"{\\'e}", "é"}, {"\\v{s}", "š"},  {"\\'c", "ć"},    {"\\v{c}", "č"},  {"--", "–"}};
  for (const auto& [from, to] : marks)
    for (std::size_t at; (at = s.find(from)) != std::string::npos;) s.replace(at, std::string_view(from).size(), to);
  std::erase_if(s, [](char c) { return c == '{' || c == '}'; });
  return s;
}

std::map<std::string, Fields> read_literature() {
  std::map<std::string, Fields> all;
  const std::string_view text = literature();
  for (std::size_t at = 0; (at = text.find("\n@", at)) != std::string_view::npos;) {
    const std::size_t open = text.find('{', at), comma = text.find(',', open);
    Fields fields;
    const std::string key(text.substr(open + 1, comma - open - 1));
    at = comma;
    // name = {value}, with braces within; "}" ends the entry.
    while (true) {
      at = text.find_first_not_of(", \n\t", at);
      if (at == std::string_view::npos || text[at] == '}') break;
      const std::size_t equals = text.find('=', at), begin = text.find('{', equals);
      if (equals == std::string_view::npos || begin == std::string_view::npos) break;
      std::string name(text.substr(at, equals - at));
      std::erase_if(name, [](char c) { return std::isspace(static_cast<unsigned char>(c)) != 0; });
      std::size_t end = begin + 1;
      for (int depth = 1; end < text.size(); ++end)
        if ((depth += text[end] == '{' ? 1 : text[end] == '}' ? -1 : 0) == 0) break;
      fields[name] = plain(std::string(text.substr(begin + 1, end - begin - 1)));
      at = end + 1;
    }
    all.emplace(key, std::move(fields));
  }
  return all;
}

}  // namespace

std::string reference(const std::string& key) {
  static const std::map<std::string, Fields> all = read_literature();
  const auto it = all.find(key);
  if (it == all.end()) return {};
  const auto field = [&](const char* name) {
    const auto f = it->second.find(name);
    return f == it->second.end() ? std::string() : f->second;
  };
  std::string out = field("author");
  for (std::size_t at; (at = out.find(" and ")) != std::string::npos;) out.replace(at, 5, "; ");
  out += (out.empty() ? "" : ": ") + field("title");
  for (const char* name : {"journal", "booktitle", "publisher"})
    if (!field(name).empty()) out += ". " + field(name);
  if (!field("volume").empty()) out += " " + field("volume");
  if (!field("number").empty()) out += " (" + field("number") + ")";
  if (!field("pages").empty()) out += ", " + field("pages");
  if (!field("year").empty()) out += ", " + field("year");
  if (!field("doi").empty()) out += ". doi:" + field("doi");
  return out + ".";
}

void Bibliography::add(const std::string& entry) {
  if (!entry.empty() && std::find(entries_.begin(), entries_.end(), entry) == entries_.end()) entries_.push_back(entry);
}

void Bibliography::key(const std::string& key) { add(reference(key)); }

void Bibliography::source(const std::string& text) {
  for (const auto& [paper, key] : {std::pair{kLuoZhao, "L"}, {kQiu, "Q"}, {kMicevicRusov, "N"}})
    if (text.find(paper) != std::string::npos) return this->key(key);
  // "Laumond 1993; Bloch: Nonholonomic Mechanics and Control"
  for (std::size_t begin = 0; begin < text.size();) {
    const std::size_t end = std::min(text.find(';', begin), text.size());
    std::string part = text.substr(begin, end - begin);
    part.erase(0, part.find_first_not_of(' '));
    std::string name;
    for (char c : part.substr(0, part.find(':')))
      if (std::isalnum(static_cast<unsigned char>(c)) != 0) name += c;
    const std::string known = reference(name);
    add(known.empty() ? part + (part.empty() || part.back() == '.' ? "" : ".") : known);
    begin = end + 1;
  }
}

}  // namespace anholon
