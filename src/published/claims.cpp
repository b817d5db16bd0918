#include "published/claims.h"

#include <algorithm>
#include <cctype>
#include <set>

#include "base/utf8.h"
#include "modelfile/text/toml.h"

namespace anholon {

namespace {

const char* const kKinds[] = {"definition", "identity", "constraint", "equation of motion", "equivalence", "claim"};

// Prefixes of a tag for each paper, in small letters, without signs between them.
struct Spelling {
  const char* key;
  std::vector<std::string> names;
};
const std::vector<Spelling>& spellings() {
  static const std::vector<Spelling> list = {
      {"L", {"l", "luo", "luozhao", "luoandzhao", "zhao", "routh"}},
      {"Q", {"q", "qiu", "macmillan"}},
      {"N", {"n", "mr", "micevic", "micevicrusov", "micevicandrusov", "misevic", "misevicrusov", "rusov"}},
  };
  return list;
}

class TableReader {
 public:
  TableReader(const SourceText& source, Diagnostics& diagnostics) : source_(source), diagnostics_(diagnostics) {}

  std::optional<Paper> run() {
    Paper paper;
    paper.source = source_;
    guard([&] {
      const Item root = read_toml(source_);
      known(root, {"key", "title", "english", "authors", "reference", "claim"});
      paper.key = text(root, "key");
      paper.title = text(root, "title");
      paper.english = text(root, "english");
      paper.reference = text(root, "reference");
      paper.authors = texts(root, "authors");
      const Item* claims = root.find("claim");
      if (!claims || claims->kind != Item::Kind::array) throw Failure({}, "the table has no [[claim]]");
      for (const Item& i : claims->items) guard([&] { paper.claims.push_back(claim(i)); });
    });
    std::set<std::string> tags;
    for (const Claim& c : paper.claims)
      if (!tags.insert(c.tag).second) diagnostics_.error(c.span, "the tag '" + c.tag + "' is used twice");
    if (diagnostics_.has_errors()) return std::nullopt;
    return paper;
  }

 private:
  template <class F>
  void guard(F f) {
    try {
      f();
    } catch (const Failure& e) {
      diagnostics_.add(e.diagnostic);
    }
  }

  static void known(const Item& table, const std::vector<std::string>& keys) {
    for (const Item& i : table.items)
      if (std::find(keys.begin(), keys.end(), i.key) == keys.end()) {
        const std::string near = did_you_mean(i.key, keys);
        throw Failure(i.key_span,
                      "unknown key '" + i.key + "'" + (near.empty() ? "" : "; did you mean '" + near + "'?"));
      }
  }
  static std::string text(const Item& table, const char* key, bool needed = true) {
    const Item* i = table.find(key);
    if (!i && needed) throw Failure(table.key_span, std::string("'") + key + "' is missing");
    if (i && i->kind != Item::Kind::string) throw Failure(i->span, std::string("'") + key + "' is a text");
    return i ? i->text() : std::string();
  }
  static std::vector<std::string> texts(const Item& table, const char* key) {
    std::vector<std::string> list;
    const Item* i = table.find(key);
    if (!i) return list;
    if (i->kind != Item::Kind::array) throw Failure(i->span, std::string("'") + key + "' is a list of texts");
    for (const Item& t : i->items) {
      if (t.kind != Item::Kind::string) throw Failure(t.span, std::string("'") + key + "' is a list of texts");
      list.push_back(t.text());
    }
    return list;
  }

  Claim claim(const Item& i) {
    known(i, {"tag", "unnumbered", "title", "kind", "formula", "hypotheses", "difference", "class", "form", "quantity",
              "theory", "corrected", "check"});
    Claim c;
    c.span = i.span;
    c.tag = text(i, "tag");
    const Item* unnumbered = i.find("unnumbered");
    c.numbered = !(unnumbered && unnumbered->kind == Item::Kind::boolean && unnumbered->truth);
    c.title = text(i, "title");
    c.kind = text(i, "kind");
    if (std::none_of(std::begin(kKinds), std::end(kKinds), [&](const char* k) { return c.kind == k; }))
      throw Failure(i.find("kind")->span, "unknown kind '" + c.kind + "'");
    c.formula = text(i, "formula");
    c.hypotheses = text(i, "hypotheses", false);
    c.difference = text(i, "difference", false);
    c.corrected = text(i, "corrected", false);
    c.form = text(i, "form", false);
    c.quantity = text(i, "quantity", false);
    c.theory = text(i, "theory", false);
    const std::string by = text(i, "class", false);
    if (by == "reading")
      c.by = DifferenceBy::reading;
    else if (by == "text")
      c.by = DifferenceBy::text;
    else if (by == "undecidable")
      c.by = DifferenceBy::undecidable;
    else if (!by.empty())
      throw Failure(i.find("class")->span, "unknown class '" + by + "'", "reading, text or undecidable");
    if (c.difference.empty() != by.empty()) throw Failure(i.span, "'difference' and 'class' stand together");
    if (const Item* checks = i.find("check")) {
      if (checks->kind != Item::Kind::array) throw Failure(checks->span, "[[claim.check]] is a list");
      for (const Item& k : checks->items) c.checks.push_back(check(k));
    }
    if (c.checks.empty()) throw Failure(c.span, "nothing decides the claim '" + c.tag + "'", "add a [[claim.check]]");
    return c;
  }

