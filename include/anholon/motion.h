// One motion: rows of numbers, events, and a report of how far they can be trusted.
#pragma once
#include <functional>
#include <map>
#include <span>

#include "anholon/system.h"

namespace anholon::v1 {

struct MotionOptions {
  std::optional<Number> to = {};         // the end; that of the file if it is empty
  std::optional<Number> every = {};      // a row at each multiple of it after the start; empty: a row at each step
  std::vector<Number> at = {};           // rows at these times and at no other
  std::optional<Number> tolerance = {};  // relative, of each step; 1e-12 if neither the file nor you say otherwise
  int order = 0;                         // of the Taylor polynomials; 0: from the tolerance
  std::string method = {};               // auto, taylor, rk or bdf; empty: that of the file, or auto
  int digits = 16;                       // more than 16: multiple precision
  bool error_estimate = true;            // by a second, sharper run, where there are no more than 5000 steps
  // Any option of `anholon simulate` that changes the motion, by its name: {{"numbers", "quad"}, {"rigorous", "64"}}.
  std::map<std::string, std::string> others = {};
  bool dense = false;  // keeps the polynomials of all steps, for Run::at; all steps are then Taylor's
  std::optional<std::size_t> most_steps = {};  // the motion ends after so many; empty: that of the file, or 50 million
  std::function<bool()> cancelled = {};        // asked at every step; true ends the motion
  std::function<void(double t, std::size_t steps)> progress = {};
};

struct Column {
  std::string name;           // "t", "x", "x'", "lambda.rod", "N.x", a state, a monitor
  std::string kind;           // "coordinates", "velocities", "multipliers", "reactions", …
  std::string unit;           // empty where the model names none
  unsigned order = 0;         // of the derivative
  std::string latex, mathml;  // its symbol in the notation of the model
};

struct Event {
  struct Change {
    std::string name;
    double before = 0, after = 0;
  };
  std::string name;
  double t = 0;
  std::vector<Change> changes;
  bool stop = false;  // it ends the motion
};

// Digits of the columns of one kind that can be trusted.
struct Trust {
  std::string kind;  // "coordinates", …
  int digits = 0;
  double error = 0;  // of the worst column, in relation to its largest value
  std::string worst;
};

// A quantity that was watched from the first row to the last.
struct Watched {
  std::string name;
  double first = 0, last = 0, least = 0, greatest = 0;
  double largest_change = 0;  // from the first value, relative
  bool conserved = false;     // it is known to be an integral of the motion
};

// All residuals are relative to the greatest of their terms along the motion.  (theory: certificate)
struct Report {
  double newton = 0;             // Newton's law by the points themselves, with ideal reactions
  double projected = 0;          // the same without multipliers
  double constraints = 0;        // constraints and their derivatives at the rows
  double before_projection = 0;  // the same before each step is projected
  double power = 0;              // h - h(0) - work
  double smallest_sigma = 0;     // the least scaled singular value of the system Jacobian
  double smallest_sigma_t = 0;   // when it was met
  std::size_t steps = 0;
  int order = 0;
  std::string method;  // by which the last step was made
  double seconds = 0;
  std::vector<Trust> trust;  // empty: no estimate, see `no_trust`
  std::string no_trust;
  std::vector<Watched> watched;
  std::vector<std::string> warnings, notes;
  std::size_t rows_looked_at = 0;  // at which the residuals were computed; a long run's report looks at ever fewer rows
};

// Immutable and cheap to copy; spans live as long as any copy does.
class ANHOLON_API Run {
 public:
  const Outcome& outcome() const;
  std::size_t rows() const;
  const std::vector<Column>& columns() const;
  // The numbers of a column, one for each row, in SI units, or in the unit that the file gives an output; empty if there
  // is no column of that name.
  std::span<const double> column(const std::string& name) const;
  std::span<const double> t() const { return column("t"); }
  // All numbers in one block, column after column: those of columns()[k] begin at k * rows().
  std::span<const double> block() const;
  // A number as text, with all digits of the run. Returns an empty text if there is no such column or row.
  std::string text(std::size_t row, const std::string& column) const;
  const std::vector<Event>& events() const;
  const Report& report() const;
  // Whether the polynomials are there (MotionOptions::dense).
  bool has_dense() const;
  // The derivative of that order of a coordinate, or of a state of the model, at any times of the motion, by the
  // polynomials of its steps; NaN at other times, or if there are none. At an event that changes values: those before.
  // A StopRequest ends it, and the remaining values are NaN.
  std::vector<double> at(const std::string& name, std::span<const double> times, int order = 0) const;
  // Columns, rows and the report as `anholon simulate --json` prints them; empty if a StopRequest ended it.  (doc/json.md)
  std::string json() const;
  // Writes .csv, .json or .h5 by the end of the name; the file is there as a whole or stays as it was,
  // also if a StopRequest ends it.
  Result<std::string> write(const std::string& path) const;

  struct Data;
  explicit Run(std::shared_ptr<const Data> data) : data_(std::move(data)) {}
  const Data& data() const { return *data_; }

 private:
  std::shared_ptr<const Data> data_;
};

// A motion that stops before its end is a Run all the same: its rows are there, and outcome() says why it stopped.
// Errors: arguments that make no sense (diagnostics).
ANHOLON_API Result<Run> simulate(const System& system, const MotionOptions& options = {});

}  // namespace anholon::v1
