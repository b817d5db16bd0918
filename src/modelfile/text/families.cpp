#include "modelfile/text/families.h"

#include <algorithm>

#include "base/utf8.h"
#include "formula/indices.h"
#include "modelfile/language/language.h"
#include "modelfile/text/collect.h"

namespace anholon {

namespace {

constexpr std::size_t kMostIndices = 100;
// The limits of members of one range, of entries of all families of a file, and of terms of all sums and products.
constexpr std::size_t kLongestRange = 100'000, kMostEntries = 200'000, kMostTerms = 2'000'000;

// ---- [index] ---------------------------------------------------------------------------------

class IndexReader {
 public:
  IndexReader(const std::map<std::string, std::string>& overrides, Families& out) : overrides_(overrides), out_(out) {}

  std::shared_ptr<const Indices> read(const Item& section, Diagnostics& diagnostics) {
    indices_ = std::make_shared<Indices>();
    indices_->room = std::make_shared<std::size_t>(kMostTerms);
    if (section.items.size() > kMostIndices)
      throw Failure(section.key_span, "more than " + std::to_string(kMostIndices) + " indices");
    for (const Item& i : section.items)
      collect(diagnostics, [&] {
        if (!is_identifier(i.key))
          throw Failure(i.key_span, "'" + i.key.substr(0, 40) + "' is not a name",
                        "letters (a-z, A-Z, Greek), digits and _, not starting with a digit");
        if (is_reserved(i.key)) throw Failure(i.key_span, "the name '" + i.key + "' is reserved");
        entries_.emplace(i.key, &i);
        out_.letters.insert(i.key);
      });
    for (const Item& i : section.items)
      if (entries_.count(i.key)) {
        open_.clear();
        collect(diagnostics, [&] { find(i.key); }, i.key_span);
      }
    return indices_;
  }

 private:
  // Reads the entry after the entries that it needs.
  void find(const std::string& name) {
    if (done_.count(name)) return;
    if (std::find(open_.begin(), open_.end(), name) != open_.end()) {
      std::string path;
      for (const std::string& n : open_) path += n + " -> ";
      throw Failure(entries_.at(name)->key_span, "the index '" + name + "' is defined through itself: " + path + name);
    }
    if (failed_.count(name)) throw silent_failure();
    open_.push_back(name);
    failed_.insert(name);  // until it succeeds
    entry(*entries_.at(name));
    failed_.erase(name);
    open_.pop_back();
    done_.insert(name);
  }

  void entry(const Item& i) {
    if (!i.is_formula()) throw Failure(i.span, "an index is a whole number or a range", "n = 10, i = \"1..n\"");
    const std::size_t dots = i.text().find("..");
    if (const auto o = overrides_.find(i.key); o != overrides_.end()) {
      out_.used.insert(i.key);
      const std::string option = "--set " + o->first + "=" + o->second;
      if (dots != std::string::npos)
        throw Failure(Span{}, option + ": '" + i.key + "' is a range; set the integers of its bounds");
      try {
        indices_->values[i.key] = integer(FormulaText(o->second, Span{}));
      } catch (const Failure& f) {
        if (is_silent(f.diagnostic)) throw;
        throw Failure(Span{}, option + ": " + f.diagnostic.message, f.diagnostic.hint);
      }
      return;
    }
    if (dots == std::string::npos) {
      indices_->values[i.key] = integer(i.formula);
      return;
    }
    const std::size_t after = utf8_length(i.text().substr(0, dots)) + 2;
    const long first = integer(FormulaText(i.text().substr(0, dots), i.formula.span(0, 1)));
    const long last = integer(FormulaText(i.text().substr(dots + 2), i.formula.span(after, 1)));
    const IndexRange range{first, last};
    if (range.size() > kLongestRange)
      throw Failure(i.formula.whole(), "a range of more than " + std::to_string(kLongestRange) + " values");
    indices_->ranges[i.key] = range;
  }

