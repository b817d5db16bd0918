#include "studio/worker.h"

#include <array>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstdint>
#include <cstring>

#include <fcntl.h>
#include <poll.h>
#include <spawn.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

extern char** environ;

namespace anholon {

namespace {

using Clock = std::chrono::steady_clock;
constexpr std::uint64_t kLongestMessage = 256 << 20;

void append(std::string& out, const std::string& part) {
  const std::uint64_t n = part.size();
  out.append(reinterpret_cast<const char*>(&n), sizeof n).append(part);
}

// Takes the next part off a message; returns false if the message is shorter than its length tells.
bool take(const std::string& from, std::size_t& at, std::string& part) {
  std::uint64_t n = 0;
  if (from.size() - at < sizeof n) return false;
  std::memcpy(&n, from.data() + at, sizeof n);
  at += sizeof n;
  if (from.size() - at < n) return false;
  part.assign(from, at, n);
  at += n;
  return true;
}

// Waits until the pipe is ready. Returns false if time is up or `stop` returns true.
bool wait(int file, short event, Clock::time_point deadline, const std::function<bool()>& stop) {
  for (;;) {
    pollfd p{file, event, 0};
    const int n = poll(&p, 1, 20);
    if (n > 0) return true;
    if (n < 0 && errno != EINTR) return false;
    if (Clock::now() >= deadline || stop()) return false;
  }
}

bool send(int file, const std::string& message, Clock::time_point deadline, const std::function<bool()>& stop) {
  for (std::size_t at = 0; at < message.size();) {
    if (!wait(file, POLLOUT, deadline, stop)) return false;
    const ssize_t n = ::write(file, message.data() + at, std::min<std::size_t>(message.size() - at, 4096));
    if (n < 0 && errno != EINTR && errno != EAGAIN) return false;
    if (n > 0) at += static_cast<std::size_t>(n);
  }
  return true;
}

bool receive(int file, std::string& message, std::size_t size, Clock::time_point deadline,
             const std::function<bool()>& stop) {
  std::array<char, 65536> part;
  while (message.size() < size) {
    if (!wait(file, POLLIN, deadline, stop)) return false;
    const ssize_t n = ::read(file, part.data(), std::min(part.size(), size - message.size()));
    if (n == 0 || (n < 0 && errno != EINTR && errno != EAGAIN)) return false;
    if (n > 0) message.append(part.data(), static_cast<std::size_t>(n));
  }
  return true;
}

bool receive_message(int file, std::string& message, Clock::time_point deadline, const std::function<bool()>& stop) {
  std::string head;
  std::uint64_t n = 0;
  if (!receive(file, head, sizeof n, deadline, stop)) return false;
  std::memcpy(&n, head.data(), sizeof n);
  if (n > kLongestMessage) return false;
  return receive(file, message, n, deadline, stop);
}

}  // namespace

Worker::Worker(std::vector<std::string> command) : command_(std::move(command)) { start(); }
Worker::~Worker() { end(); }

void Worker::start() {
  std::array<int, 2> in{}, out{};
  if (pipe2(in.data(), O_CLOEXEC) != 0) return;
  if (pipe2(out.data(), O_CLOEXEC) != 0) {
    ::close(in[0]), ::close(in[1]);
    return;
  }
  std::vector<char*> words;
  for (const std::string& w : command_) words.push_back(const_cast<char*>(w.c_str()));
  words.push_back(nullptr);
  posix_spawn_file_actions_t files;
  posix_spawnattr_t attributes;
  posix_spawn_file_actions_init(&files);
  posix_spawnattr_init(&attributes);
  posix_spawn_file_actions_adddup2(&files, in[0], 0);
  posix_spawn_file_actions_adddup2(&files, out[1], 1);
  // Ctrl-C is for the studio, which ends its workers; therefore they have a process group of their own.
  sigset_t none;
  sigemptyset(&none);
  posix_spawnattr_setsigmask(&attributes, &none);
  posix_spawnattr_setpgroup(&attributes, 0);
  posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETPGROUP | POSIX_SPAWN_SETSIGMASK);
  const int why = posix_spawn(&child_, words[0], &files, &attributes, words.data(), environ);
  posix_spawnattr_destroy(&attributes);
  posix_spawn_file_actions_destroy(&files);
  ::close(in[0]), ::close(out[1]);
  to_ = in[1], from_ = out[0];
  fcntl(to_, F_SETFL, O_NONBLOCK);
  if (why != 0) child_ = -1, end();
}

void Worker::end() {
  if (child_ > 0) {
    kill(-child_, SIGKILL);
    while (waitpid(child_, nullptr, 0) < 0 && errno == EINTR) continue;
  }
  if (to_ >= 0) ::close(to_);
  if (from_ >= 0) ::close(from_);
  child_ = -1, to_ = from_ = -1;
}

Worker::Answer Worker::ask(const Question& question, double seconds, const std::function<bool()>& give_up) {
  const std::lock_guard<std::mutex> turn(turn_);
  if (give_up()) return {End::given_up, {}};
  if (child_ < 0) start();
  const auto deadline =
      Clock::now() + std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(seconds));
  std::string parts, message;
  for (const std::string* p : {&question.command, &question.name, &question.path, &question.case_name, &question.text})
    append(parts, *p);
  for (const std::string& r : question.readable) append(parts, r);
  append(message, parts);
  Answer answer;
  if (child_ >= 0 && send(to_, message, deadline, give_up) && receive_message(from_, answer.text, deadline, give_up))
    return answer;
  answer.end = give_up() ? End::given_up : Clock::now() >= deadline ? End::out_of_time : End::died;
  answer.text.clear();
  end();
  start();
  return answer;
}

void work(const WorkerLimits& limits, const std::function<std::string(const Question&)>& answer) {
  prctl(PR_SET_PDEATHSIG, SIGKILL, 0, 0, 0);
  for (const auto& [what, most] : {std::pair{RLIMIT_AS, static_cast<rlim_t>(limits.memory)},
                                   std::pair{RLIMIT_FSIZE, rlim_t{0}}, std::pair{RLIMIT_CORE, rlim_t{0}}}) {
    const rlimit limit{most, most};
    setrlimit(what, &limit);
  }
  // Text that a library prints must not be mixed with the answers.
  const int out = fcntl(1, F_DUPFD_CLOEXEC, 3), nothing = ::open("/dev/null", O_WRONLY | O_CLOEXEC);
  if (out < 0 || nothing < 0) return;
  dup2(nothing, 1);
  const auto never = [] { return false; };
  const auto end_of_time = Clock::time_point::max();
  for (;;) {
    std::string message, part;
    if (!receive_message(0, message, end_of_time, never)) return;
    Question q;
    std::size_t at = 0;
    for (std::string* p : {&q.command, &q.name, &q.path, &q.case_name, &q.text})
      if (!take(message, at, *p)) return;
    while (take(message, at, part)) q.readable.push_back(part);
    std::string reply;
    append(reply, answer(q));
    if (!send(out, reply, end_of_time, never)) return;
  }
}

}  // namespace anholon
