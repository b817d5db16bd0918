#include "result/file.h"

#include <cerrno>
#include <chrono>
#include <cstddef>
#include <cstring>
#include <filesystem>
#include <thread>

#include <fcntl.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>
#include <unistd.h>

#include "base/hash.h"
#include "base/stop.h"

namespace anholon {

namespace fs = std::filesystem;

static std::string cannot_write(const std::string& path, int why) {
  return "cannot write " + path + ": " + std::strerror(why);
}

static std::string part_of(const std::string& path) { return path + ".part"; }

// A link is kept; its target is written.
std::string target_of_link(const std::string& path) {
  constexpr int kMostLinks = 40;  // as many as the system follows
  std::error_code none;
  fs::path at = path;
  for (int k = 0; k < kMostLinks && fs::is_symlink(at, none); ++k) {
    const fs::path to = fs::read_symlink(at, none);
    if (none) return path;
    at = to.is_absolute() ? to : at.parent_path() / to;
  }
  return at.string();
}

static bool is_other_kind(const std::string& path) {
  struct stat info{};
  return ::stat(path.c_str(), &info) == 0 && !S_ISREG(info.st_mode) && !S_ISDIR(info.st_mode);
}

// The reason why a file of this name cannot be replaced; 0 if it can. Missing rights on the folder show when the part
// is created.
static int obstacle(const std::string& path) {
  struct stat info{};
  if (::stat(path.c_str(), &info) != 0) return 0;
  if (S_ISDIR(info.st_mode)) return EISDIR;
  return ::access(path.c_str(), W_OK) == 0 ? 0 : errno;
}

// Opens the part, empty, with the mode of the file that it will replace. A link of that name is not followed.
static int open_part(const std::string& target, int flags) {
  const std::string beside = part_of(target);
  const int fd = ::open(beside.c_str(), flags | O_CREAT | O_TRUNC | O_NOFOLLOW | O_CLOEXEC, 0666);
  struct stat info{};
  if (fd >= 0 && ::stat(target.c_str(), &info) == 0 && ::fchmod(fd, info.st_mode & 07777) != 0) errno = 0;
  return fd;
}

// A socket in the abstract name space, named by the folder and the file: only one process at a time can bind it, and
// the kernel frees it.
WritingClaim::WritingClaim(const std::string& path, double seconds) {
  if (path.empty()) return;
  std::error_code none;
  const fs::path name = target_of_link(path);
  const fs::path folder = name.has_parent_path() ? name.parent_path() : fs::path(".");
  struct stat info{};
  if (::stat(folder.c_str(), &info) != 0) return;  // the part cannot be created either, and reports the reason
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  const std::string key = "anholon-" + sha256_text(std::to_string(info.st_dev) + "/" + std::to_string(info.st_ino) +
                                                   "/" + name.filename().string());
  std::memcpy(address.sun_path + 1, key.data(), std::min(key.size(), sizeof address.sun_path - 1));
  const auto length = static_cast<socklen_t>(offsetof(sockaddr_un, sun_path) + 1 + key.size());
  // Without sockets there are no claims.
  socket_ = ::socket(AF_UNIX, SOCK_DGRAM | SOCK_CLOEXEC, 0);
  if (socket_ < 0) return;
  const auto until = std::chrono::steady_clock::now() + std::chrono::duration<double>(seconds);
  while (::bind(socket_, reinterpret_cast<const sockaddr*>(&address), length) != 0 && errno == EADDRINUSE) {
    if (std::chrono::steady_clock::now() >= until) {
      error_ = "cannot write " + path + ": another process writes it";
      return;
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
}

WritingClaim::~WritingClaim() {
  if (socket_ >= 0) ::close(socket_);
}

void start_writing(const std::string& path) {
  const int fd = ::open(path.c_str(), O_WRONLY | O_NOFOLLOW | O_CLOEXEC);
  if (fd < 0) return;
  ::sync_file_range(fd, 0, 0, SYNC_FILE_RANGE_WRITE);
  ::close(fd);
}

GrowingFile::GrowingFile(const std::string& path)
    : shown_(path.empty() || path == "-" ? "the output" : path), target_(target_of_link(path)),
      claim_(path.empty() || path == "-" || is_other_kind(path) ? std::string() : path) {
  if (path.empty() || path == "-") {
    file_ = stdout;
    return;
  }
  error_ = claim_.error();
  if (!error_.empty()) return;
  if (is_other_kind(target_)) {
    file_ = std::fopen(target_.c_str(), "w");
    if (!file_) fail(errno);
    return;
  }
  if (const int why = obstacle(target_)) {
    fail(why);
    return;
  }
  beside_ = part_of(target_);
  const int fd = open_part(target_, O_WRONLY);
  if (fd < 0 || !(file_ = ::fdopen(fd, "w"))) fail(errno);
}

GrowingFile::~GrowingFile() {
  if (file_ && !begun_) remove();
  if (file_ && file_ != stdout) std::fclose(file_);
}

void GrowingFile::fail(int why) {
  if (error_.empty()) error_ = cannot_write(shown_, why);
}

void GrowingFile::write(std::string_view text) {
  begun_ = true;
  unwritten_ += text.size();
  if (file_ && error_.empty() && std::fwrite(text.data(), 1, text.size(), file_) != text.size()) fail(errno);
}

void GrowingFile::flush() {
  constexpr std::size_t kMuch = 4u << 20;
  if (file_ && error_.empty() && std::fflush(file_) != 0) fail(errno);
  if (unwritten_ < kMuch || !file_ || beside_.empty()) return;
  ::sync_file_range(::fileno(file_), 0, 0, SYNC_FILE_RANGE_WRITE);
  unwritten_ = 0;
}

std::string GrowingFile::close() {
  if (!file_) return error_;
  flush();
  if (error_.empty() && std::ferror(file_)) fail(EIO);
  // The bytes are on disk before the name appears.
  if (error_.empty() && !beside_.empty() && ::fsync(::fileno(file_)) != 0) fail(errno);
  if (file_ != stdout && std::fclose(file_) != 0) fail(errno);
  file_ = nullptr;
  if (!beside_.empty() && error_.empty() && std::rename(beside_.c_str(), target_.c_str()) != 0) fail(errno);
  closed_ = error_.empty();
  return error_;
}

void GrowingFile::remove() {
  if (file_ && file_ != stdout) std::fclose(file_), file_ = nullptr;
  if (!beside_.empty()) std::remove(beside_.c_str());
}

// Other processes write only for a moment.
static constexpr double kPatience = 20;

std::string write_whole_by_name(const std::string& path,
                                const std::function<std::string(const std::string& beside)>& write) {
  if (is_other_kind(path)) return write(path);
  const WritingClaim claim(path, kPatience);
  if (!claim.error().empty()) return claim.error();
  const std::string target = target_of_link(path), beside = part_of(target);
  if (const int why = obstacle(target)) return cannot_write(path, why);
  const int fd = open_part(target, O_WRONLY);
  if (fd < 0) return cannot_write(path, errno);
  ::close(fd);
  std::string why;
  try {
    why = write(beside);
  } catch (...) {  // StopRequested, or no memory
    std::remove(beside.c_str());
    throw;
  }
  if (why.empty() && std::rename(beside.c_str(), target.c_str()) != 0) why = cannot_write(path, errno);
  if (!why.empty()) std::remove(beside.c_str());
  return why;
}

std::string write_whole(const std::string& path, const std::function<bool(std::FILE*)>& write) {
  return write_whole_by_name(path, [&](const std::string& beside) -> std::string {
    std::FILE* file = std::fopen(beside.c_str(), "w");
    if (!file) return cannot_write(path, errno);
    // Only a regular file has a disk to wait for.
    bool written = false;
    try {
      written = write(file);
    } catch (...) {
      std::fclose(file);
      throw;
    }
    written = written && std::fflush(file) == 0 && (::fsync(::fileno(file)) == 0 || errno == EINVAL || errno == EROFS);
    const int why = errno;
    if (std::fclose(file) != 0 && written) return cannot_write(path, errno);
    return written ? std::string() : cannot_write(path, why);
  });
}

std::string write_whole(const std::string& path, const std::string& text) {
  return write_whole(path, [&](std::FILE* file) {
    constexpr std::size_t kPiece = 1u << 20;
    for (std::string_view rest = text; !rest.empty();) {
      look_for_stop();
      const std::string_view piece = rest.substr(0, kPiece);
      if (std::fwrite(piece.data(), 1, piece.size(), file) != piece.size()) return false;
      rest.remove_prefix(piece.size());
    }
    return true;
  });
}

std::string write_stream(const std::string& path, const std::function<bool(std::FILE*)>& write) {
  if (!path.empty() && path != "-") return write_whole(path, write);
  if (write(stdout) && std::fflush(stdout) == 0) return {};
  return "cannot write the output: " + std::string(std::strerror(errno));
}

std::string obstacle_to_writing(const std::string& path) {
  if (is_other_kind(path)) return ::access(path.c_str(), W_OK) == 0 ? std::string() : cannot_write(path, errno);
  const WritingClaim claim(path);
  if (!claim.error().empty()) return claim.error();
  const std::string target = target_of_link(path);
  if (const int why = obstacle(target)) return cannot_write(path, why);
  const int fd = open_part(target, O_WRONLY);
  if (fd < 0) return cannot_write(path, errno);
  ::close(fd);
  std::remove(part_of(target).c_str());
  return {};
}

}  // namespace anholon
