#include <algorithm>
#include <cstdio>

#include <unistd.h>

#include "base/json.h"
#include "cli/contacts.h"
#include "cli/input.h"
#include "cli/say.h"
#include "published/findings/finding.h"
#include "published/subject.h"

namespace anholon::cli {

namespace {

constexpr std::size_t kListed = 5;   // number of changes that are shown
constexpr std::size_t kShown = 400;  // characters of a difference

std::string shortened(std::string text) {
  if (text.size() > kShown) text = text.substr(0, kShown) + " …";
  return text;
}

void print_text(const EquationFinding& f, std::size_t width, const SourceText& source) {
  const std::string indent(width + 10, ' ');
  say(stdout, "%-*s  %-7s %s\n", static_cast<int>(width), f.label.c_str(), truth(f.verdict),
      f.verdict == Verdict::proved    ? f.what.c_str()
      : f.verdict == Verdict::unknown ? f.detail.c_str()
      : f.in_places                   ? "it does not hold at all points of the motion"
      : f.what.empty()                ? "no derived equation is near it"
                                      : ("nearest: " + f.what).c_str());
  if (f.verdict == Verdict::unknown && !f.with_numbers.empty())
    say(stdout, "%sholds with the file's numbers %s; no proof for all values was found\n", indent.c_str(),
        f.with_numbers.c_str());
  if (f.verdict != Verdict::refuted) return;
  if (f.in_places) {
    say(stdout, "%sleft - right = %s at %s\n", indent.c_str(), f.detail.c_str(), f.point.value_or("").c_str());
    return;
  }
  if (f.difference)
    say(stdout, "%sleft - right %s %s\n", indent.c_str(), f.identity ? "is" : "differs from it by",
        shortened(*f.difference).c_str());
  say(stdout, "%sleft - right = %s at a point of the motion\n", indent.c_str(), f.detail.c_str());
  const auto show = [&](const FoundChange& k) {
    say(stdout, "%s%s:%s%s\n", indent.c_str(), source.name.c_str(), k.text().c_str(), k.proved ? "" : " (not proved)");
  };
  if (f.changes.size() == 1) show(f.changes[0]);
  if (f.changes.size() > 1) {
    say(stdout, "%s%zu changes would each make it true:\n", indent.c_str(), f.changes.size());
    for (std::size_t i = 0; i < f.changes.size() && i < kListed; ++i) show(f.changes[i]);
    if (f.changes.size() > kListed) say(stdout, "%s…\n", indent.c_str());
  }
  if (!f.with_numbers.empty())
    say(stdout, "%sholds with the file's numbers %s, not for all values\n", indent.c_str(), f.with_numbers.c_str());
  else if (f.changes.empty())
    say(stdout, "%sno change of one term and no lost dots of up to four symbols make it true\n", indent.c_str());
}

void write_json(JsonWriter& j, const EquationFinding& f) {
  const auto optional = [&](const char* key, const std::optional<std::string>& text) {
    j.key(key);
    if (text)
      j.string(*text);
    else
      j.null();
  };
  j.open_object().key("label").string(f.label).key("text").string(f.text);
  j.key("verdict").string(truth(f.verdict)).key("what").string(f.what);
  optional("difference", f.difference);
  const auto place_keys = [&](const FoundPlace& p) {
    j.open_object().key("from").string(p.from).key("to").string(p.to);
    j.key("line").integer(p.span.line).key("column").integer(p.span.column).key("place").string(p.place);
  };
  const auto change = [&](const FoundChange& k) {
    place_keys(k);
    j.key("proved").boolean(k.proved).key("reads").string(k.reads).key("places").open_array();
    for (const FoundPlace& p : k.places) {
      place_keys(p);
      j.close();
    }
    j.close().close();
  };
  j.key("change");
  if (f.changes.size() == 1)
    change(f.changes[0]);
  else
    j.null();
  j.key("changes").open_array();
  for (const FoundChange& k : f.changes) change(k);
  j.close();
  j.key("detail").string(f.detail);
  if (!f.with_numbers.empty()) j.key("with_numbers").string(f.with_numbers);
  optional("point", f.point);
  j.close();
}

// Reads the equations from a file, a shipped file, or the standard input ("-").
SourceText equations_named(const std::string& name) {
  if (name != "-") return equation_text(name);
  SourceText source{"<standard input>", {}};
  std::string why;
  if (!read_file("/dev/stdin", source.text, &why))
    throw UsageError{"error: cannot read the standard input: " + why + "\n"};
  return source;
}

}  // namespace

int compare(const CompareCommand& o) {
  if (o.equations.empty())
    throw UsageError{
        "error: no equations are named\nhint: anholon compare MODEL EQUATIONS, a file with one equation per line\n"};
  const Reader in = in_mode(read(o), o, "compare");
  const Model& model = *in.model;
  const SourceText source = equations_named(o.equations);
  Subject subject({in.model, in.names}, state_choice(o, model));
  Diagnostics diagnostics;
  const std::vector<PublishedEquation> equations = subject.read(source, diagnostics);
  if (diagnostics.has_errors()) throw UsageError{diagnostics.print(source)};
  const SymbolNames& names = subject.names();
  const bool terminal = isatty(STDERR_FILENO) != 0 && !o.quiet;
  std::vector<EquationFinding> found;
  for (const PublishedEquation& p : equations) {
    if (terminal) say(stderr, "\r\033[K%zu of %zu: %s", found.size() + 1, equations.size(), p.label.c_str());
    found.push_back(finding_of(p, subject.compare(p), names));
  }
  if (terminal) say(stderr, "\r\033[K");
  std::size_t width = 0, counts[3] = {0, 0, 0};
  for (std::size_t i = 0; i < found.size(); ++i) {
    width = std::max(width, found[i].label.size());
    ++counts[static_cast<std::size_t>(found[i].verdict)];
  }
  if (o.json) {
    JsonWriter j;
    j.open_object().key("model").string(model.title).key("equations").open_array();
    for (std::size_t i = 0; i < found.size(); ++i) {
      j.new_line();
      write_json(j, found[i]);
    }
    j.close().close();
    hand_out(j.text() + "\n");
  } else {
    if (!model.title.empty()) say(stdout, "%s\n\n", model.title.c_str());
    for (std::size_t i = 0; i < found.size(); ++i) print_text(found[i], width, source);
    say(stdout, "\n%zu true, %zu false, %zu unknown\n", counts[static_cast<std::size_t>(Verdict::proved)],
        counts[static_cast<std::size_t>(Verdict::refuted)], counts[static_cast<std::size_t>(Verdict::unknown)]);
  }
  return counts[static_cast<std::size_t>(Verdict::proved)] == found.size() ? kOk : kStopped;
}

}  // namespace anholon::cli
