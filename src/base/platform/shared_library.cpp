#include "base/platform/shared_library.h"

#include <utility>

#include <dlfcn.h>

namespace anholon {

SharedLibrary::SharedLibrary(std::string name, const char* file)
    : name_(std::move(name)), handle_(dlopen(file, RTLD_LAZY | RTLD_LOCAL)) {
  if (!handle_) trouble_ = name_ + " cannot be loaded: " + dlerror();
}

void* SharedLibrary::find(const char* symbol) {
  void* const address = handle_ ? dlsym(handle_, symbol) : nullptr;
  if (!address && trouble_.empty()) trouble_ = "this " + name_ + " has no " + symbol;
  return address;
}

}  // namespace anholon
