#include "base/platform/installed.h"

#include <dlfcn.h>
#include <link.h>
#include <sys/auxv.h>

namespace anholon {

namespace fs = std::filesystem;

fs::path own_file() {
  std::error_code ignored;
  Dl_info info{};
  link_map* object = nullptr;
  // The linker knows the file of a shared library. For the main program the linker has no name, but the kernel has.
  if (dladdr1(reinterpret_cast<const void*>(&own_file), &info, reinterpret_cast<void**>(&object), RTLD_DL_LINKMAP) !=
          0 &&
      object != nullptr && object->l_name[0] != '\0')
    return fs::canonical(object->l_name, ignored);
  if (const fs::path file = fs::read_symlink("/proc/self/exe", ignored); !file.empty()) return file;
  // A root without /proc: the kernel also passes the name by which it started the program.
  return fs::canonical(reinterpret_cast<const char*>(getauxval(AT_EXECFN)), ignored);
}

std::vector<fs::path> data_folders(const char* name, const char* in_source) {
  constexpr int kDeepest = 4;  // PREFIX/lib/x86_64-linux-gnu/anholon/FILE
  std::vector<fs::path> folders;
  fs::path above = own_file().parent_path();
  for (int k = 0; k < kDeepest && above.has_relative_path(); ++k, above = above.parent_path())
    folders.push_back(above / "share" / "anholon" / name);
  folders.emplace_back(in_source);
  return folders;
}

}  // namespace anholon
