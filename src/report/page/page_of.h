// Makes the page of a motion, or of several motions of one model, from the motion alone: it chooses the equations and
// proves them.
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
  std::vector<const Formulation*> forms;  // the forms whose equations are shown; empty: chosen
  StateChoice choice;                     // of the motion: its eliminations are those of the equations
  std::string no_proof;  // the reason for leaving out the proof; empty: proves all forms, if they are not too long
  std::string version, command;  // of the program, and the command that makes this page again
  SourceText source;
  std::vector<std::string> columns = {};  // the plotted columns of the run; empty: as many as there is room for
  // Called before each proof.
  std::function<void(std::size_t number, std::size_t of, const std::string& form)> progress;
  // Called with notes on what is not drawn right.
  std::function<void(const std::string&)> note = {};
};

// The content of a page whose parts are added on request, because an editor shows the motion first.
class PageInParts {
 public:
  // Starts with the motions, without plots, equations and proof. REQUIRES: at least one run.
  PageInParts(std::vector<PagedRun> runs, std::shared_ptr<const Model> model, PageRequest request);
  PageInParts(const PageInParts&) = delete;
  PageInParts& operator=(const PageInParts&) = delete;
  const Page& page() const { return page_; }
  // Adds the plots, and the notes on what is not drawn right.
  void add_plots();
  // Throws Failure if the requested eliminations are impossible.
  void add_equations();
  // Adds the proof, or the reason why there is none. REQUIRES: add_equations() was called.
  void add_proof();

 private:
  std::shared_ptr<const Model> model_;
  PageRequest request_;
  Page page_;
  std::shared_ptr<const Model> fresh_;  // the graph of the proof's expressions
  std::optional<Proof> proof_;
  std::size_t size_ = 0;  // the number of nodes of the first equations
};

// Returns the text of the page. REQUIRES: at least one run. Throws Failure if the requested eliminations are
// impossible.
std::string page_of(std::vector<PagedRun> runs, const std::shared_ptr<const Model>& model, const PageRequest& request);

}  // namespace anholon
