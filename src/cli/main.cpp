// The program anholon.
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <cstring>

#include "base/assert.h"
#include "base/diagnostic.h"
#include "cli/command_line.h"
#include "cli/input.h"
#include "cli/say.h"
#include "motion/code_for_long_runs.h"

using namespace anholon;
using namespace anholon::cli;

namespace {

// Returns the exit status after all output is written: a full disk or a closed pipe turns success into an error.
int finish(int code) {
  const bool written = std::fflush(stdout) == 0 && std::ferror(stdout) == 0;
  if (written || code != kOk) return code;  // the earlier error was already printed
  say(stderr, "error: cannot write the output: %s\n", std::strerror(errno));
  return kBadInput;
}

}  // namespace

int main(int argc, char** argv) {
  set_fault_handler([](const char* file, int line, const char* condition) {
    say(stderr, "%s:%d: internal fault: %s\nplease report this with the model\n", file, line, condition);
    std::_Exit(kFault);
  });
  // A limit on the size of files is an error with a message, like a full disk.
  std::signal(SIGXFSZ, SIG_IGN);
  try {
    const int status = finish(run_command_line(argc, argv));
    if (!compiling_for_nobody()) return status;
    std::fflush(nullptr);
    std::_Exit(status);
  } catch (const UsageError& e) {
    std::fflush(stdout);
    say_lines(stderr, e.text);
    return kBadInput;
  } catch (const Failure& e) {
    // The failure does not concern one element of the file, but the equations made of all elements.
    std::fflush(stdout);
    say(stderr, "error: %s\n", e.what());
    if (!e.diagnostic.hint.empty()) say(stderr, "hint: %s\n", e.diagnostic.hint.c_str());
    return kBadInput;
  } catch (const std::bad_alloc&) {
    say_lines(stderr, "stopped (too_large): out of memory\nhint: the model is too large for this machine\n");
    return kStopped;
  } catch (const std::exception& e) {
    say(stderr, "internal fault: %s\nplease report this with the model\n", e.what());
    return kFault;
  }
}
