// The data of a page for its viewer: columns, picture and observer of every case, as viewer/CONTRACT.md defines them.
#pragma once
#include "report/page/content.h"

namespace anholon {

// What a page plots of the motion of a case; chosen: columns of its run (plot_data).
PlotData plots_of(const PageCase& of, const std::vector<std::string>& chosen);

// JSON that is safe within a <script>.
std::string page_data(const Page& page);

// The same for a page that holds many motions: in single precision but for the times, with the columns that the picture
// needs, and plots of what a motion is, without accelerations, forces and residuals.
std::string brief_page_data(const Page& page);

}  // namespace anholon
