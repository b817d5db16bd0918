#include "ensemble/parts/scenarios.h"

#include <algorithm>

#include "base/diagnostic.h"

namespace anholon {

void must_name_each_once(const std::vector<std::string>& scenarios, const std::string& called) {
  if (scenarios.empty())
    throw Failure({}, called + " case= names no case",
                  called + " case=a,b with sections [case.a] and [case.b] in the model file");
  for (auto at = scenarios.begin(); at != scenarios.end(); ++at)
    if (std::find(scenarios.begin(), at, *at) != at)
      throw Failure({}, called + " names the case '" + *at + "' twice", "each case once");
}

static std::vector<std::string> names_of(const SweepTable& table) {
  std::vector<std::string> names;
  for (const SweepColumn& c : table.columns()) names.push_back(c.name);
  return names;
}

void has_other_columns(const std::string& scenario, const std::string& first, const std::string& hint) {
  throw Failure({}, "the case '" + scenario + "' has other columns than the case '" + first + "'", hint);
}

void must_have_units_of(const std::string& first, const std::string& first_scenario, const std::string& units,
                        const std::string& scenario) {
  const auto told = [](const std::string& of) { return of.empty() ? std::string("in SI units") : of; };
  if (units != first)
    throw Failure({},
                  "the units of what varies differ: " + told(first) + " in the case '" + first_scenario + "', and " +
                      told(units) + " in the case '" + scenario + "'",
                  "one unit of a parameter in all cases, or a sweep of each case");
}

void must_have_columns_of(const SweepTable& first, const std::string& first_scenario, const SweepTable& table,
                          const std::string& scenario, const std::string& hint) {
  if (names_of(table) != names_of(first)) has_other_columns(scenario, first_scenario, hint);
  must_have_units_of(first.units(), first_scenario, table.units(), scenario);
}

}  // namespace anholon
