// Computations of the studio: a worker answers the question of a page, and a newer question of the same page ends it.
#pragma once
#include <array>
#include <atomic>
#include <map>
#include <mutex>
#include <string>
#include <vector>

#include "studio/http.h"
#include "studio/worker.h"

namespace anholon {

// A kind of question, and its limit of time.
struct Task {
  const char* name;
  double seconds;
  bool brief = false;  // does not wait for motions
};

// Makes a reply of JSON.
HttpReply json_reply(std::string body, int status = 200);
// Returns the JSON of an error without a place.
std::string trouble(const std::string& text, const std::string& hint);

// The newest edition of each page of a browser: the computation of an older one is given up.
class Editions {
 public:
  // Returns the worker of the edition, 0 or 1. A new edition gets the other worker, so that it does not have to wait
  // until the process of the older edition is replaced.
  std::size_t seen(const std::string& page, unsigned long long edition);
  bool is_old(const std::string& page, unsigned long long edition);

 private:
  static constexpr std::size_t kMostPages = 1000;
  std::mutex turn_;
  struct Newest {
    unsigned long long edition = 0;
    std::size_t worker = 0;
  };
  std::map<std::string, Newest> newest_;
};

class Computing {
 public:
  // `worker`: the command line of the program that makes a process into a worker.
  explicit Computing(const std::vector<std::string>& worker)
      : checker_(worker), movers_{Worker(worker), Worker(worker)} {}
  // Many threads may call these functions. `request`: contains the page and the edition of the question.
  HttpReply answer(const Task& task, const HttpRequest& request, const Question& question);
  // Answers a question that no other one ends.
  HttpReply answer(const Task& task, const Question& question);
  void stop() { stopping_ = true; }

 private:
  static HttpReply reply(const Task& task, const Worker::Answer& answer);
  Worker checker_;  // of brief tasks
  std::array<Worker, 2> movers_;
  Editions editions_;
  std::atomic<bool> stopping_{false};
};

}  // namespace anholon
