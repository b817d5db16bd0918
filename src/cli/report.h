// A motion on its way to a page.
#pragma once
#include <deque>
#include <memory>

#include "cli/input.h"
#include "mechanics/conserved.h"
#include "motion/saved.h"
#include "result/run_file.h"

namespace anholon::cli {

// A motion with all that is told of it.
struct Told {
  std::string name;  // of the scenario
  Reader in;
  std::unique_ptr<Workspace> scenario;  // in which the motion was made, and its page is
  std::vector<Conserved> conserved;
  RunFile run;
};

// `simulate`; with `told` the motion is kept there, too, and without an output only there.
int simulate_motion(const Options& asked, const SavedRun* resume, Told* told);

// A result file that is there, told by its name.
bool is_a_run(const std::string& path);

// The run that the options name (o.model, or o.rows of the model o.model), with its model. Throws UsageError.
void take_up(const Options& o, Told& x);

// Before the motion is computed: throws UsageError where the page could not be written.
void check_page(const Options& o);

// The page of these motions of one model, to o.report. Throws UsageError.
void write_page(const Options& o, std::deque<Told>& cases);

}  // namespace anholon::cli
