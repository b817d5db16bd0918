// Sweeps in folders: parts that are complete or absent, which any number of processes compute.
#pragma once
#include <map>
#include <variant>

#include "anholon/motion.h"
#include "anholon/sweep.h"

namespace anholon::v1 {

// Cases that were planned together: the first generation is what was asked for, each further one refines borders between
// the cases before it.
struct FolderGeneration {
  std::size_t first_case = 0, cases = 0, parts = 0, all_parts = 0;
};

struct FolderProgress {
  std::size_t parts = 0, all_parts = 0, cases = 0, all_cases = 0;
  std::size_t unfinished = 0;                   // files of parts under way, or of processes that were killed
  std::map<std::string, std::size_t> outcomes;  // cases by the name of their outcome
  double cases_per_second = 0;                  // by the times at which the last parts were written; 0: unknown
  std::vector<FolderGeneration> generations = {};
  // Why cases stopped: for each outcome how many there are, the first one, its message and a hint.
  std::vector<std::string> notes = {};
  std::map<std::string, std::size_t> events = {};  // finished cases by the event that ended them
};

// A column over all cases of the parts that are there. `number` is a double that may be NaN.
struct FolderColumn {
  struct Words {
    std::vector<std::string> different;
    std::vector<std::uint32_t> rows;  // the index of the word of each row
  };
  std::string name;
  std::variant<std::vector<double>, std::vector<std::int64_t>, Words> values;
};

struct FolderWork {
  std::size_t share = 1, shares = 1;                     // every part with a number that leaves the remainder share - 1
  std::optional<std::vector<std::size_t>> parts = {};    // these parts instead
  std::size_t threads = 0;                               // 0: as many as the machine has
  std::function<bool()> cancelled = {};                  // many threads ask at once
  std::function<void(std::size_t cases)> progress = {};  // by one thread at a time
};
struct FolderDone {
  std::size_t parts = 0, cases = 0;     // computed by this call
  bool complete = false;                // whether the folder holds all parts that were asked for
  std::vector<std::string> notes = {};  // reductions that have no value in some of these cases
  std::string error;  // the reason why a part could not be written: a full disk, another part of that name
};

// Immutable and cheap to copy; the folder itself changes as processes add parts.
class ANHOLON_API SweepFolder {
 public:
  const std::string& path() const;
  std::size_t cases() const;  // of all generations that are planned, as are the parts
  std::size_t parts() const;
  std::size_t chunk() const;  // cases of a part
  const std::vector<std::string>& columns() const;
  // How the program that made the folder can ask for the same sweep, in words of its own.
  const std::string& recipe() const;
  // What was asked, by name: "model", "vary", "to", "tolerance", …; empty if it was not.
  const std::string& asked(const std::string& name) const;
  // Whether the text of the model refers to further files, which the folder keeps.
  bool keeps_files() const;
  // The model whose cases the folder holds, from its text and the files that the folder keeps. Errors: as `read_file`.
  Result<Model> model(const ReadOptions& options = {}) const;
  // Numbers of parts, ascending. Errors: the folder cannot be read.
  Result<std::vector<std::size_t>> missing() const;
  Result<std::vector<std::size_t>> present() const;
  // Errors: a part is damaged or belongs to another sweep.
  Result<FolderProgress> progress() const;
  // The columns of these names, of the parts that are there; all columns if no name is given. Errors: as above, or there
  // is no such column.
  Result<std::vector<FolderColumn>> read(const std::vector<std::string>& names = {}) const;
  // The values that the columns of grids, lists and tables take over the whole sweep, by the name of the column. A column that
  // is drawn is not among them, nor is a grid with more than 65536 values, or any column if files of the model are missing.
  std::map<std::string, std::vector<double>> points() const;
  // The units of the columns, as far as the model that the folder keeps tells them.
  std::map<std::string, std::string> units() const;
  // Computes parts that are missing. All calls share the equations, and the calls of several threads may overlap. Errors:
  // the folder was opened by its name alone.
  Result<FolderDone> fill(const FolderWork& work = {}) const;
  // Plans the next generation: it halves the grid where neighbours ended in different ways, and, if a rule COLUMN:BOUND is
  // given, where their numbers in a column differ by more than a bound. Returns how many cases it adds, 0 if there is no
  // border. With a number, 1 for the first one that refines, it plans this generation, and returns its cases, too, if
  // another process has planned it before. Errors: parts are missing, what varies is no grid, an earlier generation
  // followed another rule, the generation before that number is not there, several scenarios vary, or the folder was opened by its name alone.
  Result<std::size_t> refine(const std::string& rule = {}, std::optional<std::size_t> number = {}) const;
  // The numbers of a case by the names that vary, as exact text; before them "case" and the name of its scenario, if
  // scenarios vary. Errors: there is no such case, or as `fill`.
  Result<std::vector<std::pair<std::string, std::string>>> numbers(std::size_t number) const;
  // The options of `anholon simulate` for the motion of a case, with their words: {"qdot", "phi=5"} for --qdot phi=5,
  // {"case", "wet"}, {"to", "3"}. Values of the case are exact if the folder was opened for a computation. If it was opened
  // by its name alone, they are those that the folder keeps, in double. Errors: there is no such case; of a folder that was
  // opened by its name alone its part is missing or damaged, or the folder does not keep all that varies.
  Result<std::vector<std::pair<std::string, std::string>>> words(std::size_t number) const;
  // The whole motion of a case, computed anew with its parameters, initial values and scenario, and with the form, the
  // method, the tolerance and the end of the sweep where the options do not say otherwise. Values of the case are those
  // of `words`. Errors: as `words`, `prepare` and `simulate`.
  Result<Run> run(std::size_t number, const MotionOptions& options = {}) const;
  // How far the cases can be trusted, as JSON: digits to trust and residuals of some of them, and sentences that tell
  // these. The folder keeps it; the first call computes the cases once more. Errors: parts are missing, the folder cannot
  // be written, it was stopped, or, where the folder does not keep it yet, it was opened by its name alone.
  Result<std::string> judge(const std::function<bool()>& cancelled = {}) const;

  struct Data;
  explicit SweepFolder(std::shared_ptr<const Data> data) : data_(std::move(data)) {}

 private:
  std::shared_ptr<const Data> data_;
};

// Opens the folder for this sweep, or makes it; nothing is computed. `chunk` holds for a new folder; 0: as many cases as
// take some seconds, by a trial. `recipe` is kept in a new folder as it is. `refine`: a rule, by which `refine` is called
// later. Errors: as `sweep`; another sweep or other files are in the folder; it cannot be written; the sweep cannot be
// refined by the rule.
ANHOLON_API Result<SweepFolder> sweep_into(const System& system, const SweepOptions& options, const std::string& folder,
                                           std::size_t chunk = 0, const std::string& recipe = {},
                                           const std::optional<std::string>& refine = {});
// The same of a model, whose scenarios may vary, as in `sweep`. The name of the scenario is the column "case_name".
ANHOLON_API Result<SweepFolder> sweep_into(const Model& model, const SweepOptions& options, const std::string& folder,
                                           std::size_t chunk = 0, const std::string& recipe = {},
                                           const PrepareOptions& prepare = {},
                                           const std::optional<std::string>& refine = {});
// Opens a folder to look at it. Errors: it holds no sweep.
ANHOLON_API Result<SweepFolder> open_sweep(const std::string& folder);

}  // namespace anholon::v1
