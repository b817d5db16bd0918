// A motion as one page of HTML: equations, proof, plots, animation, trust. It stands by itself: no network, no other
// files.
#pragma once
#include "anholon/motion.h"

namespace anholon::v1 {

struct PageOptions {
  std::vector<std::string> forms = {};  // whose equations are shown; empty: chosen
  bool proof = true;                    // proves that the forms agree, where the equations are not too long
};

// The text of the page. Errors: unknown forms; a run without rows (diagnostics).
ANHOLON_API Result<std::string> page(const Run& run, const PageOptions& options = {});

}  // namespace anholon::v1
