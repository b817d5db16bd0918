#include "base/read_file.h"

#include <cerrno>
#include <cstring>
#include <fstream>

namespace anholon {

bool read_file(const std::filesystem::path& path, std::string& text, std::string* why) {
  std::error_code ignored;
  if (std::filesystem::is_directory(path, ignored)) {
    if (why) *why = "it is a directory";
    return false;
  }
  std::ifstream in(path, std::ios::binary);
  if (!in) {
    if (why) *why = std::strerror(errno);
    return false;
  }
  // A device may be endless. A file longer than any model or certificate is cut, and its reader then rejects it.
  constexpr std::size_t kMostBytes = 64 << 20, kPiece = 1 << 16;
  text.clear();
  for (std::size_t got = kPiece; got == kPiece && text.size() < kMostBytes;) {
    const std::size_t before = text.size();
    text.resize(before + kPiece);
    in.read(text.data() + before, kPiece);
    got = static_cast<std::size_t>(in.gcount());
    text.resize(before + got);
  }
  return !in.bad();
}

}  // namespace anholon
