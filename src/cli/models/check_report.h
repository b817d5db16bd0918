// The report of `check`, as text and as JSON.
#pragma once
#include "report/words.h"

namespace anholon::cli {

void check_text(Workspace& s, const Explanation& x, const Outcome& outcome);
void check_json(Workspace& s, const Explanation& x, const Outcome& outcome);

}  // namespace anholon::cli
