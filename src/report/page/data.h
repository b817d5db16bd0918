// The data of a page for its viewer: columns, picture and observer of every case, as viewer/CONTRACT.md defines them.
#pragma once
#include "report/page/content.h"

namespace anholon {

// Returns what a page plots of the motion of a case; `chosen`: columns of its run (plot_data).
PlotData plots_of(const PageCase& of, const std::vector<std::string>& chosen);

// Returns JSON that is safe within a <script>.
std::string page_data(const Page& page);

// Like page_data(), for a page that contains many motions: in single precision except for the times, with the columns
// that the picture needs, and plots of the motion itself, without accelerations, forces and residuals.
std::string brief_page_data(const Page& page);

}  // namespace anholon
