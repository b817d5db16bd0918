// The papers on which the program is based: their claims, listed, shown and decided.
#include <algorithm>
#include <cstdio>
#include <filesystem>

#include <unistd.h>

#include "base/json.h"
#include "base/platform/installed.h"
#include "base/read_file.h"
#include "base/utf8.h"
#include "cli/input.h"
#include "cli/say.h"
#include "published/decide.h"

namespace anholon::cli {

namespace {

namespace fs = std::filesystem;

fs::path papers_folder() {
  const std::vector<fs::path> folders = data_folders("papers", ANHOLON_PAPERS_DIR);
  std::error_code ignored;
  const auto there =
      std::find_if(folders.begin(), folders.end(), [&](const fs::path& f) { return fs::is_directory(f, ignored); });
  return there == folders.end() ? folders.back() : *there;
}

std::vector<Paper> read_papers() {
  std::vector<Paper> papers;
  std::vector<fs::path> files;
  std::error_code error;
  for (const fs::directory_entry& e : fs::directory_iterator(papers_folder(), error))
    if (e.path().extension() == ".toml") files.push_back(e.path());
  if (files.empty())
    throw UsageError{"error: there are no tables of papers in " + papers_folder().string() +
                     "\nhint: they are installed beside the models\n"};
  std::sort(files.begin(), files.end());
  for (const fs::path& file : files) {
    SourceText source{file.filename().string(), {}};
    std::string why;
    if (!read_file(file.string(), source.text, &why))
      throw UsageError{"error: cannot read " + file.string() + ": " + why + "\n"};
    Diagnostics diagnostics;
    std::optional<Paper> paper = read_paper(source, diagnostics);
    if (!paper) throw UsageError{diagnostics.print(source)};
    papers.push_back(std::move(*paper));
  }
  return papers;
}

// Opens a model: "papers/systems/order-3.toml" is beside the tables, "papers/luo-zhao-example-1" is a shipped model.
OpenModel load(const std::string& name) {
  std::string path;
  if (name.ends_with(".toml"))
    path = (papers_folder().parent_path() / name).string();
  else
    for (const ShippedFile& m : shipped(Shipped::models))
      if (m.path.ends_with("/" + name + ".toml")) path = m.path;
  SourceText source{name, {}, path};
  std::string why = "there is no shipped model of this name";
  if (path.empty() || !read_file(path, source.text, &why))
    throw Failure({}, "cannot read the model '" + name + "': " + why);
  Diagnostics diagnostics;
  std::optional<OpenModel> model = open_model(source, diagnostics);
  if (!model) throw Failure({}, "the model '" + name + "' has errors: " + diagnostics.print(source));
  return *model;
}

const char* word(Verdict v) { return v == Verdict::proved ? "true" : v == Verdict::refuted ? "false" : "unknown"; }

std::string verdict(const Claim& c) { return c.holds() ? "true" : "false, corrected"; }

std::string tag_of(const Paper& p, const Claim& c) { return p.key + (c.numbered ? "" : " ") + c.tag; }

std::string padded(const std::string& text, std::size_t width) {
  const std::size_t length = utf8_length(text);
  return length < width ? text + std::string(width - length, ' ') : text;
}

// The question of a check, in one line.
std::string question(const ClaimCheck& c) {
  switch (c.kind) {
  case ClaimCheck::Kind::equation:
    return c.equation;
  case ClaimCheck::Kind::forms: {
    std::string list;
    for (const std::string& f : c.forms) list += (list.empty() ? "" : ", ") + f;
    return "forms: " + list;
  }
  case ClaimCheck::Kind::points:
    break;
  }
  return std::to_string(c.points.size()) + " points of one state";
}

void list(const std::vector<Paper>& papers) {
  for (const Paper& p : papers) {
    say(stdout, "%s  %s\n", p.key.c_str(), p.english.c_str());
    std::string authors;
    for (const std::string& a : p.authors) authors += (authors.empty() ? "" : "; ") + a;
    if (!authors.empty()) say(stdout, "   %s\n", authors.c_str());
    say(stdout, "   %s\n\n", p.title.c_str());
    for (const Claim& c : p.claims)
      say(stdout, "  %s  %s  %s  %s\n", padded(tag_of(p, c), 14).c_str(), padded(c.kind, 18).c_str(),
          padded(verdict(c), 16).c_str(), c.title.c_str());
    say(stdout, "\n");
  }
  say(stdout, "anholon papers L3.13 shows a claim and decides it; anholon papers --check decides all.\n");
}

void show(const Paper& p, const Claim& c) {
  say(stdout, "%s  %s (%s)\n  of %s\n\n  %s\n", tag_of(p, c).c_str(), c.title.c_str(), c.kind.c_str(),
      p.english.c_str(), c.formula.c_str());
  const auto line = [](const char* what, const std::string& text) {
    if (!text.empty()) say(stdout, "  %s %s\n", padded(std::string(what) + ":", 13).c_str(), text.c_str());
  };
  say(stdout, "\n");
  line("holds if", c.hypotheses);
  if (!c.difference.empty()) line("as read", c.difference + " (" + in_words(c.by) + ")");
  line("corrected", c.corrected);
  if (!c.form.empty()) line("form", c.form + " (anholon derive MODEL --form " + c.form + ")");
  line("quantity", c.quantity);
  line("derived in", c.theory.empty() ? c.theory : "doc/theory/" + c.theory);
  say(stdout, "\n");
}

void print_decision(const Decision& d) {
  const ClaimCheck& c = *d.check;
  say(stdout, "  %s %s%s\n", padded(word(d.verdict), 8).c_str(), c.says.empty() ? "" : (c.says + ": ").c_str(),
      question(c).c_str());
  for (const std::string& l : c.lets) say(stdout, "           where %s\n", l.c_str());
  say(stdout, "           on %s, %.2f s: %s\n", c.model.c_str(), d.seconds, d.detail.c_str());
  if (d.has_mutant && c.kind == ClaimCheck::Kind::equation)
    say(stdout, "           its mutant is %s: %s\n", word(d.mutant), c.mutant.c_str());
  else if (d.has_mutant)
    say(stdout, "           its mutant is %s\n", word(d.mutant));
  if (!d.as_expected())
    say(stdout, "           NOT as the table says: %s%s\n", c.expected ? "true" : "false",
        d.has_mutant ? ", its mutant false" : "");
}

void write_json(JsonWriter& j, const Paper& p, const Claim& c, const std::vector<Decision>& decisions) {
  j.open_object()
      .key("paper")
      .string(p.key)
      .key("tag")
      .string(c.tag)
      .key("numbered")
      .boolean(c.numbered)
      .key("title")
      .string(c.title)
      .key("kind")
      .string(c.kind);
  j.key("formula")
      .string(c.formula)
      .key("hypotheses")
      .string(c.hypotheses)
      .key("difference")
      .string(c.difference)
      .key("class")
      .string(in_words(c.by));
  j.key("corrected")
      .string(c.corrected)
      .key("form")
      .string(c.form)
      .key("quantity")
      .string(c.quantity)
      .key("theory")
      .string(c.theory)
      .key("verdict")
      .string(verdict(c));
  j.key("checks").open_array();
  for (std::size_t i = 0; i < c.checks.size(); ++i) {
    const ClaimCheck& k = c.checks[i];
    j.open_object()
        .key("model")
        .string(k.model)
        .key("says")
        .string(k.says)
        .key("asks")
        .string(question(k))
        .key("mutant")
        .string(k.mutant)
        .key("is")
        .boolean(k.expected);
    j.key("let").open_array();
    for (const std::string& l : k.lets) j.string(l);
    j.close();
    if (!decisions.empty()) {
      const Decision& d = decisions[i];
      j.key("decided")
          .string(word(d.verdict))
          .key("mutant_decided")
          .string(d.has_mutant ? word(d.mutant) : "")
          .key("detail")
          .string(d.detail);
      j.key("as_expected").boolean(d.as_expected());
    }
    j.close();
  }
  j.close().close();
}

// Makes a text a cell of a Markdown table: without line ends, with escaped bars.
std::string cell(const std::string& text) {
  std::string out;
  for (const char c : text) out += c == '\n' ? ' ' : c;
  for (std::size_t at = 0; (at = out.find('|', at)) != std::string::npos; at += 2) out.replace(at, 1, "\\|");
  return out;
}

void print_markdown(const std::vector<Paper>& papers) {
  std::string out;
  for (const Paper& p : papers) {
    out += "### [" + p.key + "] " + p.english +
           "\n\n| tag | statement | formula | verdict | difference of the print as read |\n|---|---|---|---|---|\n";
    for (const Claim& c : p.claims) {
      const std::string by = c.by == DifferenceBy::none ? "" : cell(c.difference) + " (" + in_words(c.by) + ")";
      out += "| " + c.tag + " | " + cell(c.title) + (c.form.empty() ? "" : ", form `" + c.form + "`") + " | `" +
             cell(c.formula) + "` | " + verdict(c) + (c.corrected.empty() ? "" : ": " + cell(c.corrected)) + " | " +
             by + " |\n";
    }
    out += "\n";
  }
  hand_out(out);
}

// Returns the claims that the options name; the list is empty if the papers are only to be listed.
std::vector<FoundClaim> wanted_claims(const PapersCommand& o, const std::vector<Paper>& papers) {
  std::vector<FoundClaim> wanted;
  if (o.tag.empty()) {
    if (o.check || o.json)
      for (const Paper& p : papers)
        for (const Claim& c : p.claims) wanted.push_back({&p, &c});
    return wanted;
  }
  wanted = find_claims(papers, o.tag);
  if (!wanted.empty()) return wanted;
  const std::string near = nearest_tag(papers, o.tag);
  throw UsageError{"error: no paper has '" + o.tag + "'" + (near.empty() ? "" : "; did you mean '" + near + "'?") +
                   "\nhint: anholon papers lists the tags; L3.13, Q13, N3.16\n"};
}

struct Counts {
  std::size_t numbered = 0, numbered_right = 0, others = 0, others_right = 0, checks = 0, mutants = 0;

