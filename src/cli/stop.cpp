#include "cli/stop.h"

#include <csignal>

namespace anholon::cli {

static volatile std::sig_atomic_t stop_flag = 0;
extern "C" {
static void request_stop(int) { stop_flag = 1; }
}

void catch_stop(const std::string& output) {
  std::signal(SIGINT, request_stop);
  std::signal(SIGTERM, request_stop);
  // Keeps the handler that nohup has set.
  if (std::signal(SIGHUP, request_stop) == SIG_IGN) std::signal(SIGHUP, SIG_IGN);
  if (!output.empty() && output != "-") std::signal(SIGPIPE, SIG_IGN);
}

bool stop_requested() { return stop_flag != 0; }

}  // namespace anholon::cli
