// The claims of a paper, one for each numbered equation and each displayed formula, and the check that decides each.
// The claims are in papers/*.toml.
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "base/diagnostic.h"

namespace anholon {

// The cause of a difference between the text of a paper as read and the correct formula.
enum class DifferenceBy : std::uint8_t { none, reading, text, undecidable };

// One decision about a claim, on one model.
struct ClaimCheck {
  enum class Kind : std::uint8_t {
    equation,  // an equation is true of the model's motions
    forms,     // forms of the equations of motion agree with Routh's
    points,    // the equations have several solutions at the same positions and velocities
  };
  Kind kind = Kind::equation;
  Span span;
  std::string model;              // the name of a shipped model, or a file beside the table
  bool expected = true;           // `is`
  std::string says;               // "as read", "restored", "corrected", or empty
  std::vector<std::string> lets;  // NAME = formula
  std::string equation, mutant;   // in the language of published equations
  std::vector<std::string> forms;
  std::vector<std::vector<std::pair<std::string, std::string>>> points;  // symbol, rational value
};

struct Claim {
  std::string tag;  // "3.13"; for an unnumbered formula a short name
  bool numbered = true;
  std::string title, kind, formula, hypotheses;
  std::string difference, corrected;
  DifferenceBy by = DifferenceBy::none;
  std::string form, quantity, theory;
  Span span;
  std::vector<ClaimCheck> checks;

  // True if the restored statement is true; a false one has a corrected version.
  bool holds() const { return corrected.empty(); }
};

struct Paper {
  std::string key;  // "L": tags are written L3.13
  std::string title, english, reference;
  std::vector<std::string> authors;
  std::vector<Claim> claims;
  SourceText source;
};

// "a loss of the machine reading", "an error of the text", "undecidable without the scan".
const char* in_words(DifferenceBy d);

// Reads a table of claims. All errors are collected in `diagnostics`, whose positions refer to `source`.
std::optional<Paper> read_paper(const SourceText& source, Diagnostics& diagnostics);

// A claim that matches a spelling.
struct FoundClaim {
  const Paper* paper;
  const Claim* claim;
};
// Returns all claims that a spelling may denote: L3.13, "[L 3.13]", "Luo-Zhao (3.13)", 3.13, Gamma.
std::vector<FoundClaim> find_claims(const std::vector<Paper>& papers, const std::string& spelling);
// Returns the tag with the most similar spelling; empty if none is similar.
std::string nearest_tag(const std::vector<Paper>& papers, const std::string& spelling);

}  // namespace anholon
