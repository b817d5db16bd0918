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
  std::unique_ptr<Workspace> scenario;  // in which the motion was made, and its page is
  std::vector<Conserved> conserved;
  RunFile run;
};

// `simulate`; with `told` the motion is stored there as well, and without an output only there.
int simulate_motion(const Options& asked, const SavedRun* resume, Told* told);

// Whether the path is an existing result file, by its name.
bool is_a_run(const std::string& path);

// Reads the run that the options name (o.model, or o.rows of the model o.model), with its model. Throws UsageError.
void take_up(const Options& o, Told& x);

// Call it before the motion is computed: throws UsageError if the page cannot be written.
void check_page(const Options& o);

// Writes the page of these motions of one model to o.report. Throws UsageError.
void write_page(const Options& o, std::deque<Told>& cases);

}  // namespace anholon::cli
