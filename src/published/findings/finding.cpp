#include "published/findings/finding.h"

#include <algorithm>

namespace anholon {

namespace {

std::string ordinal(std::size_t k) {
  static const char* const words[] = {"first", "second",  "third",  "fourth", "fifth",
                                      "sixth", "seventh", "eighth", "ninth"};
  return k < std::size(words) ? words[k] : std::to_string(k + 1) + "th";
}

FoundPlace found(const ChangedPlace& c) {
  const std::string side = c.side == 0 ? "left side" : "right side";
  return {c.from, c.to, c.from.empty() ? side : ordinal(c.term) + " term of the " + side, c.span};
}

std::string position(const FoundPlace& c) { return std::to_string(c.span.line) + ":" + std::to_string(c.span.column); }

std::string point_text(const WitnessPoint& w, const SymbolNames& names) {
  std::string out;
  for (const auto& [symbol, value] : w.values)
    out += (out.empty() ? "" : ", ") + print(symbol, names, Format::text) + " = " + value.get_str();
  for (const WitnessPoint::Enclosed& e : w.enclosed)
    out += (out.empty() ? "" : ", ") + print(e.symbol, names, Format::text) + " = " +
           number_text(e.midpoint.get_d(), 6) + "…";
  return out;
}

}  // namespace

std::string FoundChange::text() const {
  const FoundPlace& first = places[0];
  if (first.from.empty()) return position(first) + ": the " + first.place + " lacks the term " + first.to.substr(2);
  if (places.size() == 1)
    return position(first) + ": " + first.place + ": " + first.from +
           (first.to.empty() ? " should not be there" : " should be " + first.to);
  std::string out = position(first) + ": ";
  if (std::all_of(places.begin(), places.end(),
                  [&](const FoundPlace& p) { return p.from == first.from && p.to == first.to; })) {
    out += first.from + " should be " + first.to + " at " + std::to_string(places.size()) + " places";
    for (std::size_t i = 1; i < places.size(); ++i) out += (i == 1 ? ": here, " : ", ") + position(places[i]);
    return out;
  }
  for (const FoundPlace& p : places) {
    if (&p != &first) out += ", and " + position(p) + ": ";
    out += p.from + " should be " + p.to;
  }
  return out;
}

const char* truth(Verdict v) { return v == Verdict::proved ? "true" : v == Verdict::refuted ? "false" : "unknown"; }

EquationFinding finding_of(const PublishedEquation& e, const Comparison& c, const SymbolNames& names) {
  EquationFinding f{e.label,  e.text(), c.verdict, c.what,         {},         c.identity,
                    c.detail, {},       {},        c.with_numbers, c.in_places};
  if (c.difference) f.difference = print(*c.difference, names, Format::text);
  if (c.witness) f.point = point_text(*c.witness, names);
  std::vector<Change> changes = c.changes;
  if (c.wrong_term) changes.push_back(*c.wrong_term);
  for (const Change& k : changes) {
    FoundChange change{found(k), {}, k.equation, k.proved};
    for (const ChangedPlace& p : k.places) change.places.push_back(found(p));
    f.changes.push_back(std::move(change));
  }
  return f;
}

}  // namespace anholon
