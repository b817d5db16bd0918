// Data of a motion for its page.
#pragma once
#include <deque>
#include <memory>

#include "cli/input.h"
#include "mechanics/conserved.h"
#include "motion/saved.h"
#include "result/run_file.h"

namespace anholon::cli {

// A motion with all its data for a page.
struct Told {
  std::string name;  // of the case
  Reader in;
  std::unique_ptr<Workspace> scenario;  // the workspace of the motion and of its page
  std::vector<Conserved> conserved;
  RunFile run;
};

// Runs `simulate`. If `told` is given, the motion is stored there, too; without an output file it is stored only there.
int simulate_motion(const SimulateCommand& asked, const SavedRun* resume, Told* told);

// True if a file of this name exists and the name has the ending of a result file.
bool is_a_run(const std::string& path);

// Reads the run o.model, or the run `rows` of the model o.model, with its model. Throws UsageError.
void take_up(const SystemCommand& o, const std::string& rows, Told& x);

// Throws UsageError if the page cannot be written; called before the motion is computed.
void check_page(const PageFile& page);

// Writes the page of these motions of one model. Throws UsageError.
void write_page(const SystemCommand& o, const PageFile& page, std::deque<Told>& cases);

}  // namespace anholon::cli
