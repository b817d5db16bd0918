#include <cstdlib>
#include <cstring>
#include <filesystem>

#include <dlfcn.h>

#include "base/platform/installed.h"
#include "kernel/code.h"

namespace anholon {

// Looks beside the program or library, in the folder above it (a build tree), and among the libraries of an
// installation.
static const CompilerModule* load() {
  if (!__builtin_cpu_supports("avx2") || !__builtin_cpu_supports("fma")) return nullptr;
  std::error_code none;
  const std::filesystem::path here = own_file().parent_path();
  for (const std::filesystem::path& folder :
       {here, here.parent_path(), here / "anholon", here.parent_path() / "lib" / "anholon"}) {
    const std::filesystem::path file = folder / "anholon-compiler.so";
    if (!std::filesystem::exists(file, none)) continue;
    void* library = dlopen(file.c_str(), RTLD_NOW | RTLD_LOCAL);
    if (!library) continue;
    const auto* module = static_cast<const CompilerModule*>(dlsym(library, "anholon_compiler"));
    // The module reads plans of this program: one that was built from other headers is not used.
    const auto* layout = static_cast<const char*>(dlsym(library, "anholon_compiler_layout"));
    if (module && module->version == kCompilerVersion && layout && std::strcmp(layout, ANHOLON_KERNEL_LAYOUT) == 0)
      return module;
    dlclose(library);
  }
  return nullptr;
}

const CompilerModule* compiler() {
  static const CompilerModule* const module = load();
  return module;
}

std::string code_cache() {
  const auto set = [](const char* name) {
    const char* value = std::getenv(name);
    return std::string(value ? value : "");
  };
  if (std::getenv("ANHOLON_CACHE")) return set("ANHOLON_CACHE");
  // A relative path in XDG_CACHE_HOME is ignored (XDG Base Directory Specification).
  if (const std::string cache = set("XDG_CACHE_HOME"); cache.rfind('/', 0) == 0) return cache + "/anholon";
  if (const std::string home = set("HOME"); !home.empty()) return home + "/.cache/anholon";
  return {};
}

}  // namespace anholon