  ClaimCheck check(const Item& i) {
    known(i, {"model", "is", "says", "let", "equation", "mutant", "forms", "points"});
    ClaimCheck c;
    c.span = i.span;
    c.model = text(i, "model");
    const std::string is = text(i, "is");
    if (is != "true" && is != "false") throw Failure(i.find("is")->span, "'is' is \"true\" or \"false\"");
    c.expected = is == "true";
    c.says = text(i, "says", false);
    c.lets = texts(i, "let");
    c.equation = text(i, "equation", false);
    c.mutant = text(i, "mutant", false);
    c.forms = texts(i, "forms");
    if (const Item* points = i.find("points")) {
      if (points->kind != Item::Kind::array) throw Failure(points->span, "'points' is a list of tables");
      for (const Item& p : points->items) {
        c.points.emplace_back();
        for (const Item& v : p.items) c.points.back().push_back({v.key, v.text()});
      }
    }
    c.kind = !c.forms.empty()    ? ClaimCheck::Kind::forms
             : !c.points.empty() ? ClaimCheck::Kind::points
                                 : ClaimCheck::Kind::equation;
    if (!c.equation.empty() + !c.forms.empty() + !c.points.empty() != 1)
      throw Failure(c.span, "a check has one of 'equation', 'forms' and 'points'");
    if (c.kind == ClaimCheck::Kind::equation && c.expected && c.mutant.empty())
      throw Failure(c.span, "'mutant' is missing: a change of the equation that must be false");
    if (c.kind == ClaimCheck::Kind::points && c.points.size() < 2)
      throw Failure(c.span, "at least two points are compared");
    return c;
  }

  const SourceText& source_;
  Diagnostics& diagnostics_;
};

// Keeps only small letters and digits, dots and primes.
std::string plain(const std::string& spelling) {
  std::string out;
  for (std::size_t i = 0; i < spelling.size();) {
    const std::string letter = spelling.substr(i, utf8_width(spelling, i));
    i += letter.size();
    if (letter == "′" || letter == "’")
      out += '\'';
    else if (letter == "ć" || letter == "č")
      out += 'c';
    else if (letter == "š")
      out += 's';
    else if (letter.size() > 1)
      out += normal_name(letter) == letter ? letter : plain(normal_name(letter));
    else if (std::isalnum(static_cast<unsigned char>(letter[0])) || letter == "." || letter == "'" || letter == "-" ||
             letter == "_")
      out += static_cast<char>(std::tolower(static_cast<unsigned char>(letter[0])));
  }
  return out;
}

std::string letters_only(std::string s) {
  std::erase_if(s, [](char c) { return c == '-' || c == '_' || c == '.' || c == '\''; });
  return s;
}

}  // namespace

const char* in_words(DifferenceBy d) {
  switch (d) {
  case DifferenceBy::reading:
    return "a loss of the machine reading";
  case DifferenceBy::text:
    return "an error of the text";
  case DifferenceBy::undecidable:
    return "undecidable without the scan";
  case DifferenceBy::none:
    break;
  }
  return "";
}

std::optional<Paper> read_paper(const SourceText& source, Diagnostics& diagnostics) {
  return TableReader(source, diagnostics).run();
}

std::vector<FoundClaim> find_claims(const std::vector<Paper>& papers, const std::string& spelling) {
  const std::string wanted = plain(spelling);
  std::vector<FoundClaim> found;
  if (wanted.empty()) return found;
  const auto look = [&](const Paper& p, const std::string& tag) {
    for (const Claim& c : p.claims)
      if (plain(c.tag) == tag) found.push_back({&p, &c});
  };
  // The name of a paper, then a tag of that paper.
  for (std::size_t n = wanted.size() - 1; n > 0 && found.empty(); --n) {
    const std::string name = letters_only(wanted.substr(0, n));
    std::string tag = wanted.substr(n);
    while (!tag.empty() && (tag[0] == '-' || tag[0] == '.' || tag[0] == '_')) tag.erase(0, 1);
    if (name.empty() || tag.empty()) continue;
    for (const Paper& p : papers) {
      std::vector<std::string> names = {letters_only(plain(p.key))};
      for (const Spelling& s : spellings())
        if (s.key == p.key) names.insert(names.end(), s.names.begin(), s.names.end());
      if (std::find(names.begin(), names.end(), name) != names.end()) look(p, tag);
    }
  }
  if (found.empty())
    for (const Paper& p : papers) look(p, wanted);
  if (found.empty())
    for (const Paper& p : papers)
      for (const Claim& c : p.claims)
        if (wanted.size() > 3 && plain(c.title).find(wanted) != std::string::npos) found.push_back({&p, &c});
  return found;
}

std::string nearest_tag(const std::vector<Paper>& papers, const std::string& spelling) {
  std::vector<std::string> known;
  for (const Paper& p : papers)
    for (const Claim& c : p.claims) known.push_back(p.key + c.tag), known.push_back(c.tag);
  return did_you_mean(spelling, known);
}

}  // namespace anholon
