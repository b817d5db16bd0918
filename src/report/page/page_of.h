// The page of a motion, or of several of one model, from the motion alone: which equations are shown, and their proof.
#pragma once
#include <functional>

#include "report/page/content.h"

namespace anholon {

// A motion and the scenario in which it was made.
struct PagedRun {
  std::string name;  // of the case; empty without one
  Workspace* scenario;
  std::vector<Conserved> conserved;
  RunFile run;
};

struct PageRequest {
  std::vector<const Formulation*> forms;  // whose equations are shown; empty: chosen
  StateChoice choice;                     // of the motion: its eliminations are those of the equations
  std::string no_proof;          // why there is to be no proof; empty: proves all forms, if they are not too long
  std::string version, command;  // of the program, and the command that makes this page again
  SourceText source;
  // Told before each proof.
  std::function<void(std::size_t number, std::size_t of, const std::string& form)> progress;
};

// The text of the page. REQUIRES: a run at least. Throws Failure if the eliminations that were asked for are impossible.
std::string page_of(std::vector<PagedRun> runs, const std::shared_ptr<const Model>& model, const PageRequest& request);

}  // namespace anholon