  long integer(const FormulaText& text) {
    const std::vector<Syntax> s = parse_plain(text);
    if (s.size() != 1) throw Failure(text.whole(), "a whole number is expected");
    needed(s[0]);
    return index_value(s[0], indices_.get());
  }

  void needed(const Syntax& s) {
    if (s.op == Syntax::Op::name && entries_.count(s.text)) find(s.text);
    for (const Syntax& a : s.args) needed(a);
  }

  const std::map<std::string, std::string>& overrides_;
  Families& out_;
  std::map<std::string, const Item*> entries_;
  std::shared_ptr<Indices> indices_;
  std::set<std::string> done_, failed_;
  std::vector<std::string> open_;
};

// ---- names with brackets ---------------------------------------------------------------------

// A text that contains names with brackets: "th[i]'", "D(th[i],3)", "trailer[i]".
class Bracketed {
 public:
  Bracketed(const std::string& text, Span span) : text_(text) {
    for (std::size_t open = text.find('['); open != std::string::npos; open = text.find('[', open + 1)) {
      const std::size_t close = text.find(']', open);
      if (close == std::string::npos) throw Failure(span, "'" + text.substr(0, 40) + "': this bracket is not closed");
      std::size_t from = open;
      while (from > 0 && (std::isalnum(static_cast<unsigned char>(text[from - 1])) || text[from - 1] == '_')) --from;
      Span at = span;
      at.column += static_cast<std::uint32_t>(utf8_length(text.substr(0, from)));
      at.length = 1;
      std::vector<Syntax> s = parse_plain(FormulaText(text.substr(from, close + 1 - from), at));
      if (s.size() != 1 || s[0].op != Syntax::Op::index)
        throw Failure(span, "'" + text.substr(0, 40) + "' is not a name");
      parts_.push_back({from, close + 1, std::move(s[0])});
      open = close;
    }
  }

  Letters letters(const Indices& indices) const {
    Letters all;
    for (const Part& p : parts_) free_letters(p.name, indices, all);
    return all;
  }

  std::string with(const Indices* indices) const {
    std::string out;
    std::size_t done = 0;
    for (const Part& p : parts_) {
      out += text_.substr(done, p.begin - done) + with_indices(p.name, indices).text;
      done = p.end;
    }
    return out + text_.substr(done);
  }

 private:
  struct Part {
    std::size_t begin, end;
    Syntax name;
  };
  const std::string& text_;
  std::vector<Part> parts_;
};

bool has_bracket(const std::string& text) { return text.find('[') != std::string::npos; }

// True if the whole text names one element: P[i-1].
bool is_reference(const std::string& text) {
  const std::size_t open = text.find('[');
  return open != std::string::npos && is_identifier(normal_name(text.substr(0, open))) &&
         text.find(']') + 1 == text.size();
}

Span inside_quotes(Span key, const std::string& text) {
  if (key.length == utf8_length(text) + 2) ++key.column, key.length -= 2;
  return key;
}

// ---- writing out -----------------------------------------------------------------------------

using Context = std::shared_ptr<const Indices>;

class Writer {
 public:
  Writer(Families& out, Diagnostics& diagnostics) : out_(out), diagnostics_(diagnostics) {}

