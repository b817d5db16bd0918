#include "result/file.h"

#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <filesystem>

namespace anholon {

static std::string cannot_write(const std::string& path, int why) { return "cannot write " + path + ": " + std::strerror(why); }

static std::string beside(const std::string& path) { return path + ".part"; }

std::string write_whole(const std::string& path, const std::function<bool(std::FILE*)>& write) {
  const auto failed = [&] {
    const int why = errno;
    std::remove(beside(path).c_str());
    return cannot_write(path, why);
  };
  std::FILE* file = std::fopen(beside(path).c_str(), "w");
  if (!file) return failed();
  const bool written = write(file) && std::fflush(file) == 0 && fsync(fileno(file)) == 0;
  const int why = errno;
  if (std::fclose(file) != 0 || !written || std::rename(beside(path).c_str(), path.c_str()) != 0) {
    if (!written) errno = why;
    return failed();
  }
  return {};
}

std::string write_whole(const std::string& path, const std::string& text) {
  return write_whole(path, [&](std::FILE* file) { return std::fwrite(text.data(), 1, text.size(), file) == text.size(); });
}

std::string obstacle_to_writing(const std::string& path) {
  std::error_code none;
  if (std::filesystem::is_directory(path, none)) return cannot_write(path, EISDIR);
  std::FILE* file = std::fopen(beside(path).c_str(), "w");
  if (!file) return cannot_write(path, errno);
  std::fclose(file);
  std::remove(beside(path).c_str());
  return {};
}

}  // namespace anholon
