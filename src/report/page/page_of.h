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
  std::vector<std::string> columns = {};  // of the run that are plotted; empty: as many as there is room for
  // Told before each proof.
  std::function<void(std::size_t number, std::size_t of, const std::string& form)> progress;
  // Told what is not drawn right.
  std::function<void(const std::string&)> note = {};
};

// The content of a page whose parts are added as they are asked for: an editor shows the motion first.
class PageInParts {
 public:
  // The motions without plots, equations and proof. REQUIRES: a run at least.
  PageInParts(std::vector<PagedRun> runs, std::shared_ptr<const Model> model, PageRequest request);
  PageInParts(const PageInParts&) = delete;
  PageInParts& operator=(const PageInParts&) = delete;
  const Page& page() const { return page_; }
  // What is plotted, and what is not drawn right.
  void add_plots();
  // Throws Failure if the eliminations that were asked for are impossible.
  void add_equations();
  // The proof, or the reason why there is none. REQUIRES: add_equations() was called.
  void add_proof();

 private:
  std::shared_ptr<const Model> model_;
  PageRequest request_;
  Page page_;
  std::shared_ptr<const Model> fresh_;  // the graph of the proof's expressions
  std::optional<Proof> proof_;
  std::size_t size_ = 0;  // of the first equations
};

// The text of the page. REQUIRES: a run at least. Throws Failure if the eliminations that were asked for are impossible.
std::string page_of(std::vector<PagedRun> runs, const std::shared_ptr<const Model>& model, const PageRequest& request);

}  // namespace anholon
