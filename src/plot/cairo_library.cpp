#ifdef ANHOLON_CAIRO

#include "plot/cairo_library.h"

#include <dlfcn.h>

#include "base/assert.h"

namespace anholon::plot::cairo {

namespace {

struct Loaded {
  Library found;
  std::string trouble;

  Loaded() {
    void* const file = dlopen(ANHOLON_CAIRO_FILE, RTLD_LAZY | RTLD_LOCAL);
    if (!file) {
      trouble = std::string("figures in PDF and PNG need cairo, which cannot be loaded: ") + dlerror();
      return;
    }
#define FUNCTION(name)                                                                                                 \
  found.name = reinterpret_cast<decltype(&::name)>(dlsym(file, #name));                                                \
  if (!found.name && trouble.empty()) trouble = "this cairo has no " #name;
#include "plot/cairo_functions.def"
#undef FUNCTION
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
