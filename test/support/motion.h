// The results of a simulation, for tests that examine its numbers.
#pragma once
#include <algorithm>
#include <sstream>
#include <stdexcept>
#include <string>

#include "simulation/simulate.h"
#include "support/rows.h"

namespace anholon::test {

struct Motion {
  SimulationReport report;
  test::TextRows rows;

  // Throws std::out_of_range if there is no such row or column, so that a test fails.
  double number(std::size_t row, const std::string& column) const {
    const auto& names = rows.names();
    const auto at = std::find(names.begin(), names.end(), column);
    if (at == names.end()) throw std::out_of_range("no column " + column);
    return std::stod(rows.rows().at(row).at(static_cast<std::size_t>(at - names.begin())));
  }
  double last(const std::string& column) const { return number(rows.rows().size() - 1, column); }
};

// A saved run without the counts of its rows and of the times of monitors, which the end of the first part increases.
inline std::string of_the_motion(const std::string& saved) {
  std::istringstream lines(saved);
  std::string kept;
  for (std::string line; std::getline(lines, line);)
    if (!line.starts_with("given =") && !line.starts_with("times =") && !line.starts_with("hash ="))
      kept += line + '\n';
  return kept;
}

}  // namespace anholon::test
