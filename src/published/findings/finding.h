// The finding of the comparison of one published equation, as text: for the command, the library and pages.
#pragma once
#include "published/compare.h"

namespace anholon {

struct FoundPlace {
  std::string from, to, place;  // place: "second term of the left side"
  Span span;
};

// A change that would make the equation true; itself the first of its places.
struct FoundChange : FoundPlace {
  std::vector<FoundPlace> places;
  std::string reads;  // the changed equation
  bool proved = false;
  // One place with its term; one symbol at several places with the places; else one after the other.
  std::string text() const;
};

struct EquationFinding {
  std::string label, text;
  Verdict verdict = Verdict::unknown;
  std::string what;                       // true: the kind of the equation; false: the nearest true one, or empty
  std::optional<std::string> difference;  // false: left - right less the nearest true equation
  bool identity = false;                  // false: the equation is meant as an identity
  std::string detail;                     // false: left - right at the point; unknown: why
  std::optional<std::string> point;       // false: values of the symbols, "x = 1/2, …"
  std::vector<FoundChange> changes;
  std::string with_numbers;  // false, unknown: the numbers of the file with which it holds
};

EquationFinding finding_of(const PublishedEquation& equation, const Comparison& comparison, const SymbolNames& names);

// "true", "false" or "unknown": the verdict on an equation.
const char* truth(Verdict verdict);

}  // namespace anholon
