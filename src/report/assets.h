// Files that the build embeds in the program: the style of pages, the viewer, the studio, the literature.
#pragma once
#include <string_view>

namespace anholon {

std::string_view page_style();
std::string_view viewer_script();  // empty if the viewer was not built
std::string_view viewer_style();
std::string_view studio_script();  // empty if the viewer was not built
std::string_view studio_style();
std::string_view map_script();  // of the map of a sweep
std::string_view map_style();
std::string_view literature();  // refs.bib

}  // namespace anholon
