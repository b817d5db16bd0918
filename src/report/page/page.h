// A run as one page of HTML: self-contained, readable without scripts, and printable; the viewer adds plots and
// picture.
//
// Text of a model or a run is shown as text, never as markup or script.
#pragma once
#include <string>

#include "report/page/content.h"

namespace anholon {

std::string html(const Page& page);

// The picture of the first case alone, for a recording: `script` runs after the viewer's script. It needs no
// facts of constraints and no equations.
std::string stage_html(const Page& page, bool dark, const std::string& script);

}  // namespace anholon
