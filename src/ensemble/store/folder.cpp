#include "ensemble/store/folder.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <cerrno>
#include <charconv>
#include <csignal>
#include <cstring>
#include <filesystem>
#include <random>

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include "base/diagnostic.h"

namespace anholon {

namespace {

namespace fs = std::filesystem;

constexpr std::string_view kTemporary = ".tmp-";

std::string host() {
  std::array<char, 256> name{};
  if (::gethostname(name.data(), name.size() - 1) != 0) return "unknown";
  std::string out(name.data());
  // '-' separates the parts of the name.
  std::replace(out.begin(), out.end(), '-', '_');
  return out;
}

// Returns .tmp-HOST-PROCESS-NUMBER.
std::string temporary_name() {
  static std::atomic<unsigned> count{0};
  return std::string(kTemporary) + host() + "-" + std::to_string(::getpid()) + "-" + std::to_string(count++) +
         std::to_string(std::random_device{}());
}

bool write_all(int fd, std::string_view bytes) {
  while (!bytes.empty()) {
    const ssize_t n = ::write(fd, bytes.data(), bytes.size());
    if (n < 0 && errno == EINTR) continue;
    if (n <= 0) return false;
    bytes.remove_prefix(static_cast<std::size_t>(n));
  }
  return ::fsync(fd) == 0;
}

void synchronize(const std::string& folder) {
  const int fd = ::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (fd < 0) return;
  ::fsync(fd);
  ::close(fd);
}

}  // namespace

Committed commit_file(const std::string& folder, const std::string& name, std::string_view bytes) {
  const std::string own = folder + "/" + temporary_name(), final = folder + "/" + name;
  const auto failed = [&] {
    const int why = errno;
    ::unlink(own.c_str());
    return Committed{Committed::How::failed, "cannot write " + final + ": " + std::strerror(why)};
  };
  const int fd = ::open(own.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
  if (fd < 0) return failed();
  if (!write_all(fd, bytes)) {
    const int why = errno;
    ::close(fd);
    errno = why;
    return failed();
  }
  if (::close(fd) != 0) return failed();
  const bool linked = ::link(own.c_str(), final.c_str()) == 0;
  const int why = errno;
  // A network file system may report the failure of a link that it made (open(2) on NFS).
  struct stat info{};
  const bool mine = linked || (::stat(own.c_str(), &info) == 0 && info.st_nlink == 2);
  errno = why;
  if (!mine && why != EEXIST) return failed();
  ::unlink(own.c_str());
  synchronize(folder);
  return {mine ? Committed::How::mine : Committed::How::other, {}};
}

std::vector<std::string> files_of(const std::string& folder) {
  std::vector<std::string> names;
  std::error_code why;
  for (fs::directory_iterator it(folder, why), end; !why && it != end; it.increment(why))
    names.push_back(it->path().filename().string());
  if (why) throw Failure({}, "cannot read the folder " + folder + ": " + why.message());
  std::sort(names.begin(), names.end());
  return names;
}

std::size_t clear_unfinished(const std::string& folder) {
  const std::string here = std::string(kTemporary) + host() + "-";
  std::size_t left = 0;
  for (const std::string& name : files_of(folder)) {
    if (!name.starts_with(kTemporary)) continue;
    pid_t process = 0;
    if (name.starts_with(here)) std::from_chars(name.data() + here.size(), name.data() + name.size(), process);
    const bool ended = process > 0 && ::kill(process, 0) != 0 && errno == ESRCH;
    if (!ended || ::unlink((folder + "/" + name).c_str()) != 0) ++left;
  }
  return left;
}

}  // namespace anholon
