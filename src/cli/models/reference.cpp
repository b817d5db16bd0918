#include "modelfile/language/reference.h"

#include <cstdio>

#include "cli/input.h"
#include "cli/say.h"

namespace anholon::cli {

int reference(const Options& o) {
  const std::string text = o.schema          ? reference_schema()
                           : o.model.empty() ? reference_page()
                                             : reference_section(o.model);
  hand_out(text);
  return kOk;
}

}  // namespace anholon::cli
