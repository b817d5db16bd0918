#include "base/diagnostic.h"

#include <algorithm>
#include <map>
#include <tuple>

#include "base/escape.h"
#include "base/utf8.h"

namespace anholon {

std::string SourceText::line(std::uint32_t number) const {
  std::size_t begin = 0;
  for (std::uint32_t l = 1; l < number; ++l) {
    begin = text.find('\n', begin);
    if (begin == std::string::npos) return {};
    ++begin;
  }
  std::size_t end = text.find('\n', begin);
  if (end == std::string::npos) end = text.size();
  if (end > begin && text[end - 1] == '\r') --end;
  return text.substr(begin, end - begin);
}

void Diagnostics::error(Span span, std::string message, std::string hint) {
  add({Severity::error, span, std::move(message), std::move(hint)});
}

void Diagnostics::warning(Span span, std::string message, std::string hint) {
  add({Severity::warning, span, std::move(message), std::move(hint)});
}

bool Diagnostics::has_errors() const {
  return std::any_of(list_.begin(), list_.end(), [](const Diagnostic& d) { return d.severity == Severity::error; });
}

static const char* word(Severity s) {
  switch (s) {
  case Severity::error:
    return "error";
  case Severity::warning:
    return "warning";
  case Severity::note:
    return "note";
  }
  return "";
}

// A source line of up to this many characters is shown whole; of a longer line the part around the caret is shown.
static constexpr std::size_t kShownWidth = 160;

// Returns "file:3:9".
static std::string place_of(Span span, const SourceText& source) {
  return shown(source.name) +
         (span.line > 0 ? ":" + std::to_string(span.line) + ":" + std::to_string(span.column) : std::string());
}

// Returns the source line and a caret range.
static std::string excerpt(Span span, const SourceText& source) {
  if (span.line == 0) return "";
  const std::string number = std::to_string(span.line);
  std::size_t column = span.column > 0 ? span.column - 1 : 0;
  std::string line = source.line(span.line);
  // A line may be very long: only the part that is shown is read. A character has at most four bytes.
  const std::size_t needed = 4 * (column + kShownWidth + 1);
  if (line.size() > needed) line.resize(needed);
  if (utf8_length(line) > kShownWidth) {
    const std::size_t from = column > kShownWidth / 2 ? column - kShownWidth / 2 : 0;
    line = (from > 0 ? "…" : "") + utf8_substr(line, from, kShownWidth) + "…";
    column = column - from + (from > 0 ? 1 : 0);
  }
  line = shown(line);
  const std::size_t width = utf8_length(line);
  const std::size_t length = column < width ? std::min<std::size_t>(std::max(1U, span.length), width - column) : 1;
  return "  " + number + " | " + line + "\n  " + std::string(number.size(), ' ') + " | " + std::string(column, ' ') +
         "^" + std::string(length - 1, '~') + "\n";
}

std::string print(const Diagnostic& d, const SourceText& main) {
  const SourceText& source = main.of(d.span);
  return place_of(d.span, source) + ": " + word(d.severity) + ": " + shown(d.message) + "\n" + excerpt(d.span, source) +
         (d.hint.empty() ? "" : "hint: " + shown(d.hint) + "\n");
}

std::string print_place(Span span, const SourceText& main) {
  if (span.line == 0) return "";
  const SourceText& source = main.of(span);
  return place_of(span, source) + ":\n" + excerpt(span, source);
}

std::string line_of(Span span, const SourceText& source) {
  return "line " + std::to_string(span.line) + (span.file > 0 ? " of " + source.of(span).name : "");
}

std::string Diagnostics::print(const SourceText& source) const {
  std::vector<const Diagnostic*> sorted;
  for (const Diagnostic& d : list_) sorted.push_back(&d);
  std::stable_sort(sorted.begin(), sorted.end(), [](const Diagnostic* a, const Diagnostic* b) {
    if (a->span.file != b->span.file) return a->span.file < b->span.file;
    return a->span.line != b->span.line ? a->span.line < b->span.line : a->span.column < b->span.column;
  });
  SourceText all = source;
  if (all.others.empty()) all.others = others;
  // At most this many reports are printed; each costs a search for its line.
  constexpr std::size_t kShown = 100;
  std::string out;
  for (std::size_t i = 0; i < sorted.size() && i < kShown; ++i) out += anholon::print(*sorted[i], all);
  if (sorted.size() > kShown) out += "… and " + std::to_string(sorted.size() - kShown) + " more\n";
  return out;
}

static bool before(const Span& a, const Span& b) {
  return std::tuple(a.file, a.line, a.column) < std::tuple(b.file, b.line, b.column);
}

// Says where else a mistake stands: "it stands in line 7, too". Of a part of the file that is not read any further, no
// mistakes are known, so the text does not tell their number.
static std::string said_of_others(const std::vector<Span>& others, const Span& first) {
  constexpr std::size_t kNamed = 3;
  std::vector<std::uint32_t> lines;
  for (const Span& o : others)
    if (o.file == first.file && o.line != first.line && (lines.empty() || lines.back() != o.line))
      lines.push_back(o.line);
  if (lines.empty()) return others[0].file == first.file ? "it stands in this line again" : "it stands further, too";
  std::string list;
  for (std::size_t k = 0; k < std::min(lines.size(), kNamed); ++k) list += (k ? ", " : "") + std::to_string(lines[k]);
  return std::string(lines.size() > 1 ? "it stands in lines " : "it stands in line ") + list +
         (lines.size() > kNamed ? " and others, too" : ", too");
}

void Diagnostics::gather(const std::function<bool(const std::string&)>& is_one) {
  std::map<std::string, std::vector<std::size_t>> alike;
  for (std::size_t k = 0; k < list_.size(); ++k)
    if (is_one(list_[k].message)) alike[list_[k].message + "\n" + list_[k].hint].push_back(k);
  std::vector<bool> left_out(list_.size(), false);
  for (auto& [message, places] : alike) {
    std::stable_sort(places.begin(), places.end(),
                     [&](std::size_t a, std::size_t b) { return before(list_[a].span, list_[b].span); });
    std::vector<Span> further;
    for (std::size_t k = 1; k < places.size(); ++k) {
      left_out[places[k]] = true;
      if (const Span& other = list_[places[k]].span; before(list_[places[k - 1]].span, other)) further.push_back(other);
    }
    if (further.empty()) continue;
    std::string& hint = list_[places[0]].hint;
    hint += (hint.empty() ? "" : "; ") + said_of_others(further, list_[places[0]].span);
  }
  std::vector<Diagnostic> kept;
  for (std::size_t k = 0; k < list_.size(); ++k)
    if (!left_out[k]) kept.push_back(std::move(list_[k]));
  list_ = std::move(kept);
}

void Diagnostics::leave_out(const std::function<bool(const std::string&)>& is_consequence) {
  std::erase_if(list_, [&](const Diagnostic& d) { return is_consequence(d.message); });
}

static std::size_t edit_distance(const std::string& a, const std::string& b) {
  // Insertion, deletion, replacement and the exchange of neighbours count one each.
  std::vector<std::vector<std::size_t>> d(a.size() + 1, std::vector<std::size_t>(b.size() + 1));
  for (std::size_t i = 0; i <= a.size(); ++i) d[i][0] = i;
  for (std::size_t j = 0; j <= b.size(); ++j) d[0][j] = j;
  for (std::size_t i = 1; i <= a.size(); ++i)
    for (std::size_t j = 1; j <= b.size(); ++j) {
      d[i][j] = std::min({d[i - 1][j] + 1, d[i][j - 1] + 1, d[i - 1][j - 1] + (a[i - 1] == b[j - 1] ? 0 : 1)});
      if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1])
        d[i][j] = std::min(d[i][j], d[i - 2][j - 2] + 1);
    }
  return d[a.size()][b.size()];
}

// Returns the name in small letters.
static std::string small(std::string name) {
  for (char& c : name)
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  return name;
}

static std::string sorted(std::string letters) {
  std::sort(letters.begin(), letters.end());
  return letters;
}

std::string did_you_mean(const std::string& name, const std::vector<std::string>& candidates) {
  for (const std::string& c : candidates)
    if (c != name && small(c) == small(name)) return c;
  std::string best;
  std::size_t best_distance = std::max<std::size_t>(1, name.size() / 3) + 1;
  if (name.size() > 64 || name.size() < 2) return best;
  for (const std::string& c : candidates) {
    if (c == name || c.size() > 64 ||
        std::max(c.size(), name.size()) - std::min(c.size(), name.size()) >= best_distance)
      continue;
    // Four or more letters that are only in another order count as one mistake: tetha.
    const std::size_t distance = name.size() > 3 && sorted(name) == sorted(c) ? 1 : edit_distance(name, c);
    if (distance < best_distance && distance < std::max(c.size(), name.size())) {
      best = c;
      best_distance = distance;
    }
  }
  return best;
}

}  // namespace anholon
