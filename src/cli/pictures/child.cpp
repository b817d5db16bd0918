#include "cli/pictures/child.h"

#include <fcntl.h>
#include <poll.h>
#include <spawn.h>
#include <sys/wait.h>
#ifdef __linux__
#include <sys/prctl.h>
#endif
#include <array>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <thread>

#include <unistd.h>

#include "cli/input.h"

extern char** environ;

namespace anholon::cli {

namespace {

constexpr std::size_t kMostErrors = 16384;

struct Pipe {
  int read = -1, write = -1;
  bool open() {
    std::array<int, 2> ends{};
    // Other children do not inherit the pipe; posix_spawn's copy is inherited.
    if (pipe2(ends.data(), O_CLOEXEC) != 0) return false;
    read = ends[0], write = ends[1];
    return true;
  }
  void close_write() {
    if (write >= 0) ::close(write), write = -1;
  }
  void close_read() {
    if (read >= 0) ::close(read), read = -1;
  }
  ~Pipe() { close_write(), close_read(); }
};

// Appends to `into` the bytes that the pipe holds. Returns false at the end of the stream.
bool take(int from, std::string& into) {
  std::array<char, 65536> part;
  const ssize_t n = ::read(from, part.data(), part.size());
  if (n < 0) return errno == EINTR || errno == EAGAIN;
  into.append(part.data(), static_cast<std::size_t>(n));
  return n > 0;
}

int spawn(const std::vector<std::string>& arguments, const Pipe& out, const Pipe& err, pid_t& pid) {
  std::vector<char*> words;
  for (const std::string& a : arguments) words.push_back(const_cast<char*>(a.c_str()));
  words.push_back(nullptr);
  posix_spawn_file_actions_t files;
  posix_spawnattr_t attributes;
  posix_spawn_file_actions_init(&files);
  posix_spawnattr_init(&attributes);
  posix_spawn_file_actions_addopen(&files, 0, "/dev/null", O_RDONLY, 0);
  posix_spawn_file_actions_adddup2(&files, out.write, 1);
  posix_spawn_file_actions_adddup2(&files, err.write, 2);
  // Signals that this program ignores or catches have their default action in the child.
  sigset_t usual, none;
  sigemptyset(&usual);
  sigemptyset(&none);
  for (const int s : {SIGINT, SIGTERM, SIGXFSZ, SIGPIPE}) sigaddset(&usual, s);
  posix_spawnattr_setsigdefault(&attributes, &usual);
  posix_spawnattr_setsigmask(&attributes, &none);
  posix_spawnattr_setpgroup(&attributes, 0);
  posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETPGROUP | POSIX_SPAWN_SETSIGDEF | POSIX_SPAWN_SETSIGMASK);
  const int why = posix_spawnp(&pid, words[0], &files, &attributes, words.data(), environ);
  posix_spawnattr_destroy(&attributes);
  posix_spawn_file_actions_destroy(&files);
  return why;
}

// Processes whose parent ends become children of this process, which waits for them; on systems without this option
// they go to init.
class Foster {
 public:
#ifdef __linux__
  Foster() { prctl(PR_GET_CHILD_SUBREAPER, &before_, 0, 0, 0), prctl(PR_SET_CHILD_SUBREAPER, 1, 0, 0, 0); }
  ~Foster() { prctl(PR_SET_CHILD_SUBREAPER, before_, 0, 0, 0); }

 private:
  int before_ = 0;
#else
  Foster() {}
  ~Foster() {}
#endif
};

}  // namespace

