// Many motions of one system, on many threads.
#pragma once
#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <span>

#include "anholon/system.h"

namespace anholon::v1 {

// What differs from motion to motion: a parameter, or the initial value of a coordinate or velocity ("theta'"); in a sweep
// of a model also its scenarios, {"case", {"moon", "long"}}.
struct Vary {
  std::string name;
  std::vector<Number> values = {};
  // Instead of values: "normal(MEAN,DEVIATION)" or "uniform(FROM,TO)" draws one in each case; "FROM:TO:COUNT" is a grid
  // whose points are computed when they are needed, so that a grid of 10^9 points takes no memory.
  std::string law = {};
};
// `count` values from `from` to `to`, both included.
ANHOLON_API std::vector<Number> linspace(double from, double to, std::size_t count);

struct SweepOptions {
  std::vector<Vary> vary = {};  // the grid of all combinations; the last one varies fastest
  // A table of cases: names of what varies in the first line, and numbers, formulas or numbers with units in each further
  // one, with commas between them. Beside `vary` its lines are one more axis, which varies fastest. case_table reads a file.
  std::string table = {};
  std::string table_name = "the table";  // in messages
  // How many cases there are, where values are random: the cases go round the grid. Empty: all points of the grid.
  std::optional<std::size_t> cases = {};
  std::uint64_t seed = 0;  // of the random values, which depend on it and on the number of the case alone
  // "random", or "sobol": the points of a Sobol sequence, shifted by the seed, which lie more evenly than random ones.
  std::string draw = "random";
  bool together = false;  // the lists have the same length and go together: a table of cases instead of a grid
  std::optional<Number> to = {};
  std::optional<Number> tolerance = {};
  std::vector<Number> at = {};            // times at which the state of each case is kept, too
  std::vector<std::string> columns = {};  // names or patterns with * and ?; empty: all
  // "max(FORMULA)", min or mean: over the whole motion of a case, by its Taylor polynomials; "last(FORMULA)": at its end; the
  // formula is a monitor or any formula of the model. "count(EVENT)": how often an event of the model or of a contact fired;
  // "first(EVENT)": its first time, NaN if it did not fire. Each is a column.
  std::vector<std::string> reduce = {};
  std::size_t threads = 0;                              // 0: as many as the machine has
  std::function<bool()> cancelled = {};                 // many threads ask at once
  std::function<void(std::size_t done)> progress = {};  // by one thread at a time
};

// The text of a table of cases from a CSV file, or from a Parquet file with columns of numbers or words. Errors: the file
// cannot be read, is damaged, or has other columns (diagnostics).
ANHOLON_API Result<std::string> case_table(const std::string& path);

// Cases in the order of the grid. Immutable and cheap to copy; spans live as long as any copy does.
class ANHOLON_API Sweep {
 public:
  std::size_t cases() const;
  std::size_t finished() const;  // cases that reached their end
  // Coordinates, velocities, states, monitors and reductions, as far as SweepOptions::columns chooses them.
  const std::vector<std::string>& columns() const;
  // The numbers of a column at the end, one for each case; NaN where a case has no final state. Empty if there is no
  // such column.
  std::span<const double> column(const std::string& name) const;
  // The times of SweepOptions::at, in ascending order.
  const std::vector<double>& times() const;
  // A column at these times, case by case: the number of a case at times()[k] is element case * times().size() + k; NaN
  // at times that the case did not reach. Empty if there are no times, no such column, or if it is a reduction.
  std::span<const double> rows(const std::string& name) const;
  // The names that vary: those in SweepOptions::vary, without scenarios, then those of the table.
  const std::vector<std::string>& varied_names() const;
  // The values that one of these names takes, one for each case: those of a parameter in the unit that the model
  // declares for it, as they are given, else in SI units. Empty if the name is not varied, or if it stands for scenarios.
  std::span<const double> varied(const std::string& name) const;
  // The scenarios that vary, in their order; empty if none do.
  const std::vector<std::string>& scenarios() const;
  // The scenario of a case; empty if none vary.
  const std::string& scenario(std::size_t number) const;
  std::span<const double> t() const;  // reached
  const Outcome& outcome(std::size_t number) const;
  // The event that ended the motion of a case; empty if none did.
  const std::string& event(std::size_t number) const;
  std::size_t steps(std::size_t number) const;
  // finished, or interrupted.
  const Outcome& outcome() const;
  // Reductions that have no value in some of the cases, and for each way in which cases stopped how many there are, the
  // first one, its message and a hint: what `anholon sweep` says at its end.
  const std::vector<std::string>& notes() const;
  // The units of columns and of what varies, as far as the model tells them.
  const std::map<std::string, std::string>& units() const;
  // Writes FILE.h5, FILE.csv, FILE.json or FILE.parquet, with the columns of `anholon sweep -o`: what varies and how each
  // case ended stand before the columns of the sweep. Cases that were not computed are left out. Returns the path.
  // Errors: another ending, a file that cannot be written (diagnostics).
  Result<std::string> write(const std::string& path) const;

  struct Data;
  explicit Sweep(std::shared_ptr<const Data> data) : data_(std::move(data)) {}
  const Data& data() const { return *data_; }

 private:
  std::shared_ptr<const Data> data_;
};

// Errors: unknown names and columns, formulas that make no sense, times outside of the motions, no end (diagnostics).
ANHOLON_API Result<Sweep> sweep(const System& system, const SweepOptions& options);
// The same of a model, as `anholon sweep` does it, which needs no consistent start beside those of the cases. A Vary named
// "case" runs through sections [case.NAME] of the file, each laid over the model after ReadOptions::cases, the values being
// their names; whatever its place, it varies slowest, and each scenario has all cases of the others:
//   sweep(*read_file("pendulum.toml"), {.vary = {{"case", {"moon", "long"}}, {"theta", {0.1, 0.2}}}, .to = 1})
// has four cases, moon 0.1, moon 0.2, long 0.1, long 0.2. Values of ReadOptions::set win over those of a scenario. Errors:
// as above, and those of read_file and prepare for a scenario; a name that is there twice; scenarios with different
// columns; `together`, which is for values.
ANHOLON_API Result<Sweep> sweep(const Model& model, const SweepOptions& options, const PrepareOptions& prepare = {});

}  // namespace anholon::v1
