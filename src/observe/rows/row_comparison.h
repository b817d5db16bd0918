// How far two runs of one motion are apart, column by column at the same times: an estimate of the error of the less
// exact one.
//
// The error of a column is its largest difference in relation to its largest magnitude,
//   e_j = max_t |x_j - y_j| / max_t |y_j|,   x the run, y the sharper one,
// that of a kind of columns the largest of its own. A column that is zero but for round-off has no magnitude of its
// own: where its difference is no more than what the other columns' relative errors make of the greatest column of its
// kind (of a monitor: of the terms it is the sum of), or no more than round-off makes of 1, it is measured by that.
// (theory: integrals)
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
  double t = 0;    // and when
};

struct ErrorReport {
  std::vector<KindError> kinds;  // in the order of the columns
  std::string means;             // how it was found
  std::optional<double> until;   // the last time that was compared, where the sharper run went no further
  std::string stopped;           // and why
  std::optional<double> lost;    // from when on no digits of the motion are left
  std::string lost_of;           // of which column first
  const KindError& worst() const;
  // Of each kind the larger error of the two.
  void take_worse(const ErrorReport& other);
};

class RowComparison {
 public:
  // `roundoff` and `tolerance`: of the run that is judged.
  RowComparison(std::vector<RunColumn> columns, double roundoff, double tolerance)
      : columns_(std::move(columns)), roundoff_(roundoff), tolerance_(tolerance), most_(columns_.size()),
        terms_(columns_.size()) {}

  // One row of both: the differences of all columns; the magnitudes of the sharper run and of the terms that make them.
  struct Row {
    double t = 0;
    std::vector<double> differences, magnitudes, terms;
  };
  void see(Row row);
  // A moment of both runs.
  void event(const std::string& name, double t, double difference);
  // From here on the runs do other things: no digit is left.
  void lose(double t);
  bool empty() const { return rows_.empty(); }

  // With this factor for what lies between the rows and for the error of the sharper run; `written`: the relative
  // round-off of the numbers written.
  ErrorReport report(double safety, double written) const;

 private:
  std::vector<double> scales() const;

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
