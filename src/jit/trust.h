// Whose code is run.
#pragma once
#include <sys/stat.h>

namespace anholon::jit {

// Whether a file holds what `user` or root wrote, and nobody else may have written. Links, pipes and folders hold
// nothing.
inline bool trusted(const struct stat& about, uid_t user) {
  return S_ISREG(about.st_mode) && (about.st_uid == user || about.st_uid == 0) &&
         (about.st_mode & (S_IWGRP | S_IWOTH)) == 0;
}

}  // namespace anholon::jit
