// The cases of a sweep as a picture needs them: columns of a folder, of a CSV file or of a Parquet file.
#pragma once
#include <functional>
#include <map>

#include "api/data.h"
#include "ensemble/store/sweep_store.h"
#include "plot/heat_map.h"

namespace anholon::v1 {

class SweepCases {
 public:
  // True if the path names a folder or a file that holds a sweep.
  static bool are_in(const std::string& path);
  // Throws Failure without a place.
  explicit SweepCases(const std::string& path);

  const std::vector<std::string>& names() const { return names_; }
  const std::vector<std::string>& varied() const { return varied_; }
  bool has(const std::string& name) const;
  // True if cases have several rows, whose times are in a column.
  bool rows_at_times() const { return at_times_; }
  // The folder; null for a file.
  const inner::SweepStore* store() const { return store_ ? &*store_ : nullptr; }

  // Returns columns by name. The words of a column of words are added to `words`, and the values of the column are
  // their indices. An outcome of a case that an event ended names the event (ensemble/ending.h). If parts are missing,
  // the varied columns have the points of the whole sweep. Throws Failure without a place if a column does not exist.
  std::vector<inner::plot::NamedColumn> read(const std::vector<std::string>& names,
                                             std::vector<std::string>& words) const;
  // Returns the generation of each row that `read` returns; empty if there is one generation.
  std::vector<unsigned> generations() const;
  // Returns the command that computes the motion of a case, without the numbers of the case; empty for a file, which
  // does not name the model. A model of which only the text is known is called model.toml.
  std::string command() const;

 private:
  void read_model();
  void see_what_varies();
  void each_table(const std::function<void(const inner::ParquetTable&)>& take) const;

  std::optional<inner::SweepStore> store_;
  inner::ParquetTable file_;
  std::vector<std::string> names_, varied_;
  bool at_times_ = false;
  std::map<std::string, inner::plot::NamedColumn>
      known_;  // units, meanings and points, by columns and their quantities
};

}  // namespace anholon::v1
