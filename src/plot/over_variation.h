// Columns of a sweep over the one number that varies, as the rows of a figure.
#pragma once
#include "plot/heat_map.h"
#include "result/run_file.h"

namespace anholon::plot {

// A curve of each column over x. If several cases have the same x, the curves are the quantiles of 10, 50 and 90 % of
// their numbers. Cases without a finite number are left out.
RunFile over_variation(const NamedColumn& x, const std::vector<NamedColumn>& columns);

}  // namespace anholon::plot