Child run_child(const std::vector<std::string>& arguments, double seconds, const std::function<bool()>& stop,
                std::size_t most_output) {
  using Clock = std::chrono::steady_clock;
  Child child;
  Pipe out, err;
  pid_t pid = -1;
  const auto not_started = [&](int why) {
    child.end = Child::End::not_started;
    child.status = why;
    return child;
  };
  if (!out.open() || !err.open()) return not_started(errno);
  const Foster foster;
  if (const int why = spawn(arguments, out, err, pid); why != 0) return not_started(why);
  out.close_write(), err.close_write();

  const auto deadline =
      Clock::now() + std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(seconds));
  int status = 0;
  bool ended = false;
  while (!ended) {
    std::array<pollfd, 2> streams{pollfd{out.read, POLLIN, 0},
                                  pollfd{err.read, POLLIN, 0}};  // a closed one is -1, which poll skips
    poll(streams.data(), streams.size(), 100);
    if (streams[0].revents != 0 && !take(out.read, child.out)) out.close_read();
    if (streams[1].revents != 0 && !take(err.read, child.err)) err.close_read();
    if (child.err.size() > 2 * kMostErrors) child.err.erase(0, child.err.size() - kMostErrors);
    // Children of the child may keep the streams open after it ends.
    ended = waitpid(pid, &status, WNOHANG) == pid;
    if (ended) break;
    if (out.read < 0 && err.read < 0) std::this_thread::sleep_for(std::chrono::milliseconds(20));
    if (stop && stop())
      child.end = Child::End::stopped;
    else if (Clock::now() > deadline)
      child.end = Child::End::out_of_time;
    else if (child.out.size() > most_output)
      child.end = Child::End::too_much;
    if (child.end != Child::End::exited) break;
  }
  kill(-pid, SIGKILL);
  if (!ended)
    while (waitpid(pid, &status, 0) < 0 && errno == EINTR) continue;
  while (waitpid(-pid, nullptr, 0) > 0 || errno == EINTR) continue;
  // Reads the output that the child printed before it ended; it is still in the pipes.
  for (Pipe* p : {&out, &err})
    if (p->read >= 0) {
      fcntl(p->read, F_SETFL, O_NONBLOCK);
      std::string& into = p == &out ? child.out : child.err;
      for (std::size_t before = into.size() + 1; before != into.size() && into.size() <= most_output + kMostErrors;) {
        before = into.size();
        if (!take(p->read, into)) break;
      }
    }
  child.status = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
  return child;
}

std::string find_program(const std::vector<std::string>& names) {
  const auto runs = [](const std::filesystem::path& p) {
    std::error_code none;
    return std::filesystem::is_regular_file(p, none) && access(p.c_str(), X_OK) == 0;
  };
  const char* path = std::getenv("PATH");
  for (const std::string& name : names) {
    if (name.empty()) continue;
    if (name.find('/') != std::string::npos) {
      if (runs(name)) return name;
      continue;
    }
    const std::string folders = path ? path : "/usr/local/bin:/usr/bin:/bin";
    for (std::size_t at = 0; at <= folders.size();) {
      const std::size_t end = std::min(folders.find(':', at), folders.size());
      const std::filesystem::path file = std::filesystem::path(end > at ? folders.substr(at, end - at) : ".") / name;
      if (runs(file)) return file.string();
      at = end + 1;
    }
  }
  return "";
}

TemporaryFolder::TemporaryFolder() {
  std::error_code error;
  const std::filesystem::path below = std::filesystem::temp_directory_path(error);
  std::string name = ((error ? std::filesystem::path("/tmp") : below) / "anholon-XXXXXX").string();
  if (!mkdtemp(name.data()))
    throw UsageError{"error: no temporary folder can be made: " + std::string(std::strerror(errno)) +
                     "\nhint: TMPDIR names the place for it\n"};
  path_ = name;
}

TemporaryFolder::~TemporaryFolder() {
  std::error_code ignored;
  std::filesystem::remove_all(path_, ignored);
  // A browser's last process may still have been writing.
  if (std::filesystem::exists(path_, ignored)) {
    std::this_thread::sleep_for(std::chrono::milliseconds(200));
    std::filesystem::remove_all(path_, ignored);
  }
}

}  // namespace anholon::cli
