// The cases of a sweep as a picture needs them: columns of a folder, of a CSV file or of a Parquet file.
#pragma once
#include <functional>
#include <map>

#include "ensemble/store/sweep_store.h"
#include "plot/heat_map.h"

namespace anholon::cli {

class SweepCases {
 public:
  // Whether a path names a folder or a file that holds a sweep.
  static bool are_in(const std::string& path);
  // Throws Failure without a place.
  explicit SweepCases(const std::string& path);

  const std::vector<std::string>& names() const { return names_; }
  const std::vector<std::string>& varied() const { return varied_; }
  // The folder; null for a file.
  const SweepStore* store() const { return store_ ? &*store_ : nullptr; }

  // Columns by name; the words of a column of words are added to `words`, and its values are their indices. Throws
  // Failure without a place if there is no such column.
  std::vector<plot::NamedColumn> read(const std::vector<std::string>& names, std::vector<std::string>& words) const;
  // The generation of each row that `read` returns; empty if there is one generation.
  std::vector<unsigned> generations() const;
  // The command that computes the motion of a case, without the numbers of the case; empty for a file, which does not
  // tell the model. A model that is known by its text alone is model.toml.
  std::string command() const;

 private:
  void read_model();
  // The scenarios that all cases have.
  std::vector<std::string> common_scenarios() const;
  void each_table(const std::function<void(const ParquetTable&)>& take) const;

  std::optional<SweepStore> store_;
  ParquetTable file_;
  std::vector<std::string> names_, varied_;
  std::map<std::string, std::string> units_, meanings_;
};

}  // namespace anholon::cli
