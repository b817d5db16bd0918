#include "modelfile/language/reference.h"

#include <cstdio>

#include "cli/input.h"
#include "cli/say.h"

namespace anholon::cli {

int reference(const ReferenceCommand& o) {
  const std::string text = o.schema            ? reference_schema()
                           : o.section.empty() ? reference_page()
                                               : reference_section(o.section);
  hand_out(text);
  return kOk;
}

}  // namespace anholon::cli
