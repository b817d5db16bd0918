// A sweep in a folder: _sweep.json contains the request, and each part file a range of the cases.
//
// A part is written once and never changed, so a range that is computed twice counts once: two processes that compute
// the same cases write the same bytes. The same request opens the folder again and computes what is missing; another
// request is refused. Any number of processes may work on one folder (doc/sweeps.md).
#pragma once
#include <cstddef>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "ensemble/store/sweep_request.h"
#include "result/parquet/parquet.h"

namespace anholon {

// Cases that were planned together: the first generation is the request itself, and each further one lies at borders
// between earlier cases. Its cases and parts are numbered after those of the earlier generations.
struct Generation {
  std::size_t first_case = 0, cases = 0, first_part = 0, parts = 0;
  std::string rule;  // the definition of a border
};
std::size_t generation_of(const std::vector<Generation>& generations, std::size_t number_of_case);

class SweepStore {
 public:
  // Opens the folder, or creates it; `wanted.chunk` holds for a new folder only. Throws Failure without a place if the
  // folder contains another sweep (the message names the first difference) or other files, or if it cannot be written.
  static SweepStore open(const std::string& folder, const SweepRequest& wanted, const std::string& program);
  // Opens a folder that contains a sweep. Throws Failure without a place.
  static SweepStore open(const std::string& folder);
  // Throws Failure without a place that names the folder: its parameters are in SI units, and a program that made it now
  // would have columns in these units (SweepRequest::units).
  [[noreturn]] static void refuse_si_units(const std::string& folder, const std::string& units);
  // True if a folder contains a sweep.
  static bool is_there(const std::string& folder);

  // True if this process made the folder.
  bool made_here() const { return made_here_; }
  const std::string& folder() const { return folder_; }
  const SweepRequest& request() const { return request_; }
  // The text of this name in the request; empty if there is none.
  const std::string& asked(const std::string& name) const;

  // The generations in their order; the first one always exists.
  const std::vector<Generation>& generations() const { return generations_; }
  // Takes up the generations that other processes have added. Throws Failure as `read` does.
  void look_for_generations();
  // Adds a generation: the places of its points along so many axes, one point after the other. Throws Failure without a
  // place if it cannot be written, or if another plan has its name.
  void add_generation(const std::vector<std::int64_t>& places, std::size_t axes, const std::string& rule);
  // The places of the points of a generation after the first. Throws Failure as `read` does.
  std::vector<std::int64_t> points_of(std::size_t generation) const;

  // The numbers of cases and parts of all generations.
  std::size_t cases() const;
  std::size_t parts() const;
  // The cases of a part: from the first to the one before the second.
  std::pair<std::size_t, std::size_t> range(std::size_t part) const;
  // The numbers of the parts that are there, or missing, in ascending order; the folder is read at each call.
  std::vector<std::size_t> present() const;
  std::vector<std::size_t> missing() const;

  // Adds a part: rows of the columns, by case, with a note of that name if some of its cases stopped. Returns an empty
  // string, or the reason why the part is not in the folder: a full disk, or a part of that number with other numbers
  // in it.
  static constexpr const char* kStoppedNote = "anholon.stopped";
  std::string commit(std::size_t part, ParquetTable rows) const;
  // Reads a part. Throws Failure without a place if it is damaged, was changed, or belongs to another sweep.
  ParquetTable read(std::size_t part) const;

  struct Progress {
    std::size_t parts = 0, all_parts = 0, cases = 0, all_cases = 0;
    std::map<std::string, std::size_t> outcomes;  // cases by the name of their outcome
    std::map<std::string, std::size_t> events;    // cases by the event that ended them
    double cases_per_second = 0;                  // from the times at which the last parts were written; 0: unknown
    std::size_t unfinished = 0;                   // files of parts in work, or of processes that were killed
    std::vector<std::size_t> parts_there;         // of each generation
    std::vector<std::string> stopped;             // the notes of parts with stopped cases
  };
  // Reads the ends of all parts. Throws Failure as `read` does.
  Progress progress() const;

  std::string path_of(std::size_t part) const;

  // judgement(): how far the cases can be trusted, a JSON object; empty if the folder has none; throws Failure without
  // a place if the text is damaged. add_judgement(): adds it; the first text that is added stays; returns an empty
  // string, or the reason why it could not be written.
  std::string judgement() const;
  std::string add_judgement(const std::string& json) const;

 private:
  SweepStore(std::string folder, SweepRequest request);
  void add(std::size_t cases, std::string rule);
  std::string plan_path(std::size_t generation) const;
  void check(std::size_t part, const std::string& path, std::string_view belongs, std::string_view first) const;

  std::string folder_;
  SweepRequest request_;
  std::string id_;  // hash of the request
  std::vector<Generation> generations_;
  bool made_here_ = false;
};

}  // namespace anholon
