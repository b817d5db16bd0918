#include "modelfile/text/syntax_error.h"

#include <algorithm>
#include <optional>
#include <regex>

#include "base/utf8.h"
#include "modelfile/language/language.h"

namespace anholon {

namespace {

std::string trimmed(const std::string& s) {
  const std::size_t from = s.find_first_not_of(" \t\r");
  return from == std::string::npos ? "" : s.substr(from, s.find_last_not_of(" \t\r") - from + 1);
}

bool is_bare_key(const std::string& s) {
  return !s.empty() && std::all_of(s.begin(), s.end(), [](unsigned char c) {
    return std::isalnum(c) || c == '_' || c == '-' || c == '.' || c == ' ';
  });
}

// The line in which the parser stopped, and its description of the mistake.
struct Place {
  Place(std::string_view description, Span where, const SourceText& source)
      : parser(description), span(where), line(source.line(where.line)) {
    std::size_t at = 0;
    for (std::uint32_t column = 1; column < span.column && at < line.size(); ++column) at += utf8_width(line, at);
    rest = line.substr(at);
    // The sign = that ends the key is the first outside of quotes.
    char quote = 0;
    equals = std::string::npos;
    for (std::size_t i = 0; i < line.size() && equals == std::string::npos; ++i)
      if (quote ? line[i] == quote : line[i] == '"')
        quote = quote ? '\0' : line[i];
      else if (!quote && line[i] == '=')
        equals = i;
    key = trimmed(line.substr(0, equals));
    if (equals == std::string::npos) return;
    const std::string after = line.substr(equals + 1);
    value = trimmed(after.find_first_of("\"'") == std::string::npos ? after.substr(0, after.find('#')) : after);
  }

  bool says(const char* words) const { return parser.find(words) != std::string::npos; }
  bool has_value() const { return equals != std::string::npos; }
  // Returns the place of a text at the beginning of the line, after blanks.
  Span at_start(const std::string& text) const {
    Span s = span;
    s.column = static_cast<std::uint32_t>(std::min(line.find_first_not_of(" \t"), line.size()) + 1);
    s.length = static_cast<std::uint32_t>(std::max<std::size_t>(text.size(), 1));
    return s;
  }

