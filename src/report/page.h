// A run as one page of HTML: self-contained, readable without scripts, prints; the viewer brings plots and picture to
// life.
//
// Whatever a model or a run holds is text on the page, never markup or program.
#pragma once
#include "mechanics/conserved.h"
#include "proof/prove.h"
#include "report/equations.h"
#include "report/words.h"
#include "result/run_file.h"

namespace anholon {

// One scenario of the model with its motion.
struct PageCase {
  std::string name;               // of the scenario; empty without one
  Workspace* scenario = nullptr;  // of all expressions of the case
  const Explanation* explanation = nullptr;
  std::vector<Conserved> conserved;
  RunFile run;
};

struct Page {
  std::vector<PageCase> cases;  // one at least; the equations are those of the first
  std::vector<Derivation> equations;
  std::vector<std::string> eliminations;  // of each derivation, in words; empty where nothing is eliminated
  const Proof* proof = nullptr;
  std::string no_proof;                   // why there is none
  std::vector<std::string> hypotheses;    // of the proof's certificate
  std::string meaning;                    // what is proved
  std::string certificate;                // JSON
  std::size_t claims = 0, confirmed = 0;  // of the certificate, by the checker
  std::string command;                    // that makes this page again
  std::string version, model_hash;
  SourceText source;
};

std::string html(const Page& page);

// The picture of the first case alone, for whoever records it: `script` runs after the viewer's. Needs no explanation
// and no equations.
std::string stage_html(const Page& page, bool dark, const std::string& script);

}  // namespace anholon
