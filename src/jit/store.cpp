#include "jit/store.h"

#include <algorithm>
#include <chrono>
#include <cstring>
#include <filesystem>
#include <system_error>
#include <vector>

#include <fcntl.h>
#include <unistd.h>

#include "jit/trust.h"

namespace anholon::jit {

namespace {

namespace fs = std::filesystem;

constexpr std::uintmax_t kMost = 256U << 20,
                         // bytes; entries are removed down to this size, so that there is room for a while
    kEnough = kMost / 4 * 3;
constexpr char kPrefix[] = "kernel-";
// A partial entry this old belongs to a process that was killed.
constexpr std::chrono::hours kAbandoned{1};
// The time of last use is updated at most this often.
constexpr std::chrono::hours kUsed{24};

struct Descriptor {
  explicit Descriptor(int n) : number(n) {}
  Descriptor(const Descriptor&) = delete;
  ~Descriptor() {
    if (number >= 0) close(number);
  }
  int number;
};

// The seal after the object file shows that the file was written completely, for this key.
Key seal(const Key& key, llvm::StringRef object) {
  Writer w;
  w.add(key);
  w.add(hash(object));
  return w.key();
}

bool write_all(int file, llvm::StringRef bytes) {
  while (!bytes.empty()) {
    const ssize_t n = ::write(file, bytes.data(), bytes.size());
    if (n < 0 && errno == EINTR) continue;
    if (n <= 0) return false;
    bytes = bytes.drop_front(static_cast<std::size_t>(n));
  }
  return true;
}

fs::path path_of(const std::string& folder, const Key& key) { return fs::path(folder) / (kPrefix + key.text() + ".o"); }

}  // namespace

std::unique_ptr<llvm::MemoryBuffer> Store::read(const Key& key) const {
  if (folder_.empty()) return nullptr;
  const fs::path path = path_of(folder_, key);
  // The entry may be anything: a pipe must not block, and a link may lead to files of others.
  const Descriptor file(open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK | O_NOFOLLOW));
  struct stat about;
  if (file.number < 0 || fstat(file.number, &about) != 0 || !trusted(about, geteuid())) return nullptr;
  const auto size = static_cast<std::uint64_t>(about.st_size);
  if (size <= sizeof(Key) || size > kMost) return nullptr;
  // The file is read as volatile and with a zero at its end: otherwise a large file is mapped, and if a mapped file is
  // truncated the reader is killed.
  auto all = llvm::MemoryBuffer::getOpenFile(file.number, path.c_str(), size, true, true);
  if (!all || (*all)->getBufferSize() != size) return nullptr;
  const llvm::StringRef object = (*all)->getBuffer().drop_back(sizeof(Key));
  Key found;
  std::memcpy(&found, object.end(), sizeof found);
  if (!(found == seal(key, object))) return nullptr;
  std::error_code none;
  const auto now = fs::file_time_type::clock::now();
  if (const auto last = fs::last_write_time(path, none); !none && now - last > kUsed)
    fs::last_write_time(path, now, none);
  return llvm::MemoryBuffer::getMemBufferCopy(object, "kernel");
}

void Store::write(const Key& key, const llvm::MemoryBuffer& object) const {
  if (folder_.empty()) return;
  std::error_code none;
  fs::create_directories(folder_, none);
  const fs::path path = path_of(folder_, key);
  std::string part = path.string() + ".XXXXXX";
  const Key end = seal(key, object.getBuffer());
  bool good = false;
  {
    const Descriptor file(mkostemp(part.data(), O_CLOEXEC));
    if (file.number < 0) return;
    good = write_all(file.number, object.getBuffer()) &&
           write_all(file.number, {reinterpret_cast<const char*>(&end), sizeof end});
  }
  if (good) fs::rename(part, path, none);
  if (!good || none)
    fs::remove(part, none);
  else
    bound();
}

void Store::bound() const {
  struct Entry {
    fs::file_time_type used;
    std::uintmax_t size;
    fs::path path;
  };
  std::vector<Entry> entries;
  std::uintmax_t total = 0;
  std::error_code none, bad;
  const auto now = fs::file_time_type::clock::now();
  for (fs::directory_iterator it(folder_, none), end; !none && it != end; it.increment(none)) {
    // Foreign files are neither counted nor touched.
    const std::string name = it->path().filename().string();
    if (name.rfind(kPrefix, 0) != 0 || !it->is_regular_file(bad)) continue;
    const auto used = it->last_write_time(bad);
    if (bad) continue;
    const std::uintmax_t size = it->file_size(bad);
    if (bad) continue;
    if (it->path().extension() != ".o" && now - used > kAbandoned)
      fs::remove(it->path(), bad);
    else
      entries.push_back({used, size, it->path()}), total += size;
  }
  if (total <= kMost) return;
  std::sort(entries.begin(), entries.end(), [](const Entry& a, const Entry& b) { return a.used < b.used; });
  for (const Entry& e : entries) {
    if (total <= kEnough) break;
    if (fs::remove(e.path, bad)) total -= e.size;
  }
}

}  // namespace anholon::jit
