// The content of a page: the model with its motions, equations and proof.
#pragma once
#include <memory>

#include "mechanics/conserved.h"
#include "proof/prove.h"
#include "report/columns.h"
#include "report/equations.h"
#include "result/run_file.h"
#include "setup/explain.h"

namespace anholon {

// One case of the model with its motion.
struct PageCase {
  std::string name;                    // of the scenario; empty without one
  Workspace* scenario = nullptr;       // the workspace of all expressions of the case
  std::vector<ConstraintFacts> facts;  // of the model's constraints; empty if the page has no section on the system
  std::vector<Conserved> conserved;
  RunFile run;
  std::shared_ptr<const PlotData> plots = nullptr;  // of the run; nullptr: made when they are written
};

struct Page {
  std::vector<PageCase> cases;  // at least one; the equations are those of the first case
  std::vector<Derivation> equations;
  std::vector<std::string> eliminations;  // of each derivation, in words; empty without an elimination
  const Proof* proof = nullptr;
  std::string no_proof;                   // the reason if there is none
  std::vector<std::string> hypotheses;    // of the proof's certificate
  std::string meaning;                    // the statement that is proved
  std::string certificate;                // JSON
  std::size_t claims = 0, confirmed = 0;  // claims of the certificate, and those that the checker confirmed
  std::string command;                    // command that makes this page again
  std::string version, model_hash;
  SourceText source;
};

// The title of the model, or the name of its file.
std::string page_title(const Page& page);

}  // namespace anholon
