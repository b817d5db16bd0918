// The commands: each takes its parsed options, calls one function of the library and prints.
#pragma once
#include <string>
#include <vector>

#include "model/motion_settings.h"

namespace anholon::cli {

enum ExitCode : int { kOk = 0, kStopped = 1, kBadInput = 2, kFault = 3 };

struct Options {
  std::string command_line;  // in a form that can be typed again
  std::string model;
  std::string equations;
  std::string format = "text";
  bool format_given = false;
  std::string expand = "auto";
  std::string show;
  std::string output;
  MotionSettings motion;  // as asked for, without those of the file
  std::vector<std::string> set, cases, q, qdot, qddot, qdddot, lambda, lambdadot, eliminate, forms;
  std::string t;
  std::string save, resume;
  std::string report, rows;  // a page of the motion; a run whose rows the page shows
  bool no_proof = false;
  std::string vary, about;
  std::vector<std::string> varied;  // of sweep
  std::string case_count, case_table, draw;
  std::vector<std::string> reduce;
  std::string shard, chunk, folder;  // of sweeps in folders
  std::string refine, refine_by;
  bool watch = false;  // of sweep status
  bool partial = false;
  int threads = 0;
  int proof_digits = 308;
  int m = 0;  // of the forms of order m; 0: not asked for
  int points = 6;
  unsigned long long seed = 0;
  std::vector<std::string> files;
  std::vector<std::string> columns;  // of plot and sweep
  std::string histogram;             // of plot
  std::string abscissa, ordinate, from, until, size, title, labels = "unicode";
  std::string fps, seconds, picture_at, frame;  // of render
  bool dark = false;
  bool log_axis = false, each = false, together = false, equal = false;
  bool check_only = false, to_stdout = false, schema = false, markdown = false;
  int port = 0;  // of the studio
  bool no_browser = false, studio_worker = false;
  bool json = false, quiet = false, steps = false, reactions = false, csv = false;

  int digits() const { return motion.digits.value_or(16); }
};

int check(const Options& o);
int convert(const Options& o);
int derive(const Options& o);
int evaluate(const Options& o);
int linearize(const Options& o);
int simulate(const Options& o);
int sweep(const Options& o);
int sweep_status(const Options& o);
int sweep_collect(const Options& o);
int forms(const Options& o);
int models(const Options& o);
int plot(const Options& o);
int prove(const Options& o);
int render(const Options& o);
int report(const Options& o);
int studio(const Options& o);
int compare(const Options& o);
int papers(const Options& o);
int verify(const Options& o);
int reference(const Options& o);
int format(const Options& o);
int new_model(const Options& o);

}  // namespace anholon::cli
