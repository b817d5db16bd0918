// What long commands show on their way, and how they are told to stop.
#pragma once
#include <chrono>
#include <cstddef>
#include <string>

namespace anholon::cli {

// From here on Ctrl-C, a request of the system to end and a terminal that goes away are requests, which any thread may
// ask about. Where the rows go to a file, nobody who leaves the other outputs ends the run.
void catch_stop(const std::string& output);
bool stop_requested();

// Progress on stderr: a bar on a terminal, a plain line each ten per cent elsewhere.
class Progress {
 public:
  // `where`: what the place is called ("t"); `unit`: what is counted ("steps").
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
