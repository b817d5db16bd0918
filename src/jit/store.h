// Compiled kernels on disk, between runs.
//
// Trouble with the folder costs only time: an entry is used only if it is complete, trusted (trust.h), and made for
// this key; a single rename gives it its name, so any number of processes may write it, and be killed while writing. No
// function here reports an error.
#pragma once
#include <memory>
#include <string>

#include <llvm/Support/MemoryBuffer.h>

#include "jit/key.h"

namespace anholon::jit {

class Store {
 public:
  // An empty folder name: nothing is stored.
  explicit Store(const std::string& folder) : folder_(folder) {}
  std::unique_ptr<llvm::MemoryBuffer> read(const Key& key) const;
  // Writes an entry, and removes the least recently used ones if the folder has become too large.
  void write(const Key& key, const llvm::MemoryBuffer& object) const;

 private:
  void bound() const;
  std::string folder_;
};

}  // namespace anholon::jit
