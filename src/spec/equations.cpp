#include "spec/equations.h"

#include "base/utf8.h"

namespace anholon {

namespace {

// lambda.blade is one name: members of a multiplier mean nothing else.
bool dotted(const Syntax& s, std::string& path) {
  if (s.op == Syntax::Op::name && s.text == "lambda") {
    path = s.text;
    return true;
  }
  if (s.op != Syntax::Op::member || !dotted(s.args[0], path)) return false;
  path += "." + s.text;
  return true;
}

void join_multipliers(Syntax& s) {
  std::string path;
  if (s.op == Syntax::Op::member && dotted(s, path)) {
    const Syntax* first = &s;
    while (first->op == Syntax::Op::member) first = &first->args[0];
    Span span = first->span;
    span.length = static_cast<std::uint32_t>(s.end - s.offset);
    s = Syntax{Syntax::Op::name, path, {}, span, s.offset, s.end, {}};
    return;
  }
  for (Syntax& a : s.args) join_multipliers(a);
}

// One equation: its label, and the text after it with the place of each character.
struct Entry {
  std::string label;
  Span span;
  std::string text;
  std::vector<Span> places;

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
  std::vector<Entry> entries;

 private:
  void read(std::string_view line, std::uint32_t number) {
    const std::size_t start = line.find_first_not_of(" \t");
    if (start == std::string_view::npos || line[start] == '#') return;
    if (start > 0) {
      if (entries.empty()) return refuse(number, start, 1, "an indented line continues an equation, and there is none before it", "start the line with its label: 4.1: x' = y");
      if (!refused_) entries.back().add(line, {number, 1, 1});
      return;
    }
    const std::size_t colon = line.find(':');
    std::string_view label = line.substr(0, std::min(colon, line.size()));
    while (!label.empty() && (label.back() == ' ' || label.back() == '\t')) label.remove_suffix(1);
    const std::size_t width = std::max<std::size_t>(1, utf8_length(label));
    if (colon == std::string_view::npos || label.find('#') != std::string_view::npos)
      return refuse(number, 0, width, "an equation starts with a label", "4.1: " + std::string(label.substr(0, 40)));
    if (label.empty()) return refuse(number, 0, 1, "the label is empty", "4.1: x' = y");
    for (const Entry& e : entries)
      if (e.label == label) return refuse(number, 0, width, "the label '" + std::string(label) + "' is already used in line " + std::to_string(e.span.line));
    refused_ = false;
    entries.push_back({std::string(label), {number, 1, static_cast<std::uint32_t>(width)}, {}, {}});
    const std::size_t before = utf8_length(line.substr(0, colon + 1));
    entries.back().add(line.substr(colon + 1), {number, static_cast<std::uint32_t>(before + 1), 1});
  }

  void refuse(std::uint32_t line, std::size_t column, std::size_t length, std::string message, std::string hint = {}) {
    refused_ = true;  // and with it the lines that continue it
    diagnostics_.error({line, static_cast<std::uint32_t>(column + 1), static_cast<std::uint32_t>(length)}, std::move(message), std::move(hint));
  }

  Diagnostics& diagnostics_;
  bool refused_ = false;
};

}  // namespace

std::vector<PublishedEquation> read_equations(const SourceText& equations, const OpenModel& model, Diagnostics& diagnostics) {
  std::vector<PublishedEquation> list;
  Lines lines(equations, diagnostics);
  for (Entry& e : lines.entries) {
    PublishedEquation p{e.label, e.span, FormulaText(std::move(e.text), std::move(e.places)), {}, {}};
    try {
      std::vector<Syntax> sides = parse_equation(p.source);
      if (sides.size() != 2) throw Failure(e.span, "the equation '" + e.label + "' has no '='", "write … = 0");
      for (Syntax& s : sides) {
        join_multipliers(s);
        evaluate_number(s, *model.names);
      }
      p.left = std::move(sides[0]);
      p.right = std::move(sides[1]);
      list.push_back(std::move(p));
    } catch (const Failure& f) {
      diagnostics.add(f.diagnostic);
    }
  }
  if (list.empty() && !diagnostics.has_errors()) diagnostics.error({}, "there is no equation in this file", "4.1: x' = y");
  return list;
}

}  // namespace anholon
