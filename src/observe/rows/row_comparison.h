// The distance of two runs of one motion, column by column at the same times: an estimate of the error of the less
// exact run.
//
// The error of a column is its largest difference in relation to its largest magnitude,
//   e_j = max_t |x_j - y_j| / max_t |y_j|,   x the run, y the sharper one,
// the error of a kind of columns is the largest of its columns. A column that is zero up to round-off has no magnitude
// of its own: if its difference is at most what the other columns' relative errors make of the greatest column of its
// kind (of a monitor: of the terms it is the sum of), or at most what round-off makes of 1, the difference is relative
// to that magnitude (theory: integrals). If a motion begins with coordinates, velocities or states that are all smaller
// than round-off of 1, their differences are relative to the greatest of them.
#pragma once
#include <limits>
#include <span>

#include "observe/rows/row_values.h"

namespace anholon {

struct KindError {
  ColumnKind kind = ColumnKind::coordinate;
  double error = 0;  // of the worst column of the kind
  int digits = 0;
  std::string of;  // that column
  double t = 0;    // and its time
};

struct ErrorReport {
  std::vector<KindError> kinds;  // in the order of the columns
  std::string means;             // the way in which the error was found
  std::optional<double> until;   // the last time that was compared, if the sharper run ended earlier
  std::string stopped;           // the reason of that end
  std::optional<double> lost;    // the time from which no digits of the motion are left
  std::string lost_of;           // the column that lost its digits first
  // The multipliers that the equations do not determine one by one: their digits are those of a choice.
  std::vector<std::string> undetermined = {};
  const KindError& worst() const;
  // Takes, for each kind, the larger error of the two.
  void take_worse(const ErrorReport& other);
};

class RowComparison {
 public:
  // `roundoff` and `tolerance`: of the run under comparison.
  RowComparison(std::vector<RunColumn> columns, double roundoff, double tolerance)
      : columns_(std::move(columns)), roundoff_(roundoff), tolerance_(tolerance), most_(columns_.size()),
        terms_(columns_.size()) {}

  // One row of both runs: the differences of all columns; the magnitudes of the sharper run and of the terms that they
  // are the sums of.
  struct Row {
    double t = 0;
    std::vector<double> differences, magnitudes, terms;
  };
  void see(Row row);
  // Takes the time of an event in both runs.
  void event(const std::string& name, double t, double difference);
  // Notes that from here on the runs differ completely: no digit is left.
  void lose(double t);
  bool empty() const { return rows_.empty(); }

  // `safety`: a factor for the error between the rows and for the error of the sharper run; `written`: the relative
  // round-off of the numbers written.
  ErrorReport report(double safety, double written) const;

 private:
  std::vector<double> scales() const;
  bool begins_small(ColumnKind kind) const;

  std::vector<RunColumn> columns_;
  double roundoff_, tolerance_;
  std::vector<Row> rows_;
  std::vector<double> most_, terms_;  // magnitudes of the columns
  struct Moment {
    std::string name;
    double t = 0, difference = 0;
  };
  std::vector<Moment> events_;
};

}  // namespace anholon