  void add(const Claim& claim, const std::vector<Decision>& decisions, bool right) {
    ++(claim.numbered ? numbered : others);
    (claim.numbered ? numbered_right : others_right) += right;
    checks += decisions.size();
    mutants += static_cast<std::size_t>(std::count_if(decisions.begin(), decisions.end(), [](const Decision& d) {
      return d.has_mutant && d.mutant == Verdict::refuted;
    }));
  }
  bool all_right() const { return numbered == numbered_right && others == others_right; }
};

// Prints the claims one by one, on the terminal or as JSON.
class Listing {
 public:
  Listing(const PapersCommand& o, const std::vector<Paper>& papers, std::size_t claims)
      : o_(o), claims_(claims), terminal_(isatty(STDERR_FILENO) != 0 && !o.quiet) {
    if (!o.json) return;
    j_.open_object().key("papers").open_array();
    for (const Paper& p : papers)
      j_.open_object()
          .key("key")
          .string(p.key)
          .key("title")
          .string(p.title)
          .key("english")
          .string(p.english)
          .key("reference")
          .string(p.reference)
          .close();
    j_.close().key("claims").open_array();
  }

  void begin(const FoundClaim& f, std::size_t number) const {
    if (terminal_ && claims_ > 1)
      say(stderr, "\r\033[K%zu of %zu: %s", number, claims_, tag_of(*f.paper, *f.claim).c_str());
  }

