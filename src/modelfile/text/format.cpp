#include "modelfile/text/format.h"

#include <algorithm>

#include "base/utf8.h"

namespace anholon {

namespace {

constexpr std::size_t kWidth = 120;

// A value as written: a scalar with its text, a list or an inline table with its elements.
struct Written {
  enum class Kind { scalar, list, table } kind = Kind::scalar;
  std::string text;  // for a scalar, with its quotes
  std::string key;   // in a table
  std::vector<Written> elements;
  std::size_t blanks = 1;          // blanks in front, after the comma of the previous element
  std::vector<std::string> above;  // comments on lines of their own; "" for an empty line
  std::string comment;             // at the end of its line
  std::size_t column = 0;          // the column of the comment
  std::vector<std::string> below;  // comments before the closing bracket
  bool broken = false;             // the author put elements on lines of their own
};

struct Line {
  enum class Kind { blank, comment, header, entry } kind = Kind::blank;
  std::string text;  // text of a comment or header
  std::string key;
  Written value;
  std::string comment;
  std::size_t column = 0;
};

// Reads a text that is known to be TOML.
class Text {
 public:
  explicit Text(const std::string& text) : s_(text) {
    if (s_.compare(0, 3, "\xEF\xBB\xBF") == 0) at_ = 3;
  }

  std::vector<Line> lines() {
    std::vector<Line> list;
    while (at_ < s_.size()) {
      skip_blanks();
      Line line;
      if (at_ < s_.size() && s_[at_] == '#') {
        line.kind = Line::Kind::comment;
        line.text = comment();
      } else if (at_ < s_.size() && s_[at_] == '[') {
        line.kind = Line::Kind::header;
        line.text = header();
      } else if (at_ < s_.size() && s_[at_] != '\n') {
        line.kind = Line::Kind::entry;
        line.key = key();
        skip_blanks();
        ++at_;  // =
        skip_blanks();
        line.value = value();
      }
      skip_blanks();
      if (line.kind != Line::Kind::comment && is('#')) line.column = column(), line.comment = comment();
      if (at_ < s_.size() && s_[at_] == '\n') ++at_;
      list.push_back(std::move(line));
    }
    return list;
  }

  std::vector<std::string> comments;  // all of them, in order

 private:
  bool is(char c) const { return at_ < s_.size() && s_[at_] == c; }
  void skip_blanks() {
    while (is(' ') || is('\t') || is('\r')) ++at_;
  }

  std::size_t column() const {
    const std::size_t before = at_ == 0 ? std::string::npos : s_.rfind('\n', at_ - 1),
                      begin = before == std::string::npos ? 0 : before + 1;
    return utf8_length(s_.substr(begin, at_ - begin));
  }

  std::string comment() {
    const std::size_t end = std::min(s_.find('\n', at_), s_.size());
    std::string c = s_.substr(at_, end - at_);
    c.erase(c.find_last_not_of(" \t\r") + 1);
    at_ = end;
    comments.push_back(c);
    return c;
  }

  std::string quoted() {
    const std::string quote =
        s_.compare(at_, 3, std::string(3, s_[at_])) == 0 ? std::string(3, s_[at_]) : std::string(1, s_[at_]);
    const std::size_t begin = at_;
    for (at_ += quote.size(); at_ < s_.size() && s_.compare(at_, quote.size(), quote) != 0; ++at_)
      if (quote[0] == '"' && s_[at_] == '\\') ++at_;
    at_ = std::min(at_ + quote.size(), s_.size());
    // Three quotes may close a text that ends with one or two more.
    while (quote.size() == 3 && is(quote[0])) ++at_;
    return s_.substr(begin, at_ - begin);
  }

  std::string key() {
    std::string out;
    for (;; ++at_) {
      skip_blanks();
      // In a key two quotes are an empty text, never the start of a multi-line one.
      if (is('"') || is('\'')) {
        const char quote = s_[at_];
        const std::size_t begin = at_++;
        for (; at_ < s_.size() && s_[at_] != quote; ++at_)
          if (quote == '"' && s_[at_] == '\\') ++at_;
        at_ = std::min(at_ + 1, s_.size());
        out += s_.substr(begin, at_ - begin);
      } else {
        const std::size_t end = std::min(s_.find_first_of(" \t.=]\n", at_), s_.size());
        out += s_.substr(at_, end - at_);
        at_ = end;
      }
      skip_blanks();
      if (!is('.')) return out;
      out += '.';
    }
  }

  std::string header() {
    const bool twice = s_.compare(at_, 2, "[[") == 0;
    at_ += twice ? 2 : 1;
    const std::string name = key();
    at_ = std::min(at_ + (twice ? 2 : 1), s_.size());
    return twice ? "[[" + name + "]]" : "[" + name + "]";
  }

