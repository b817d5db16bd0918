// Compiled kernels on disk, between runs.
//
// Whatever happens to the folder costs time and nothing else: an entry is taken only if it is whole, ours, and made for
// this key; it appears under its name by one rename, so any number of processes may write it, and be killed while they
// do. Nothing here reports an error.
#pragma once
#include <memory>
#include <string>

#include <llvm/Support/MemoryBuffer.h>

#include "jit/key.h"

namespace anholon::jit {

class Store {
 public:
  // An empty folder: nothing is kept.
  explicit Store(const std::string& folder) : folder_(folder) {}
  std::unique_ptr<llvm::MemoryBuffer> read(const Key& key) const;
  // Also removes what was used longest ago, where the folder has grown too large.
  void write(const Key& key, const llvm::MemoryBuffer& object) const;

 private:
  void bound() const;
  std::string folder_;
};

}  // namespace anholon::jit
