// A shared library that is loaded while the program runs.
#pragma once
#include <string>

namespace anholon {

class SharedLibrary {
 public:
  // Loads the file. It stays loaded to the end of the process.
  SharedLibrary(std::string name, const char* file);

  // Returns the address of a function or variable; nullptr, and notes the trouble, if the library has none of that
  // name.
  void* find(const char* symbol);
  // Returns a description of the first failure; empty if there was none.
  const std::string& trouble() const { return trouble_; }

 private:
  std::string name_, trouble_;
  void* handle_;
};

}  // namespace anholon
