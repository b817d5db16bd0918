// Progress of long commands.
#pragma once
#include <chrono>
#include <cstddef>

namespace anholon::cli {

// Progress on stderr: a bar on a terminal, a plain line each ten per cent elsewhere.
class Progress {
 public:
  // `where`: name of the position ("t"); `unit`: name of the counted things ("steps").
  Progress(bool quiet, const char* where, const char* unit);
  ~Progress();
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;
  // `fraction` of the whole is done.
  void operator()(double fraction, double place, std::size_t count);

 private:
  bool quiet_, terminal_, any_ = false;
  const char *where_, *unit_;
  double next_line_ = 0;
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now(), shown_ = start_;
};

}  // namespace anholon::cli