  void add(const FoundClaim& f, const std::vector<Decision>& decisions, bool right) {
    if (o_.json) {
      j_.new_line();
      write_json(j_, *f.paper, *f.claim, decisions);
      return;
    }
    if (o_.check && right) return;
    clear_line();
    if (o_.check)
      say(stdout, "%s\n", tag_of(*f.paper, *f.claim).c_str());
    else
      show(*f.paper, *f.claim);
    for (const Decision& d : decisions)
      if (!o_.check || !d.as_expected()) print_decision(d);
  }

  void end(const Counts& n, bool decides) {
    clear_line();
    if (o_.json) {
      j_.close().key("decided").boolean(decides);
      count("numbered", n.numbered);
      count("unnumbered", n.others);
      if (decides) {
        count("numbered_as_expected", n.numbered_right);
        count("unnumbered_as_expected", n.others_right);
      }
      hand_out(j_.close().text() + "\n");
    } else if (o_.check) {
      say(stdout,
          "%zu of %zu numbered equations and %zu of %zu other formulas are decided as the tables say; %zu checks, %zu "
          "mutants refuted\n",
          n.numbered_right, n.numbered, n.others_right, n.others, n.checks, n.mutants);
    }
  }

 private:
  void clear_line() const {
    if (terminal_) say(stderr, "\r\033[K");
  }
  void count(const char* key, std::size_t n) { j_.key(key).integer(static_cast<long>(n)); }

  const PapersCommand& o_;
  std::size_t claims_;
  bool terminal_;
  JsonWriter j_;
};

}  // namespace

int papers(const PapersCommand& o) {
  const std::vector<Paper> papers = read_papers();
  if (o.markdown) return print_markdown(papers), kOk;
  const std::vector<FoundClaim> wanted = wanted_claims(o, papers);
  if (wanted.empty()) return list(papers), kOk;
  const bool decides = o.check || !o.tag.empty();
  Decider decider(load);
  Counts n;
  Listing listing(o, papers, wanted.size());
  for (const FoundClaim& f : wanted) {
    listing.begin(f, static_cast<std::size_t>(&f - wanted.data()) + 1);
    std::vector<Decision> decisions;
    if (decides)
      for (const ClaimCheck& c : f.claim->checks) decisions.push_back(decider.decide(c));
    const bool right =
        std::all_of(decisions.begin(), decisions.end(), [](const Decision& d) { return d.as_expected(); });
    n.add(*f.claim, decisions, right);
    listing.add(f, decisions, right);
  }
  listing.end(n, decides);
  return !decides || n.all_right() ? kOk : kStopped;
}

}  // namespace anholon::cli