  std::string parser;
  Span span;
  std::string line;
  std::string rest;  // the line from the place on
  std::size_t equals;
  std::string key, value;  // without blanks around them; the value without a comment after it
};

using Found = std::optional<Failure>;

// Returns the name between the first quotes of the parser's description.
std::string quoted_name(const std::string& description) {
  const std::size_t quote = description.find('\'');
  if (quote == std::string::npos) return "";
  return description.substr(quote + 1, description.find('\'', quote + 1) - quote - 1);
}

// Reports [body] at one place and [[body]] at another, and a section or a key that exists already.
Found is_there_already(const Place& p) {
  if (!p.says("cannot redefine existing ")) return {};
  const std::string name = quoted_name(p.parser);
  const std::size_t first = p.line.find_first_not_of(" \t");
  if (first == std::string::npos || p.line[first] != '[')
    return Failure(p.span, "'" + name + "' is there already", "leave out one of the two");
  const bool of_list = std::any_of(language().begin(), language().end(), [&](const LanguageSection& s) {
    return s.form == LanguageSection::Form::elements && name == s.name;
  });
  if (of_list && p.says("existing array '") && p.says("as array-of-tables"))
    return Failure(p.span, "'" + name + "' is a list in one place and [[" + name + "]] in another",
                   "write all of them as [[" + name + "]], or all in the list " + name + " = […]");
  if (of_list)
    return Failure(p.span, "'" + name + "' stands with one bracket and with two",
                   "write [[" + name + "]] with two brackets for each of them");
  return Failure(p.span, "'" + name + "' is there already",
                 "a section [" + name + "] stands once: put all its lines together");
}

Found text_left_open(const Place& p) {
  if (p.says("in string: encountered end-of-file"))
    return Failure(p.span, "a text is not closed at the end of the file", "a text ends with the quotes it began with");
  if (!p.says("control characters other than TAB")) return {};
  return Failure(p.span, "this text is not closed in its line",
                 "a text ends with the quote it began with; one over several lines stands in three quotes");
}

Found unknown_escape(const Place& p) {
  if (!p.says("unknown escape sequence '")) return {};
  return Failure(p.span, "'" + quoted_name(p.parser) + "' has no meaning in a text",
                 "a text in single quotes keeps its \\ as it is: 'a\\b'");
}

// Reports "let C = 5", "const double C = 5;", "let C: f64 = 5", which are declarations of a number in other languages.
Found declaration(const Place& p) {
  static const std::regex form(
      R"(\s*((?:let|var|const|def|set|param|parameter|parameters|define|real|double|float)(?:\s+[A-Za-z_]\w*)?)\s+)"
      R"(([A-Za-z_]\w*)\s*(?::\s*\w+\s*)?:?=\s*(.*))");
  std::smatch found;
  if (p.line.size() >= 1000 || !std::regex_match(p.line, found, form)) return {};
  const std::string word = found[1].str(), name = found[2].str();
  std::string value = trimmed(found[3].str());
  if (value.ends_with(";")) value.pop_back();
  return Failure(p.at_start(word), "'" + word + "' declares nothing in a model file",
                 "a parameter stands under [parameters]: " + name + " = " + (value.empty() ? "…" : value) +
                     "; a formula under [define], a function of t under [functions]");
}

Found other_comment(const Place& p) {
  if (!p.says("saw '")) return {};
  for (const std::string sign : {"//", "/*", "%", "--"})
    if (p.rest.starts_with(sign)) return Failure(p.span, "'" + sign + "' begins no comment", "a comment begins with #");
  if (p.rest.starts_with(";"))
    return Failure(p.span, "a line ends without ';'", p.has_value() ? trimmed(p.line.substr(0, p.line.find(';'))) : "");
  return {};
}

// Reports a key that is not followed by a sign =.
Found sign_missing(const Place& p) {
  if (!p.says("in key-value pair: expected '='")) return {};
  const std::string value = p.value.empty() ? "…" : p.value;
  if (p.rest.starts_with(":")) {
    const std::string name = trimmed(p.line.substr(0, p.line.size() - p.rest.size()));
    const std::size_t from = p.rest.find_first_not_of(":= \t");
    return Failure(p.span, "a ':' stands in place of '='",
                   name + " = " + (from == std::string::npos ? "…" : trimmed(p.rest.substr(from))));
  }
  if (!p.has_value() && p.rest.starts_with("]"))
    return Failure(p.span, "a bracket '[' is missing", "[" + p.line.substr(0, p.line.find(']') + 1));
  if (!p.has_value()) return Failure(p.span, "a '=' is missing", "a line is NAME = VALUE, a [section] or a # comment");
  if (p.key.find('"') != std::string::npos || is_bare_key(p.key)) return {};
  const bool primes = p.key.find('\'') != std::string::npos;
  return Failure(p.span,
                 primes ? "a key with ' stands in quotes"
                        : "a key with other characters than A-Z a-z 0-9 _ - stands in quotes",
                 "\"" + p.key + "\" = " + value);
}

Found header_left_open(const Place& p) {
  if (!p.says("in table header")) return {};
  std::string name = p.line.substr(0, p.line.find('#'));
  std::erase_if(name, [](char c) { return c == '[' || c == ']'; });
  name = trimmed(name);
  const bool two = trimmed(p.line).starts_with("[[");
  if (!is_bare_key(name)) return {};
  const std::string right = (two ? "[[" : "[") + name + (two ? "]]" : "]");
  if (p.says("expected ']'")) return Failure(p.span, "a bracket ']' is missing", right);
  if (p.rest.starts_with("]")) return Failure(p.span, "a bracket ']' is too many", right);
  return {};
}

Found list_left_open(const Place& p) {
  if (p.says("in array: encountered end-of-file") || p.says("in array: expected comma or closing ']', saw '['"))
    return Failure(p.span, "the list before this place is not closed", "a list ends with ]");
  if (p.says("in inline table") && p.says("saw '\\n'"))
    return Failure(p.span, "this table in braces is not closed in its line",
                   "{value = 3, unit = \"m\"} in one line, or a [section] of its own");
  return {};
}

// Reports a text of a list without its second quote, which ends at the first quote of the next text: ["x", "y, "psi"].
Found quote_forgotten(const Place& p) {
  const std::size_t at = p.line.size() - p.rest.size();
  if (!p.says("in array: expected comma or closing ']'") || at < 2 || p.line[at - 1] != '"') return {};
  const std::size_t begin = p.line.rfind('"', at - 2);
  if (begin == std::string::npos) return {};
  const std::size_t comma = p.line.find(',', begin);
  if (comma >= at) return {};
  std::string right = p.line;
  right.insert(comma, "\"");
  return Failure(p.span, "a quote is missing before this place, at the end of " + p.line.substr(begin, comma - begin),
                 trimmed(right));
}

// Reports a number with a comma, a point at its end or a zero at its start.
Found number(const Place& p) {
  if (p.says("saw ','") && p.span.column > 1 && p.span.column - 2 < p.line.size() &&
      std::isdigit(static_cast<unsigned char>(p.line[p.span.column - 2])))
    return Failure(p.span, "',' after a number", "a decimal has a point: 0.5; a list stands in brackets: [1, 2]");
  const auto written = [&](const std::string& number) { return p.key + " = " + number; };
  if (p.says("in floating-point: expected decimal digit")) {
    if (p.value.starts_with(".")) return Failure(p.span, "a digit before the point is missing", written("0" + p.value));
    if (p.value.ends_with(".")) return Failure(p.span, "a digit after the point is missing", written(p.value + "0"));
  }
  if (p.says("leading zeroes") && p.value.find_first_not_of('0') != std::string::npos)
    return Failure(p.span, "a number begins with a 0 too many",
                   written(p.value.substr(p.value.find_first_not_of('0'))));
  for (const auto& [word, right] : {std::pair{"True", "true"}, {"False", "false"}})
    if (p.says("in boolean") && p.rest.starts_with(word))
      return Failure(p.span, "true and false have small letters", right);
  return {};
}

// Reports a formula without quotes, or text beside a formula with quotes.
Found formula_without_quotes(const Place& p) {
  if (!p.has_value()) return {};
  if (p.value.empty()) return Failure(p.span, "a value is missing after '='");
  if (p.value.starts_with("=")) return Failure(p.span, "a '=' is too many", p.key + " = " + trimmed(p.value.substr(1)));
  const bool stops = p.says("could not determine value type") || p.says("saw '") || p.says("encountered end-of-file");
  const char first = p.value[0];
  if (!stops || first == '[' || first == '{' || !is_bare_key(p.key)) return {};
  if (first == '"' || first == '\'') {
    if (!p.says("in key-value pair: expected a comment or whitespace")) return {};
    return Failure(p.span, "this stands after the quote that ends the text", "a formula stands in one pair of quotes");
  }
  if (p.value.find_first_of("\"'") != std::string::npos) return {};
  if (p.value.find('=') != std::string::npos)
    return Failure(p.span, "a line holds one value, or an equation in quotes", "NAME = VALUE in a line of its own");
  return Failure(p.span, "a formula stands in quotes", p.key + " = \"" + p.value + "\"");
}

// Reports a formula without quotes within a list or a table in braces, such as x in [x, "y", 0] and 0.5*2 in {a = 0.5*2}.
Found element_without_quotes(const Place& p) {
  if (!p.says("could not determine value type") && !p.says("expected digit") && !p.says("expected decimal digit") &&
      !p.says("in array: expected comma") && !p.says("expected exponent") && !p.says("in inline table: expected") &&
      !p.says("in floating-point:") && !p.says("in decimal integer:"))
    return {};
  const std::size_t at = p.line.size() - p.rest.size();
  const std::size_t before = at == 0 ? std::string::npos : p.line.find_last_of("[{,=", at - 1);
  const std::size_t begin = before == std::string::npos ? 0 : before + 1;
  int depth = 0;
  std::size_t end = begin;
  for (; end < p.line.size() && (depth > 0 || std::string_view(",]}#").find(p.line[end]) == std::string_view::npos);
       ++end)
    depth += (p.line[end] == '(') - (p.line[end] == ')');
  const std::string element = trimmed(p.line.substr(begin, end - begin));
  if (element.empty() || element.find_first_of("\"'=[]{}") != std::string::npos) return {};
  return Failure(p.span, "a formula stands in quotes", "\"" + element + "\"");
}

}  // namespace

Failure syntax_error(std::string_view description, Span span, const SourceText& source) {
  std::string message(description);
  constexpr std::string_view kPrefix = "Error while parsing ";
  if (message.starts_with(kPrefix)) message = "in " + message.substr(kPrefix.size());
  const Place place(message, span, source);
  for (const auto rule :
       {is_there_already, text_left_open, unknown_escape, declaration, other_comment, sign_missing, header_left_open,
        list_left_open, quote_forgotten, number, formula_without_quotes, element_without_quotes})
    if (Found found = rule(place)) return *found;
  if (place.says("could not determine value type"))
    return Failure(span, "this is no number, and no text in quotes", "a formula stands in quotes: name = \"a*b\"");
  return Failure(span, message);
}

}  // namespace anholon