  Written value() {
    Written v;
    if (is('[')) return list();
    if (is('{')) return table();
    if (is('"') || is('\'')) {
      v.text = quoted();
      return v;
    }
    const std::size_t end = std::min(s_.find_first_of(",]}#\n", at_), s_.size());
    v.text = s_.substr(at_, end - at_);
    v.text.erase(v.text.find_last_not_of(" \t\r") + 1);
    at_ = end;
    return v;
  }

  Written table() {
    Written t;
    t.kind = Written::Kind::table;
    ++at_;
    for (std::size_t blanks = 1; at_ < s_.size();) {
      const std::size_t from = at_;
      skip_blanks();
      if (!t.elements.empty()) blanks = std::max<std::size_t>(1, at_ - from);
      if (is('}')) break;
      std::string name = key();
      skip_blanks();
      ++at_;  // =
      skip_blanks();
      Written v = value();
      v.key = std::move(name);
      v.blanks = blanks;
      t.elements.push_back(std::move(v));
      skip_blanks();
      if (!is(',')) break;
      ++at_;
    }
    if (at_ < s_.size()) ++at_;
    return t;
  }

  Written list() {
    Written l;
    l.kind = Written::Kind::list;
    ++at_;
    std::vector<std::string> waiting;  // comments for the next element
    bool fresh = false, comma = true;  // fresh: a new line has begun
    std::size_t empty = 0;
    while (at_ < s_.size() && !is(']')) {
      skip_blanks();
      if (is('\n')) {
        ++at_, ++empty, fresh = true;
      } else if (is('#')) {
        if (!fresh && !l.elements.empty() && l.elements.back().comment.empty()) {
          l.elements.back().column = column();
          l.elements.back().comment = comment();
        } else {
          if (empty > 1 && !(l.elements.empty() && waiting.empty())) waiting.emplace_back();
          waiting.push_back(comment());
        }
        empty = 0;
      } else if (is(',')) {
        ++at_, comma = true;
      } else if (!is(']')) {
        if (!comma || at_ >= s_.size()) break;  // not TOML
        if (empty > 1 && !(l.elements.empty() && waiting.empty())) waiting.emplace_back();
        l.broken = l.broken || fresh;
        Written v = value();
        v.above = std::move(waiting);
        waiting.clear();
        l.elements.push_back(std::move(v));
        fresh = comma = false;
        empty = 0;
      }
    }
    l.below = std::move(waiting);
    if (at_ < s_.size()) ++at_;
    return l;
  }

