// Many motions of one system, on many threads.
#pragma once
#include <cstdint>
#include <functional>
#include <optional>
#include <span>

#include "anholon/system.h"

namespace anholon::v1 {

// What differs from motion to motion: a parameter, or the initial value of a coordinate or velocity ("theta'").
struct Vary {
  std::string name;
  std::vector<Number> values = {};
  std::string law = {};  // instead of values a random one in each case: "normal(MEAN,DEVIATION)" or "uniform(FROM,TO)"
};
// `count` values from `from` to `to`, both included.
ANHOLON_API std::vector<Number> linspace(double from, double to, std::size_t count);

struct SweepOptions {
  std::vector<Vary> vary = {};  // the grid of all combinations; the last one varies fastest
  // How many cases there are, where values are random: the cases go round the grid. Empty: all points of the grid.
  std::optional<std::size_t> cases = {};
  std::uint64_t seed = 0;  // of the random values, which depend on it and on the number of the case alone
  std::optional<Number> to = {};
  std::optional<Number> tolerance = {};
  std::size_t threads = 0;                              // 0: as many as the machine has
  std::function<bool()> cancelled = {};                 // many threads ask at once
  std::function<void(std::size_t done)> progress = {};  // by one thread at a time
};

// Cases in the order of the grid. Immutable and cheap to copy; spans live as long as any copy does.
class ANHOLON_API Sweep {
 public:
  std::size_t cases() const;
  std::size_t finished() const;  // cases that reached their end
  // Coordinates, velocities, states and monitors.
  const std::vector<std::string>& columns() const;
  // The numbers of a column at the end, one for each case; NaN where a case has no final state. Empty if there is no
  // such column.
  std::span<const double> column(const std::string& name) const;
  // The values that a name in SweepOptions::vary takes, one for each case. Empty if the name is not varied.
  std::span<const double> varied(const std::string& name) const;
  std::span<const double> t() const;  // reached
  const Outcome& outcome(std::size_t number) const;
  // finished, or interrupted.
  const Outcome& outcome() const;

  struct Data;
  explicit Sweep(std::shared_ptr<const Data> data) : data_(std::move(data)) {}

 private:
  std::shared_ptr<const Data> data_;
};

// Errors: unknown names, no end (diagnostics).
ANHOLON_API Result<Sweep> sweep(const System& system, const SweepOptions& options);

}  // namespace anholon::v1
