// A separate process for computations: a text that needs too much time or memory ends this process, not the studio.
//
// Questions and answers go through two pipes, each as its length followed by its bytes.
#pragma once
#include <atomic>
#include <functional>
#include <mutex>
#include <string>
#include <vector>

#include <sys/types.h>

namespace anholon {

// A question to the worker. `name` and `path`: of the model's file; `case_name`: a case of the text, or empty;
// `readable`: the files to which the text may refer, under the names in the text.
struct Question {
  std::string command, name, path, case_name, text;
  std::vector<std::string> readable;
};

struct WorkerLimits {
  double seconds = 20;                        // for each question
  std::size_t memory = std::size_t{4} << 30;  // bytes of address space
};

class Worker {
 public:
  // `command`: the command line of the program that makes a process into a worker.
  explicit Worker(std::vector<std::string> command);
  ~Worker();
  Worker(const Worker&) = delete;
  Worker& operator=(const Worker&) = delete;

  enum class End : std::uint8_t { answered, out_of_time, given_up, died };
  struct Answer {
    End end = End::answered;
    std::string text;  // JSON
  };
  // Waits for its turn and asks. `give_up` is called repeatedly; the process is ended if it returns true. A process
  // that was ended is replaced at once, so that the next question finds one that is ready.
  Answer ask(const Question& question, double seconds, const std::function<bool()>& give_up);

 private:
  void start();
  void end();
  std::vector<std::string> command_;
  std::mutex turn_;
  pid_t child_ = -1;
  int to_ = -1, from_ = -1;
};

// The other side: reads questions from the standard input and answers on the standard output until the input ends.
// Limits the memory of this process and forbids it to write files.
void work(const WorkerLimits& limits, const std::function<std::string(const Question&)>& answer);

}  // namespace anholon
