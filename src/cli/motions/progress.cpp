#include "cli/motions/progress.h"

#include <algorithm>
#include <string>

#include <unistd.h>

#include "cli/say.h"

namespace anholon::cli {

Progress::Progress(bool quiet, const char* where, const char* unit)
    : quiet_(quiet), terminal_(isatty(2) != 0), where_(where), unit_(unit) {}

void Progress::operator()(double fraction, double place, std::size_t count) {
  if (quiet_) return;
  const auto now = std::chrono::steady_clock::now();
  const double elapsed = std::chrono::duration<double>(now - start_).count();
  if (elapsed < 0.5 || std::chrono::duration<double>(now - shown_).count() < (terminal_ ? 0.1 : 1.0)) return;
  const double done = std::clamp(fraction, 0.0, 1.0);
  const double left = done > 0 ? elapsed * (1 - done) / done : 0;
  if (!terminal_ && done < next_line_) return;
  next_line_ = done + 0.1;
  shown_ = now;
  any_ = terminal_;
  const int bar = static_cast<int>(done * 30);
  const std::string filled(static_cast<std::size_t>(bar), '#'), empty(static_cast<std::size_t>(30 - bar), '.');
  if (terminal_) say(stderr, "\r");
  say(stderr, "[%s%s] %3.0f %%  %s = %.6g  %.3g %s/s  %.0f s left", filled.c_str(), empty.c_str(), 100 * done, where_,
      place, static_cast<double>(count) / elapsed, unit_, left);
  say(stderr, terminal_ ? "\033[K" : "\n");
}

Progress::~Progress() {
  if (any_) say(stderr, "\r\033[K");
}

}  // namespace anholon::cli
