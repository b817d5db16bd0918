// A sweep as a table: its columns, and the rows of each case.
//
//   case, [t,] what varies, outcome, event, t, steps, the columns of an ensemble, the reductions
// Without times of rows, a case has one row, the last of its motion. With times it has one row for each of them, in
// which t is that time; a row at a time that the motion did not reach contains NaN for the state.
#pragma once
#include <functional>

#include "ensemble/case.h"
#include "result/writer.h"

namespace anholon {

// Returns the units of the varied parameters that have one other than the SI unit: "m in g, a in deg".
std::string units_of(const std::vector<Varied>& varied);

class SweepTable {
 public:
  SweepTable(const Model& model, const EnsembleOptions& options);

  // All columns that can be chosen.
  const std::vector<SweepColumn>& available() const { return available_; }
  // The columns that are written; at first all except the number of steps, and except events if none ends a motion.
  std::vector<SweepColumn> columns() const;
  // Writes these columns of the available ones, in their order. The columns that identify a row (case, t if there are
  // times, and what varies) come before them if they are not among them. The reductions, which were requested by name,
  // come after them.
  void choose(const std::vector<std::size_t>& columns);
  // The units of what varies.
  const std::string& units() const { return units_; }
  // Throws Failure without a place if two of the columns have one name, as when a monitor is called "outcome": readers
  // of a file could not distinguish them.
  void must_tell_columns_apart() const;
  // Adds a column of one word after the number of the case; each call of `rows` gives the word.
  void add_word(const std::string& name);

  using Take = std::function<void(std::span<const SweepCell>)>;
  // Makes the rows of a case, with its number and the word of the added column.
  void rows(const CaseResult& result, std::size_t number, std::string_view word, const Take& take);

 private:
  void fill(const CaseResult& result, double t, std::span<const double> state);

  std::vector<SweepColumn> available_;
  std::vector<std::size_t> chosen_;
  std::size_t varied_, state_, reduced_;
  std::string units_;
  std::vector<double> times_;
  bool named_ = false;    // the column of a word exists
  bool chooses_ = false;  // columns were chosen
  std::vector<SweepCell> all_, cells_;
};

}  // namespace anholon
