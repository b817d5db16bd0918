// Published equations against the derived ones: which are true, and where the others are wrong.  (theory: proof)
#pragma once
#include "anholon/proof.h"

namespace anholon::v1 {

// A place of an equation that is to be changed.
struct ChangedPlace {
  std::string from, to;
  std::string place;              // "second term of the left side"
  unsigned line = 0, column = 0;  // in the text of the equations, from 1
};

// A change that makes an equation true; it begins at the first of its places.
struct Suggestion {
  std::vector<ChangedPlace> places;
  std::string reads;    // the changed equation
  bool proved = false;  // whether the changed equation is proved to be true
  std::string text;     // "2:7: second term of the left side: b should be c"
};

struct ComparedEquation {
  std::string label, text;
  Verdict verdict = Verdict::unknown;  // proved: true; refuted: false
  // true: the kind of the equation. false: the nearest true equation; empty if it holds at some points and fails at
  // others, or none is near.
  std::string what;
  std::string difference;  // false: left - right less the nearest true equation; empty if there is none
  std::string detail;      // false: left - right at the point; unknown: why
  std::string point;       // false: a point of the motion at which the equation fails, "x = 1/2, …"
  std::vector<Suggestion> suggestions;
  std::string with_numbers = {};  // false, unknown: the numbers of the file with which it holds, "J = 0.5, c = 0.7"
};

struct CompareOptions {
  std::string name = "equations";              // stands in diagnostics
  std::vector<std::string> eliminate = {};     // coordinates that quasi-coordinates and reduced forms eliminate
  std::map<std::string, Number> initial = {};  // the state near which they are eliminated
};

// Compares equations, one per line, LABEL: left = right, in the names of the model. Errors: diagnostics of the text.
ANHOLON_API Result<std::vector<ComparedEquation>> compare(const Model& model, const std::string& equations,
                                                          const CompareOptions& options = {});
// Compares the equations of a file, or shipped equations by their name.
ANHOLON_API Result<std::vector<ComparedEquation>> compare_file(const Model& model, const std::string& path,
                                                               const CompareOptions& options = {});

}  // namespace anholon::v1
