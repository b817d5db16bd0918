#include "result/hdf5/hdf5_sink.h"

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

namespace anholon {

// Rows are written to the copy when there are this many bytes, so that the disk works while the motion goes on.
static constexpr std::size_t kAhead = 4u << 20;
// The limit of stored steps of a run; later steps are not written.
static constexpr std::size_t kMostSteps = 5'000'000;

Hdf5Sink::Hdf5Sink(std::string path, RunInfo info, Pace pace)
    : path_(std::move(path)), target_(target_of_link(path_)), beside_(target_ + ".part"), info_(std::move(info)),
      pace_(pace) {
  error_ = has_hdf5() ? obstacle_to_writing(path_) : kNoHdf5;
  if (!error_.empty()) return;
  claim_.emplace(path_);
  error_ = claim_->error();
}

Hdf5Sink::~Hdf5Sink() {
  close({});
  if (last_ >= 0) ::close(last_);
}

void Hdf5Sink::go_on(const RunFile& before, std::size_t rows, std::size_t steps) {
  block_.add(before.table, 0, std::min(rows, before.table.rows()));
  names_before_ = before.table.columns;
  block_.steps.assign(before.steps.begin(),
                      before.steps.begin() + static_cast<std::ptrdiff_t>(std::min(steps, before.steps.size())));
  steps_ = block_.steps.size();
}

void Hdf5Sink::columns(const std::vector<RunColumn>& columns) {
  names_ = names_of(columns);
  if (!names_before_.empty() && names_before_ != names_) block_.clear(), steps_ = 0;
  begun_ = true;
  checkpoint();
}

void Hdf5Sink::row(const Row& row) {
  if (!error_.empty()) return;
  block_.add(row);
  if (ahead_.bytes + block_.bytes() >= std::max(pace_.bytes, size_ / 4) || std::chrono::steady_clock::now() >= next_)
    checkpoint();
  else if (block_.bytes() >= kAhead)
    extend();
}

void Hdf5Sink::step(double t) {
  if (error_.empty() && steps_ < kMostSteps) block_.steps.push_back(t), ++steps_;
}

void Hdf5Sink::flush() {
  if (begun_ && (block_.bytes() > 0 || ahead_.begun)) checkpoint();
}

std::string Hdf5Sink::close(const std::string& report) {
  if (!closed_ && !report.empty()) block_.report = report;
  if (!closed_ && begun_ && (block_.bytes() > 0 || block_.report || ahead_.begun)) checkpoint();
  closed_ = true;
  return error_;
}

bool Hdf5Sink::fail(const std::string& why) {
  error_ = "cannot write " + path_ + ": " + why;
  std::remove(beside_.c_str());
  return false;
}

// Space for the new data is allocated before HDF5 opens the file: HDF5 does not handle a full disk well.
static bool allocate(int fd, std::size_t at, std::size_t room) {
  return ::fallocate(fd, FALLOC_FL_KEEP_SIZE, static_cast<off_t>(at), static_cast<off_t>(room)) == 0 ||
         errno == EOPNOTSUPP || errno == ENOSYS || errno == EINTR;
}

bool Hdf5Sink::make_room(std::size_t room) {
  const int fd = ::open(beside_.c_str(), O_WRONLY | O_NOFOLLOW | O_CLOEXEC);
  struct stat info{};
  const bool made = fd >= 0 && ::fstat(fd, &info) == 0 && allocate(fd, static_cast<std::size_t>(info.st_size), room);
  const int why = errno;
  if (fd >= 0) ::close(fd);
  return made || fail(std::strerror(why));
}

bool Hdf5Sink::copy_last(const std::string& to, std::size_t room) {
  const int out = ::open(to.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_NOFOLLOW | O_CLOEXEC, 0666);
  if (out < 0) return fail(std::strerror(errno));
  const auto failed = [&] {
    const int why = errno;
    ::close(out);
    return fail(std::strerror(why));
  };
  if (!allocate(out, 0, size_ + room)) return failed();
  off_t at = 0;
  bool by_kernel = true;
  std::vector<char> buffer;
  while (static_cast<std::size_t>(at) < size_) {
    if (by_kernel) {
      off_t in = at;
      const ssize_t n = ::copy_file_range(last_, &in, out, nullptr, size_ - static_cast<std::size_t>(at), 0);
      if (n > 0) {
        at = in;
        continue;
      }
      // Between some file systems, and on old kernels, the call is not supported.
      if (n < 0 && errno == ENOSPC) return failed();
      by_kernel = false;
    }
    buffer.resize(1u << 20);
    const ssize_t n = ::pread(last_, buffer.data(), std::min(buffer.size(), size_ - static_cast<std::size_t>(at)), at);
    if (n < 0 && errno == EINTR) continue;
    if (n == 0) errno = EIO;
    if (n <= 0) return failed();
    for (ssize_t k = 0; k < n;) {
      const ssize_t w = ::pwrite(out, buffer.data() + k, static_cast<std::size_t>(n - k), at + k);
      if (w < 0 && errno != EINTR) return failed();
      if (w > 0) k += w;
    }
    at += n;
  }
  if (::close(out) != 0) return fail(std::strerror(errno));
  return true;
}

// Adds the waiting rows to the copy of the last complete file.
bool Hdf5Sink::extend() {
  // New chunks of every data set, the directory of chunks, and the texts.
  constexpr std::size_t kMargin = 1u << 20;
  std::size_t texts = 0;
  for (const RunInfo::File& f : info_.model) texts += f.text.size();
  const std::size_t room =
      kMargin + block_.bytes() + block_.bytes() / 8 + 2 * texts + (block_.report ? block_.report->size() : 0);
  if (!(ahead_.begun ? make_room(room) : copy_last(beside_, room))) return false;
  if (last_ < 0 && !ahead_.begun)
    if (const std::string why = create_hdf5(beside_, info_, names_); !why.empty()) return fail(why);
  if (const std::string why = extend_hdf5(beside_, block_); !why.empty()) return fail(why);
  ahead_ = {true, ahead_.rows + block_.rows(), ahead_.bytes + block_.bytes()};
  block_.clear();
  start_writing(beside_);
  return true;
}

void Hdf5Sink::checkpoint() {
  if (!error_.empty() || !begun_) return;
  const auto start = std::chrono::steady_clock::now();
  if (!extend()) return;
  const int fd = ::open(beside_.c_str(), O_RDWR | O_CLOEXEC);
  struct stat info{};
  // Gives back unused space; rows are on disk before the name appears.
  const bool without_rows = last_ < 0 && ahead_.rows == 0;
  if (fd < 0 || ::fstat(fd, &info) != 0 || ::ftruncate(fd, info.st_size) != 0 ||
      (!without_rows && ::fdatasync(fd) != 0) || std::rename(beside_.c_str(), target_.c_str()) != 0) {
    const int why = errno;
    if (fd >= 0) ::close(fd);
    return static_cast<void>(fail(std::strerror(why)));
  }
  if (last_ >= 0) ::close(last_);
  last_ = fd;
  size_ = static_cast<std::size_t>(info.st_size);
  written_ += ahead_.rows;
  ahead_ = {};
  const auto end = std::chrono::steady_clock::now();
  next_ = end + std::chrono::duration_cast<std::chrono::steady_clock::duration>(std::chrono::duration<double>(
                    std::max(pace_.seconds, pace_.share * std::chrono::duration<double>(end - start).count())));
}

}  // namespace anholon
