// A shared library that is loaded while the program runs.
#pragma once
#include <string>

namespace anholon {

class SharedLibrary {
 public:
  // Loads the file. It stays loaded to the end of the process.
  SharedLibrary(std::string name, const char* file);

  // The address of a function or variable. Returns null, and notes the trouble, if the library has none of that name.
  void* find(const char* symbol);
  // What has failed first, in words; empty if nothing has.
  const std::string& trouble() const { return trouble_; }

 private:
  std::string name_, trouble_;
  void* handle_;
};

}  // namespace anholon
