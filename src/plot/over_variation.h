// Columns of a sweep over its only varied number, as the rows of a figure.
#pragma once
#include <functional>

#include "plot/figure.h"
#include "plot/heat_map.h"
#include "result/run_file.h"

namespace anholon::plot {

// Makes a curve of each column over x. If several cases have the same x, the curves are the quantiles of 10, 50 and 90
// % of their numbers. Cases without a finite number are left out; the curves are interrupted at a point of x without
// cases.
RunFile over_variation(const NamedColumn& x, const std::vector<NamedColumn>& columns);

// Makes the rows of a sweep with several rows for each case into a run of each case: columns over x, which may be the
// time. Rows of one case have the same number and are adjacent; name(row) is the name of the case whose rows begin
// there. Cases without a row of finite numbers are left out.
std::vector<NamedRun> runs_of_cases(const std::vector<double>& numbers, const NamedColumn& x,
                                    const std::vector<NamedColumn>& columns,
                                    const std::function<std::string(std::size_t row)>& name);

}  // namespace anholon::plot
