#include "result/file.h"

#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>

namespace anholon {

std::string write_whole(const std::string& path, const std::string& text) {
  const std::string beside = path + ".part";
  const auto failed = [&] {
    const std::string why = "cannot write " + path + ": " + std::strerror(errno);
    std::remove(beside.c_str());
    return why;
  };
  std::FILE* file = std::fopen(beside.c_str(), "w");
  if (!file) return failed();
  const bool written = std::fwrite(text.data(), 1, text.size(), file) == text.size() && std::fflush(file) == 0 && fsync(fileno(file)) == 0;
  if (std::fclose(file) != 0 || !written || std::rename(beside.c_str(), path.c_str()) != 0) return failed();
  return {};
}

}  // namespace anholon
