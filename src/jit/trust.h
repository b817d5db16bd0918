// Decides which files may be loaded as code.
#pragma once
#include <sys/stat.h>

namespace anholon::jit {

// True if a file is a regular file that belongs to `user` or root and that nobody else could have written. Links, pipes
// and folders are not trusted.
inline bool trusted(const struct stat& about, uid_t user) {
  return S_ISREG(about.st_mode) && (about.st_uid == user || about.st_uid == 0) &&
         (about.st_mode & (S_IWGRP | S_IWOTH)) == 0;
}

}  // namespace anholon::jit
