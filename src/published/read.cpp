#include "published/read.h"

#include "base/utf8.h"

namespace anholon {

namespace {

// One equation or definition: its label, and the text after it with the position of each character.
struct FileEntry {
  std::string label;  // for a definition, its name
  Span span;
  std::string text;
  std::vector<Span> places;
  bool definition = false;

  void add(std::string_view line, Span place) {
    for (std::size_t i = 0; i < line.size(); ++place.column) {
      const std::size_t width = utf8_width(line, i);
      text += line.substr(i, width);
      places.push_back(place);
      i += width;
    }
    text += '\n';
    places.push_back(place);
  }
};

class Lines {
 public:
  Lines(const SourceText& source, Diagnostics& diagnostics) : diagnostics_(diagnostics) {
    std::string_view rest = source.text;
    if (rest.substr(0, 3) == "\xef\xbb\xbf") rest.remove_prefix(3);
    for (std::uint32_t number = 1; !rest.empty(); ++number) {
      const std::size_t end = std::min(rest.find('\n'), rest.size());
      std::string_view line = rest.substr(0, end);
      rest.remove_prefix(std::min(end + 1, rest.size()));
      if (!line.empty() && line.back() == '\r') line.remove_suffix(1);
      read(line, number);
    }
  }
  std::vector<FileEntry> entries;

 private:
  void read(std::string_view line, std::uint32_t number) {
    const std::size_t start = line.find_first_not_of(" \t");
    if (start == std::string_view::npos || line[start] == '#') return;
    if (start > 0) {
      if (entries.empty())
        return refuse(number, start, 1, "an indented line continues an equation, and there is none before it",
                      "start the line with its label: 4.1: x' = y");
      if (refused_) return;
      if (line.substr(0, line.find('#')).find(':') != std::string_view::npos)
        return refuse(number, start, utf8_length(line.substr(start)),
                      "an indented line continues the equation before it, and has no label",
                      "a line that begins with a label begins without blanks: " +
                          std::string(line.substr(start, kInHint)));
      entries.back().add(line, {number, 1, 1});
      return;
    }
    if (const auto [name, equals] = definition(line); equals != std::string_view::npos) {
      refused_ = false;
      const auto column = static_cast<std::uint32_t>(
          1 + utf8_length(line.substr(0, static_cast<std::size_t>(name.data() - line.data()))));
      entries.push_back(
          {std::string(name), {number, column, static_cast<std::uint32_t>(utf8_length(name))}, {}, {}, true});
      entries.back().add(line.substr(equals + 1),
                         {number, static_cast<std::uint32_t>(utf8_length(line.substr(0, equals + 1)) + 1), 1});
      return;
    }
    const std::size_t colon = line.find(':');
    std::string_view label = line.substr(0, std::min(colon, line.size()));
    while (!label.empty() && (label.back() == ' ' || label.back() == '\t')) label.remove_suffix(1);
    const std::size_t width = std::max<std::size_t>(1, utf8_length(label));
    if (colon == std::string_view::npos || label.find('#') != std::string_view::npos)
      return refuse(number, 0, width, "an equation starts with a label", labelled(label.substr(0, kInHint)));
    if (label.empty()) return refuse(number, 0, 1, "the label is empty", "4.1: x' = y");
    for (const FileEntry& e : entries)
      if (e.label == label && !e.definition)
        return refuse(number, 0, width,
                      "the label '" + std::string(label) + "' is already used in line " + std::to_string(e.span.line));
    refused_ = false;
    entries.push_back({std::string(label), {number, 1, static_cast<std::uint32_t>(width)}, {}, {}, false});
    const std::size_t before = utf8_length(line.substr(0, colon + 1));
    entries.back().add(line.substr(colon + 1), {number, static_cast<std::uint32_t>(before + 1), 1});
  }

  static constexpr std::size_t kInHint = 40;
  // Returns a line whose colon is missing with the colon after the first word, if a space and a further word on the
  // left follow it; else a label is missing.
  static std::string labelled(std::string_view line) {
    const std::size_t space = std::min(line.find_first_of(" \t"), line.size());
    const std::size_t rest = std::min(line.find_first_not_of(" \t", space), line.size());
    constexpr std::string_view kOperators = "+-*/^=)";
    if (rest == line.size() || kOperators.find(line[rest]) != std::string_view::npos ||
        line.substr(0, space).find_first_of("+-*/^=(") != std::string_view::npos)
      return "4.1: " + std::string(line);
    return std::string(line.substr(0, space)) + ": " + std::string(line.substr(rest));
  }

