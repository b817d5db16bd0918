#include "spec/reference.h"

#include <cstdio>

#include "cli/input.h"

namespace anholon::cli {

int reference(const Options& o) {
  const std::string text = o.schema ? reference_schema() : o.model.empty() ? reference_page() : reference_section(o.model);
  std::fputs(text.c_str(), stdout);
  return kOk;
}

}  // namespace anholon::cli
