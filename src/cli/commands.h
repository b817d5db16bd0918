// The commands: each takes its options as typed, calls one function of the library and prints.
#pragma once
#include <string>
#include <vector>

#include "model/motion_settings.h"

namespace anholon::cli {

enum ExitCode : int { kOk = 0, kStopped = 1, kBadInput = 2, kFault = 3 };

// The options of a command on a model. Most members of the structs below have the name of their option on the command
// line; an empty text or list is an option that is not given.
struct ModelCommand {
  std::string command_line;  // in a form that can be typed again
  std::string model;         // a file, the name of a shipped model, or a run
  std::vector<std::string> set, cases;
  bool json = false, quiet = false;
};

// The options of a command on a system, which is a model in a state with a form of its equations.
struct SystemCommand : ModelCommand {
  std::string t;
  std::vector<std::string> q, qdot, qddot, qdddot, lambda, lambdadot, eliminate;
  std::vector<std::string> mode;  // of the contacts
  MotionSettings motion;          // the settings of the command line, without those of the file
  std::string show;

  int digits() const { return motion.digits.value_or(16); }
};

struct DeriveCommand : SystemCommand {
  std::string format = "text", expand = "auto", output;
  bool format_given = false;
  bool steps = false, reactions = false;
  int m = 0;  // of the forms of order m; 0: not asked for
};

struct LinearizeCommand : SystemCommand {
  std::string about, vary;
  bool csv = false;
};

struct ProveCommand : SystemCommand {
  std::vector<std::string> forms;
  int m = 0;  // as in DeriveCommand
  int digits_of_enclosures = 308;
  std::string output;
};

struct CompareCommand : SystemCommand {
  std::string equations;
};

struct PapersCommand {
  std::string tag;
  bool check = false, markdown = false, json = false, quiet = false;
};

struct VerifyCommand {
  std::string certificate;
  int points = 6, digits = 308;
  unsigned long long seed = 0;
  bool json = false, quiet = false;
};

// A page of a motion.
struct PageFile {
  std::string path;
  std::vector<std::string> forms;  // the forms whose equations are shown; empty: the usual ones
  bool no_proof = false;
  std::vector<std::string> columns;  // the columns to plot, as names and patterns; empty: as many as there is room for
};

struct SimulateCommand : SystemCommand {
  std::string output, save, resume;
  PageFile page;
};

struct ReportCommand : SystemCommand {
  std::string rows;  // a run of the model
  PageFile page;
};

struct RenderCommand : SystemCommand {
  std::string rows;  // as in ReportCommand
  std::string output, size, fps, seconds, at, from, frame;
  bool dark = false;
};

struct SweepCommand : SystemCommand {
  std::vector<std::string> varied;
  std::string case_count, case_table, draw;
  unsigned long long seed = 0;
  std::vector<std::string> reduce, columns;
  int threads = 0;  // 0: as many as the machine has
  std::string output;
  std::string shard, chunk, refine, refine_by;  // for sweeps in folders
};

// The options of `sweep status` and `sweep collect`.
struct SweepFolderCommand {
  std::string command_line;  // as in ModelCommand
  std::string folder, output;
  bool watch = false, partial = false, json = false, quiet = false;
};

struct PlotCommand {
  std::string run;  // or a sweep
  std::vector<std::string> columns;
  std::string abscissa, ordinate, histogram, from, to, labels = "unicode", title, size, output;
  int motions = 0;  // the number of motions that a page of a sweep holds
  bool log = false, equal = false, each = false, together = false, json = false;
};

struct ConvertCommand {
  std::string run, output;
  bool json = false;
};

struct StudioCommand {
  std::string model;
  int port = 0;
  bool no_browser = false, worker = false, quiet = false;
};

struct NewCommand {
  std::string name, output;
};

struct FormatCommand {
  std::vector<std::string> files;
  bool check = false, to_stdout = false;
};

struct ReferenceCommand {
  std::string section;
  bool schema = false;
};

// Each of these functions runs a command and returns the exit status.
int check(const SystemCommand& o);
int compare(const CompareCommand& o);
int convert(const ConvertCommand& o);
int derive(const DeriveCommand& o);
int evaluate(const SystemCommand& o);
int format(const FormatCommand& o);
int forms(const SystemCommand& o);
int linearize(const LinearizeCommand& o);
int models(const ModelCommand& o);
int new_model(const NewCommand& o);
int papers(const PapersCommand& o);
int plot(const PlotCommand& o);
int prove(const ProveCommand& o);
int reference(const ReferenceCommand& o);
int render(const RenderCommand& o);
int report(const ReportCommand& o);
int simulate(const SimulateCommand& o);
int studio(const StudioCommand& o);
int sweep(const SweepCommand& o);
int sweep_collect(const SweepFolderCommand& o);
int sweep_status(const SweepFolderCommand& o);
int verify(const VerifyCommand& o);

}  // namespace anholon::cli