  // Returns the name and the position of the '=' of `let NAME = …`; npos if the line is not a definition.
  static std::pair<std::string_view, std::size_t> definition(std::string_view line) {
    constexpr std::string_view kLet = "let";
    const std::size_t equals = line.find('='), colon = line.find(':');
    if (line.substr(0, kLet.size()) != kLet || equals == std::string_view::npos ||
        (colon != std::string_view::npos && colon < equals))
      return {{}, std::string_view::npos};
    std::string_view name = line.substr(kLet.size(), equals - kLet.size());
    if (name.empty() || (name[0] != ' ' && name[0] != '\t')) return {{}, std::string_view::npos};
    while (!name.empty() && (name.front() == ' ' || name.front() == '\t')) name.remove_prefix(1);
    while (!name.empty() && (name.back() == ' ' || name.back() == '\t')) name.remove_suffix(1);
    return {name, equals};
  }

  void refuse(std::uint32_t line, std::size_t column, std::size_t length, std::string message, std::string hint = {}) {
    refused_ = true;  // together with the lines that continue it
    diagnostics_.error({line, static_cast<std::uint32_t>(column + 1), static_cast<std::uint32_t>(length)},
                       std::move(message), std::move(hint));
  }

  Diagnostics& diagnostics_;
  bool refused_ = false;
};

bool is_vector(const Value& v) { return std::holds_alternative<Vector>(v); }

// Returns a side of the component k of an equation between vectors.
Syntax component(const Syntax& side, const Value& value, int k) {
  if (!is_vector(value)) return side;  // 0
  return {Syntax::Op::member, std::string(1, static_cast<char>('x' + k)), {side}, side.span, side.offset, side.end, {}};
}

void read_equation(FileEntry& e, Vocabulary& words, std::vector<PublishedEquation>& list) {
  const FormulaText text(std::move(e.text), std::move(e.places));
  std::vector<Syntax> sides = parse_equation(text);
  if (sides.size() != 2) throw Failure(e.span, "the equation '" + e.label + "' has no '='", "write … = 0");
  for (Syntax& s : sides) words.join(s);
  const Value left = words.value(sides[0]), right = words.value(sides[1]);
  if (!is_vector(left) && !is_vector(right)) {
    list.push_back({e.label, e.span, text, std::move(sides[0]), std::move(sides[1])});
    return;
  }
  for (const auto& [side, value] : {std::pair{&sides[0], &left}, {&sides[1], &right}})
    if (const Expr* number = std::get_if<Expr>(value); number && !is_zero(*number))
      throw Failure(side->span, "one side is a vector, this one is a number", "both are vectors, or one is 0");
  for (int k = 0; k < 3; ++k)
    list.push_back({e.label + "." + static_cast<char>('x' + k), e.span, text, component(sides[0], left, k),
                    component(sides[1], right, k)});
}

void read_definition(FileEntry& e, Vocabulary& words) {
  const FormulaText text(std::move(e.text), std::move(e.places));
  std::vector<Syntax> sides = parse_equation(text);
  if (sides.size() != 1)
    throw Failure(e.span, "the definition of '" + e.label + "' has a second '='", "let NAME = formula");
  words.join(sides[0]);
  words.let(normal_name(e.label), std::move(sides[0]), e.span);
}

}  // namespace

std::vector<PublishedEquation> read_equations(const SourceText& equations, Vocabulary& words,
                                              Diagnostics& diagnostics) {
  std::vector<PublishedEquation> list;
  Lines lines(equations, diagnostics);
  for (FileEntry& e : lines.entries) {
    try {
      if (e.definition)
        read_definition(e, words);
      else
        read_equation(e, words, list);
    } catch (const Failure& f) {
      diagnostics.add(f.diagnostic);
    }
  }
  if (list.empty() && !diagnostics.has_errors())
    diagnostics.error({}, "there is no equation in this file", "4.1: x' = y");
  return list;
}

}  // namespace anholon