  const std::string& s_;
  std::size_t at_ = 0;
};

bool has_comments(const Written& v) {
  return !v.above.empty() || !v.comment.empty() || !v.below.empty() ||
         std::any_of(v.elements.begin(), v.elements.end(), has_comments);
}

// True if an inner list is broken or contains comments.
bool has_lines(const Written& v) {
  return v.broken || has_comments(v) || std::any_of(v.elements.begin(), v.elements.end(), has_lines);
}

bool is_number(const Written& v) {
  return v.kind == Written::Kind::scalar && !v.text.empty() &&
         std::string("+-.0123456789").find(v.text[0]) != std::string::npos;
}

// A line of code, perhaps with a comment: comments on neighbouring lines start in the same column, that of the author's
// first comment if it is far enough to the right.
struct Commented {
  std::string code, comment;
  std::size_t column = 0;
};
void print(std::string& out, const std::vector<Commented>& lines, const std::string& indent) {
  const auto width = [&](const Commented& l) {
    return utf8_length(l.code.substr(l.code.rfind('\n') + 1)) +
           (l.code.find('\n') == std::string::npos ? indent.size() : 0);
  };
  for (std::size_t i = 0; i < lines.size();) {
    std::size_t end = i, column = 0;
    for (; end < lines.size() && !lines[end].comment.empty() == !lines[i].comment.empty(); ++end)
      if (width(lines[end]) <= kWidth * 2 / 3) column = std::max(column, width(lines[end]) + 2);
    if (lines[i].column <= kWidth * 2 / 3) column = std::max(column, lines[i].column);
    for (; i < end; ++i) {
      out += (lines[i].code.empty() ? "" : indent) + lines[i].code;
      if (!lines[i].comment.empty()) {
        const std::size_t w = width(lines[i]);
        out += std::string(w + 2 < column ? column - w : 2, ' ') + lines[i].comment;
      }
      out += '\n';
    }
  }
}

std::string flat(const Written& v) {
  if (v.kind == Written::Kind::scalar) return v.text;
  const bool table = v.kind == Written::Kind::table;
  std::string out;
  for (const Written& e : v.elements) {
    if (!out.empty()) out += ", ";
    out += (table ? e.key + " = " : "") + flat(e);
  }
  return table ? "{" + out + "}" : "[" + out + "]";
}

// Returns the text of a value that begins in this column of a line with this indentation.
std::string text_of(const Written& v, std::size_t indent, std::size_t column, bool aligned = false) {
  if (v.kind == Written::Kind::table) {
    std::string out;
    for (const Written& e : v.elements) {
      if (!out.empty()) out += "," + std::string(aligned ? e.blanks : 1, ' ');
      out += e.key + " = ";
      // An inner list stays on the line if it fits.
      out += text_of(e, indent, utf8_length(out.substr(out.rfind('\n') + 1)));
    }
    return "{" + out + "}";
  }
  if (v.kind == Written::Kind::scalar) return v.text;
  const std::string line = flat(v);
  const bool several = v.elements.size() > 1;
  if (!has_lines(v) && (!several || column + utf8_length(line) <= kWidth)) return line;
  if (v.elements.empty() && v.below.empty()) return "[]";
  const std::string inner(indent + 2, ' ');
  std::string out = "[\n";
  if (!has_comments(v) && std::all_of(v.elements.begin(), v.elements.end(), is_number)) {
    std::string row;
    for (const Written& e : v.elements) {
      if (!row.empty() && inner.size() + row.size() + e.text.size() + 2 > kWidth)
        out += inner + row + "\n", row.clear();
      row += (row.empty() ? "" : " ") + e.text + ",";
    }
    return out + inner + row + "\n" + std::string(indent, ' ') + "]";
  }
  std::vector<Commented> lines;
  for (const Written& e : v.elements) {
    for (const std::string& c : e.above) lines.push_back({c, ""});
    lines.push_back({text_of(e, indent + 2, indent + 2, true) + ",", e.comment, e.column});
  }
  for (const std::string& c : v.below) lines.push_back({c, ""});
  print(out, lines, inner);
  return out + std::string(indent, ' ') + "]";
}

// Prints entries on consecutive lines.
void print_block(std::string& out, const std::vector<const Line*>& block) {
  std::size_t column = 0;
  for (const Line* l : block) column = std::max(column, utf8_length(l->key));
  std::vector<Commented> lines;
  for (const Line* l : block)
    lines.push_back({l->key + std::string(column - utf8_length(l->key), ' ') + " = " +
                         text_of(l->value, 0, utf8_length(l->key) + 3),
                     l->comment, l->column});
  print(out, lines, "");
}

std::string layout(const std::vector<Line>& lines) {
  std::string out;
  std::vector<const Line*> block;
  bool blank = false, after_header = true;
  const auto flush = [&] {
    if (!block.empty()) print_block(out, block);
    block.clear();
  };
  const auto separate = [&](bool header) {
    if (!out.empty() && (header || (blank && !after_header))) out += '\n';
    blank = after_header = false;
  };
  for (std::size_t i = 0; i < lines.size(); ++i) {
    const Line& l = lines[i];
    switch (l.kind) {
    case Line::Kind::blank:
      flush();
      blank = true;
      break;
    case Line::Kind::comment: {
      flush();
      // Comments directly above a header belong to the header.
      std::size_t next = i;
      while (next < lines.size() && lines[next].kind == Line::Kind::comment) ++next;
      const bool first = i == 0 || lines[i - 1].kind != Line::Kind::comment;
      separate(first && next < lines.size() && lines[next].kind == Line::Kind::header);
      out += l.text + '\n';
      break;
    }
    case Line::Kind::header:
      flush();
      separate(i == 0 || lines[i - 1].kind != Line::Kind::comment);
      print(out, {{l.text, l.comment, l.column}}, "");
      after_header = true;
      break;
    case Line::Kind::entry: {
      if (blank || after_header) separate(false);
      const bool tall = text_of(l.value, 0, utf8_length(l.key) + 3).find('\n') != std::string::npos;
      if (tall) flush();
      block.push_back(&l);
      if (tall) flush();
      break;
    }
    }
  }
  flush();
  return out;
}

}  // namespace

bool same_content(const Item& a, const Item& b) {
  if (a.kind != b.kind || a.key != b.key || a.truth != b.truth || a.text() != b.text() ||
      a.items.size() != b.items.size())
    return false;
  return std::equal(a.items.begin(), a.items.end(), b.items.begin(), same_content);
}

std::string formatted(const SourceText& source) {
  const Item before = read_toml(source);
  Text text(source.text);
  SourceText result{source.name, layout(text.lines())};
  const Item after = read_toml(result);
  Text again(result.text);
  again.lines();
  if (!same_content(before, after) || text.comments != again.comments)
    throw Failure(Span{}, "the layout of this file cannot be set without changing what it says",
                  "please report it with the file");
  return result.text;
}

}  // namespace anholon