  void table(Item& t, const Context& context) {
    // Explicit members take precedence, wherever they are.
    std::set<std::string> written;
    std::vector<std::optional<Bracketed>> names(t.items.size());
    for (std::size_t k = 0; k < t.items.size(); ++k) {
      const Item& i = t.items[k];
      if (has_bracket(i.key))
        collect(
            diagnostics_,
            [&] {
              names[k].emplace(i.key, inside_quotes(i.key_span, i.key));
              if (names[k]->letters(*context).empty()) written.insert(names[k]->with(context.get()));
            },
            i.key_span);
    }
    std::vector<Item> items;
    items.reserve(t.items.size());
    for (std::size_t k = 0; k < t.items.size(); ++k) {
      Item& i = t.items[k];
      if (!has_bracket(i.key)) {
        value(i, context);
        items.push_back(std::move(i));
      } else if (names[k]) {
        collect(
            diagnostics_,
            [&] {
              const bool list = i.kind == Item::Kind::array &&
                                (t.key != "point" || (!i.items.empty() && i.items[0].kind == Item::Kind::array));
              members(i, *names[k], context, written, list,
                      [&](Item member, const std::string& name, const Context& inner) {
                        member.key = name;
                        value(member, inner);
                        items.push_back(std::move(member));
                      });
            },
            i.key_span);
      }
    }
    t.items = std::move(items);
  }

 private:
  // Calls f(copy, name, context) for each member that is not explicit; for a name without letters, once.
  template <class F>
  void members(const Item& item, const Bracketed& name, const Context& context, const std::set<std::string>& written,
               bool list, F f) {
    const Letters letters = name.letters(*context);
    if (letters.empty()) return f(item, name.with(context.get()), context);
    std::size_t count = 1;
    for (const auto& [letter, range] : letters) count = std::min(kMostEntries + 1, count * range.size());
    if (list && item.items.size() != count)
      throw Failure(item.span,
                    std::to_string(item.items.size()) + (item.items.size() == 1 ? " value" : " values") + " for " +
                        std::to_string(count) + (count == 1 ? " member: " : " members: ") + ranges(letters),
                    "one value alone, without list, is that of all members");
    each(letters, 0, *std::make_shared<Indices>(), context, [&, k = std::size_t{0}](const Context& inner) mutable {
      const std::string own = name.with(inner.get());
      const std::size_t at = k++;
      if (written.count(own)) return;
      Item copy = list ? item.items[at] : item;
      spend(copy);
      copy.key_span = item.key_span;
      copy.member = own;
      ++out_.members;
      f(std::move(copy), own, inner);
    });
  }

  template <class F>
  void each(const Letters& letters, std::size_t at, const Indices& bound, const Context& context, F&& f) {
    if (at == letters.size()) {
      auto inner = std::make_shared<Indices>(bound);
      inner->outer = context;
      return f(inner);
    }
    Indices next = bound;
    for (long v = letters[at].second.first; v <= letters[at].second.last; ++v) {
      next.values[letters[at].first] = v;
      each(letters, at + 1, next, context, f);
    }
  }

  static std::string ranges(const Letters& letters) {
    std::string text;
    for (const auto& [name, range] : letters)
      text +=
          (text.empty() ? "" : ", ") + name + " = " + std::to_string(range.first) + ".." + std::to_string(range.last);
    return text;
  }

  void spend(const Item& item) {
    if (++entries_ > kMostEntries)
      throw Failure(item.span, "the families of this file have more than " + std::to_string(kMostEntries) + " entries");
    for (const Item& i : item.items) spend(i);
  }

  void value(Item& i, const Context& context) {
    switch (i.kind) {
    case Item::Kind::string:
    case Item::Kind::number:
      i.formula.set_indices(context);
      for (const char* key : {"name", "on", "from", "body", "along", "by"})
        if (i.key == key) reference(i, context);
      return;
    case Item::Kind::table:
      return table(i, context);
    case Item::Kind::array:
      break;
    case Item::Kind::boolean:
    case Item::Kind::other:
      return;
    }
    const bool tables =
        std::any_of(i.items.begin(), i.items.end(), [](const Item& e) { return e.kind == Item::Kind::table; });
    const bool names = i.key == "coordinates" || i.key == "dependent" || i.key == "by";
    if (tables || names) return list(i, context);
    if (i.key == "conditions") return conditions(i, context);
    for (Item& e : i.items) {
      e.formula.set_indices(context);
      value(e, context);
    }
  }

