// The report of a run, out of its result file: as text, in the digits it was written in.
#pragma once
#include <set>
#include <string>
#include <vector>

#include "simulation/simulate.h"

namespace anholon {

struct RunReport {
  struct Watched {
    std::string name, first, last, least, greatest, change;
  };
  struct Event {
    struct Change {
      std::string name, before, after;
    };
    std::string name, t;
    std::vector<Change> changes;
  };
  std::string outcome, message, hint;  // outcome empty: the run was not finished
  std::string newton, projected, constraints, before_projection, power, smallest_sigma, smallest_sigma_t, steps, order;
  std::string digits;  // to trust, and by what; or why they were not estimated
  std::vector<Watched> watched;
  std::vector<Event> events;
  std::vector<Warning> warnings;
  std::set<std::string> methods;  // and integrators that made it, by their names
  bool used(const char* method) const { return methods.count(method) > 0; }
};

// From the JSON of `simulate`; numbers that are not there are dashes.
RunReport read_run_report(const std::string& json);

}  // namespace anholon
