#ifdef ANHOLON_CAIRO

#include "plot/cairo_library.h"

#include "base/assert.h"
#include "base/platform/shared_library.h"

namespace anholon::plot::cairo {

namespace {

struct Loaded {
  Library found;
  std::string trouble;

  Loaded() {
    SharedLibrary file("cairo", ANHOLON_CAIRO_FILE);
#define FUNCTION(name) found.name = reinterpret_cast<decltype(&::name)>(file.find(#name));
#include "plot/cairo_functions.def"
#undef FUNCTION
    if (!file.trouble().empty()) trouble = "figures in PDF and PNG need cairo: " + file.trouble();
  }
};

const Loaded& loaded() {
  static const Loaded once;
  return once;
}

}  // namespace

const std::string& load_cairo() { return loaded().trouble; }

const Library& library() {
  ANHOLON_ASSERT(loaded().trouble.empty());
  return loaded().found;
}

}  // namespace anholon::plot::cairo

#endif
