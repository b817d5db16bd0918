// The library cairo, which is loaded when a figure is first drawn as PDF or PNG: with the twenty libraries that it
// needs, loading it takes longer than loading all others of the program together. Included only if cairo is available
// to the build.
#pragma once
#include <string>

#include <cairo-pdf.h>
#include <cairo.h>

namespace anholon::plot::cairo {

// All functions that are used, by their own names.
struct Library {
#define FUNCTION(name) decltype(&::name) name = nullptr;
#include "plot/cairo_functions.def"
#undef FUNCTION
};

// Loads the library at the first call. Returns an empty string, or the reason why it cannot be loaded.
const std::string& load_cairo();
// REQUIRES: load_cairo() succeeds.
const Library& library();

}  // namespace anholon::plot::cairo
