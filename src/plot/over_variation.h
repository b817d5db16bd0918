// Columns of a sweep over the one number that varies, as the rows of a figure.
#pragma once
#include <functional>

#include "plot/figure.h"
#include "plot/heat_map.h"
#include "result/run_file.h"

namespace anholon::plot {

// A curve of each column over x. If several cases have the same x, the curves are the quantiles of 10, 50 and 90 % of
// their numbers. Cases without a finite number are left out; at a point of x that no case has, the curves are interrupted.
RunFile over_variation(const NamedColumn& x, const std::vector<NamedColumn>& columns);

// The rows of a sweep that has several for each case, as a run of each case: columns over x, which may be the time. Rows
// of one case have the same number and stand side by side; name(row) is that of the case whose rows begin there. Cases
// without a row that has finite numbers are left out.
std::vector<NamedRun> runs_of_cases(const std::vector<double>& numbers, const NamedColumn& x,
                                    const std::vector<NamedColumn>& columns,
                                    const std::function<std::string(std::size_t row)>& name);

}  // namespace anholon::plot
