#include <algorithm>
#include <cstdio>

#include <unistd.h>

#include "base/json.h"
#include "cli/input.h"
#include "cli/say.h"
#include "published/subject.h"

namespace anholon::cli {

namespace {

constexpr std::size_t kListed = 5;   // number of changes that are shown
constexpr std::size_t kShown = 400;  // characters of a difference

SourceText read_equation_text(const Options& o) {
  SourceText source{o.equations, {}};
  std::string why;
  if (read_file(o.equations, source.text, &why)) return source;
  std::vector<std::string> names;
  for (const ShippedFile& e : shipped(Shipped::equations)) {
    names.push_back(e.name);
    if (e.name != o.equations && e.name + ".eq" != o.equations) continue;
    source.name = e.name + ".eq";
    if (read_file(e.path, source.text, &why)) return source;
  }
  const std::string near = did_you_mean(o.equations, names);
  throw UsageError{"error: cannot read the equations '" + o.equations + "': " + why + "\n" +
                   (near.empty() ? "hint: a file with one equation per line, LABEL: left = right\n"
                                 : "hint: did you mean the shipped equations '" + near + "'?\n")};
}

const char* word(Verdict v) { return v == Verdict::proved ? "true" : v == Verdict::refuted ? "false" : "unknown"; }

std::string ordinal(std::size_t k) {
  static const char* const words[] = {"first", "second",  "third",  "fourth", "fifth",
                                      "sixth", "seventh", "eighth", "ninth"};
  return k < std::size(words) ? words[k] : std::to_string(k + 1) + "th";
}

std::string place(const ChangedPlace& c) {
  return ordinal(c.term) + " term of the " + (c.side == 0 ? "left" : "right") + " side";
}

std::string position(const ChangedPlace& c) {
  return std::to_string(c.span.line) + ":" + std::to_string(c.span.column);
}

// One place: with its term; one symbol at several places: with the places; else one after the other.
std::string text(const Change& c) {
  const ChangedPlace& first = c.places[0];
  if (c.places.size() == 1) return position(first) + ": " + place(first) + ": " + first.from + " should be " + first.to;
  std::string out = position(first) + ": ";
  if (std::all_of(c.places.begin(), c.places.end(),
                  [&](const ChangedPlace& p) { return p.from == first.from && p.to == first.to; })) {
    out += first.from + " should be " + first.to + " at " + std::to_string(c.places.size()) + " places";
    for (std::size_t i = 1; i < c.places.size(); ++i) out += (i == 1 ? ": here, " : ", ") + position(c.places[i]);
    return out;
  }
  for (const ChangedPlace& p : c.places) {
    if (&p != &first) out += ", and " + position(p) + ": ";
    out += p.from + " should be " + p.to;
  }
  return out;
}

std::string point_text(const WitnessPoint& w, const SymbolNames& names) {
  std::string out;
  for (const auto& [symbol, value] : w.values)
    out += (out.empty() ? "" : ", ") + print(symbol, names, Format::text) + " = " + value.get_str();
  for (const WitnessPoint::Enclosed& e : w.enclosed)
    out += (out.empty() ? "" : ", ") + print(e.symbol, names, Format::text) + " = " +
           number_text(e.midpoint.get_d(), 6) + "…";
  return out;
}

std::string shortened(std::string text) {
  if (text.size() > kShown) text = text.substr(0, kShown) + " …";
  return text;
}

void print_text(const PublishedEquation& e, const Comparison& c, std::size_t width, const SourceText& source,
                const SymbolNames& names) {
  const std::string indent(width + 10, ' ');
  say(stdout, "%-*s  %-7s %s\n", static_cast<int>(width), e.label.c_str(), word(c.verdict),
      c.verdict == Verdict::proved    ? c.what.c_str()
      : c.verdict == Verdict::unknown ? c.detail.c_str()
                                      : ("nearest: " + c.what).c_str());
  if (c.verdict != Verdict::refuted) return;
  if (c.difference)
    say(stdout, "%sleft - right %s %s\n", indent.c_str(), c.identity ? "is" : "differs from it by",
        shortened(print(*c.difference, names, Format::text)).c_str());
  say(stdout, "%sleft - right = %s at a point of the motion\n", indent.c_str(), c.detail.c_str());
  const auto show = [&](const Change& k) {
    say(stdout, "%s%s:%s%s\n", indent.c_str(), source.name.c_str(), text(k).c_str(), k.proved ? "" : " (not proved)");
  };
  if (c.changes.size() == 1) show(c.changes[0]);
  if (c.changes.size() > 1) {
    say(stdout, "%s%zu changes would each make it true:\n", indent.c_str(), c.changes.size());
    for (std::size_t i = 0; i < c.changes.size() && i < kListed; ++i) show(c.changes[i]);
    if (c.changes.size() > kListed) say(stdout, "%s…\n", indent.c_str());
  }
  if (c.changes.empty())
    say(stdout, "%sno change of one term and no lost dots of up to four symbols make it true\n", indent.c_str());
}

void write_json(JsonWriter& j, const PublishedEquation& e, const Comparison& c, const SymbolNames& names) {
  j.open_object()
      .key("label")
      .string(e.label)
      .key("text")
      .string(e.text())
      .key("verdict")
      .string(word(c.verdict))
      .key("what")
      .string(c.what);
  j.key("difference");
  if (c.difference)
    j.string(print(*c.difference, names, Format::text));
  else
    j.null();
  const auto place_keys = [&](const ChangedPlace& p) {
    j.open_object()
        .key("from")
        .string(p.from)
        .key("to")
        .string(p.to)
        .key("line")
        .integer(p.span.line)
        .key("column")
        .integer(p.span.column);
    j.key("place").string(place(p));
  };
  const auto change = [&](const Change& k) {
    place_keys(k);
    j.key("proved").boolean(k.proved).key("reads").string(k.equation).key("places").open_array();
    for (const ChangedPlace& p : k.places) {
      place_keys(p);
      j.close();
    }
    j.close().close();
  };
  j.key("change");
  if (c.changes.size() == 1)
    change(c.changes[0]);
  else
    j.null();
  j.key("changes").open_array();
  for (const Change& k : c.changes) change(k);
  j.close();
  j.key("detail").string(c.detail);
  j.key("point");
  if (c.witness)
    j.string(point_text(*c.witness, names));
  else
    j.null();
  j.close();
}

}  // namespace

int compare(const Options& o) {
  if (o.equations.empty())
    throw UsageError{
        "error: no equations are named\nhint: anholon compare MODEL EQUATIONS, a file with one equation per line\n"};
  const Reader in = read(o);
  const Model& model = *in.model;
  const SourceText source = read_equation_text(o);
  Subject subject({in.model, in.names}, state_choice(o, model));
  Diagnostics diagnostics;
  const std::vector<PublishedEquation> equations = subject.read(source, diagnostics);
  if (diagnostics.has_errors()) throw UsageError{diagnostics.print(source)};
  const SymbolNames& names = subject.names();
  const bool terminal = isatty(STDERR_FILENO) != 0 && !o.quiet;
  std::vector<Comparison> found;
  for (const PublishedEquation& p : equations) {
    if (terminal) say(stderr, "\r\033[K%zu of %zu: %s", found.size() + 1, equations.size(), p.label.c_str());
    found.push_back(subject.compare(p));
  }
  if (terminal) say(stderr, "\r\033[K");
  std::size_t width = 0, counts[3] = {0, 0, 0};
  for (std::size_t i = 0; i < found.size(); ++i) {
    width = std::max(width, equations[i].label.size());
    ++counts[static_cast<std::size_t>(found[i].verdict)];
  }
  if (o.json) {
    JsonWriter j;
    j.open_object().key("model").string(model.title).key("equations").open_array();
    for (std::size_t i = 0; i < found.size(); ++i) {
      j.new_line();
      write_json(j, equations[i], found[i], names);
    }
    j.close().close();
    hand_out(j.text() + "\n");
  } else {
    say(stdout, "%s\n\n", model.title.c_str());
    for (std::size_t i = 0; i < found.size(); ++i) print_text(equations[i], found[i], width, source, names);
    say(stdout, "\n%zu true, %zu false, %zu unknown\n", counts[static_cast<std::size_t>(Verdict::proved)],
        counts[static_cast<std::size_t>(Verdict::refuted)], counts[static_cast<std::size_t>(Verdict::unknown)]);
  }
  return counts[static_cast<std::size_t>(Verdict::proved)] == found.size() ? kOk : kStopped;
}

}  // namespace anholon::cli
