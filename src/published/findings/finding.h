// The finding of the comparison of one published equation, as text: for the command, the library and pages.
#pragma once
#include "published/compare.h"

namespace anholon {

struct FoundPlace {
  std::string from, to, place;  // place: "second term of the left side"
  Span span;
};

// A change that would make the equation true; the object itself is the first of its places.
struct FoundChange : FoundPlace {
  std::vector<FoundPlace> places;
  std::string reads;  // the changed equation
  bool proved = false;
  // Describes one place with its term; one symbol at several places with the places; other places one after the other.
  std::string text() const;
};

struct EquationFinding {
  std::string label, text;
  Verdict verdict = Verdict::unknown;
  std::string what;                       // if true, the kind of the equation; if false, the nearest true one, or empty
  std::optional<std::string> difference;  // if false, left - right less the nearest true equation
  bool identity = false;                  // if false, true for an equation that is meant as an identity
  std::string detail;                     // if false, left - right at the point; if unknown, the reason
  std::optional<std::string> point;       // if false, the values of the symbols, "x = 1/2, …"
  std::vector<FoundChange> changes;
  std::string with_numbers;  // if false or unknown, the numbers of the file with which the equation holds
  bool in_places = false;    // if false, true for an equation that holds at some points of the motion
};

EquationFinding finding_of(const PublishedEquation& equation, const Comparison& comparison, const SymbolNames& names);

// Returns "true", "false" or "unknown": the verdict on an equation.
const char* truth(Verdict verdict);

}  // namespace anholon