  // Replaces the text by the name, keeping the position.
  void reference(Item& i, const Context& context) {
    if (!is_reference(i.text())) return;
    collect(diagnostics_, [&] { rename(i, Bracketed(i.text(), i.formula.span(0, 1)).with(context.get())); }, i.span);
  }
  static void rename(Item& i, const std::string& name) {
    if (name == i.text()) return;
    Context indices = i.formula.indices();
    i.formula = FormulaText(name, i.formula.span(0, 1));
    i.formula.set_indices(std::move(indices));
  }

  // Returns the part of a list element that makes it a family: the entry itself, its name, or, for a force without
  // name, the object it acts on.
  static const Item* naming(const Item& element) {
    if (element.kind == Item::Kind::string) return &element;
    const Item* name = element.find("name");
    if (!name) name = element.find("on");
    if (name && name->kind == Item::Kind::table) name = name->find("body");
    return name && name->kind == Item::Kind::string ? name : nullptr;
  }

  void list(Item& l, const Context& context) {
    std::set<std::string> written;
    std::vector<std::optional<Bracketed>> names(l.items.size());
    for (std::size_t k = 0; k < l.items.size(); ++k)
      if (const Item* name = naming(l.items[k]); name && has_bracket(name->text()))
        collect(
            diagnostics_,
            [&] {
              names[k].emplace(name->text(), name->formula.span(0, 1));
              const bool named =
                  name == &l.items[k] || l.items[k].find("name") == name;  // several forces may act on one body
              if (named && names[k]->letters(*context).empty()) written.insert(names[k]->with(context.get()));
            },
            name->span);
    std::vector<Item> items;
    items.reserve(l.items.size());
    for (std::size_t k = 0; k < l.items.size(); ++k) {
      Item& i = l.items[k];
      if (!names[k]) {
        value(i, context);
        items.push_back(std::move(i));
        continue;
      }
      collect(
          diagnostics_,
          [&] {
            members(i, *names[k], context, written, false,
                    [&](Item member, const std::string& name, const Context& inner) {
                      if (member.kind == Item::Kind::string) rename(member, name);
                      value(member, inner);
                      items.push_back(std::move(member));
                    });
          },
          i.span);
    }
    l.items = std::move(items);
  }

  // Expands an equation with a free letter to one equation for each of its values.
  void conditions(Item& l, const Context& context) {
    std::vector<Item> items;
    for (Item& i : l.items) {
      if (i.kind != Item::Kind::string) {
        items.push_back(std::move(i));
        continue;
      }
      i.formula.set_indices(context);
      Letters letters;
      try {
        for (const Syntax& side : parse_plain(i.formula)) free_letters(side, *context, letters);
      } catch (const Failure&) {  // the reader of the element reports the error
      }
      collect(
          diagnostics_,
          [&] {
            each(letters, 0, Indices(), context, [&](const Context& inner) {
              Item copy = i;
              spend(copy);
              copy.formula.set_indices(letters.empty() ? context : inner);
              items.push_back(std::move(copy));
            });
          },
          i.span);
    }
    l.items = std::move(items);
  }

  Families& out_;
  Diagnostics& diagnostics_;
  std::size_t entries_ = 0;
};

}  // namespace

Families write_out_families(Item& root, const std::map<std::string, std::string>& overrides, Diagnostics& diagnostics) {
  Families out;
  auto context = std::make_shared<const Indices>();
  const auto section =
      std::find_if(root.items.begin(), root.items.end(), [](const Item& i) { return i.key == "index"; });
  if (section != root.items.end()) {
    if (section->kind != Item::Kind::table)
      diagnostics.error(section->span, "'index' is a section", "write [index]");
    else
      collect(diagnostics, [&] { context = IndexReader(overrides, out).read(*section, diagnostics); });
    root.items.erase(section);
  }
  // Stops after a wrong index, because everything that depends on it would be wrong as well.
  if (!diagnostics.has_errors()) Writer(out, diagnostics).table(root, context);
  return out;
}

}  // namespace anholon
