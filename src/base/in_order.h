// Work on blocks in the order in which they are filled, by the thread that fills them or by another thread in parallel.
//
// The results do not depend on which thread works, because the order is the same. An exception of the work is thrown
// again in the thread that fills the blocks.
#pragma once
#include <condition_variable>
#include <exception>
#include <functional>
#include <mutex>
#include <system_error>
#include <thread>
#include <utility>
#include <vector>

namespace anholon {

template <class Block>
class InOrder {
 public:
  // `blocks`: their number is that of the blocks under way, including the one that is being filled. `work` leaves a
  // block in a state in which it can be filled again.
  InOrder(std::vector<Block> blocks, std::function<void(Block&)> work)
      : blocks_(std::move(blocks)), work_(std::move(work)) {}
  // Blocks that wait for the other thread are dropped.
  ~InOrder() {
    if (!thread_.joinable()) return;
    {
      const std::lock_guard lock(lock_);
      stops_ = true;
    }
    more_.notify_one();
    thread_.join();
  }
  InOrder(const InOrder&) = delete;
  InOrder& operator=(const InOrder&) = delete;

  Block& filling() { return blocks_[filled_ % blocks_.size()]; }
  // Works on the filled block, or passes it to the other thread, and waits while that thread has no free block.
  void pass_on() {
    if (!thread_.joinable()) return work_(filling());
    std::unique_lock lock(lock_);
    ++filled_;
    more_.notify_one();
    done_something_.wait(lock, [&] { return filled_ - done_ < blocks_.size(); });
    rethrow();
  }
  // Waits until all blocks that were passed on are done.
  void settle() {
    if (!thread_.joinable()) return;
    std::unique_lock lock(lock_);
    done_something_.wait(lock, [&] { return filled_ == done_; });
    rethrow();
  }
  // Lets another thread work from now on, if the machine has another core and a thread for it.
  void work_beside() {
    if (thread_.joinable() || alone_) return;
    alone_ = std::thread::hardware_concurrency() < 2;
    if (alone_) return;
    try {
      thread_ = std::thread([this] { work(); });
    } catch (const std::system_error&) {
      alone_ = true;
    }
  }

 private:
  void rethrow() {
    if (thrown_) std::rethrow_exception(std::exchange(thrown_, nullptr));
  }
  void work() {
    std::unique_lock lock(lock_);
    for (;;) {
      more_.wait(lock, [&] { return stops_ || done_ < filled_; });
      if (stops_) return;
      Block& block = blocks_[done_ % blocks_.size()];
      lock.unlock();
      std::exception_ptr thrown;
      try {
        work_(block);
      } catch (...) {
        thrown = std::current_exception();
      }
      lock.lock();
      if (thrown && !thrown_) thrown_ = thrown;
      ++done_;
      done_something_.notify_one();
    }
  }

  std::vector<Block> blocks_;
  std::function<void(Block&)> work_;
  bool alone_ = false;  // no other thread is available
  std::mutex lock_;     // guards the members below; filled_ changes only in the filling thread
  std::condition_variable more_, done_something_;
  std::size_t filled_ = 0, done_ = 0;
  bool stops_ = false;
  std::exception_ptr thrown_;
  std::thread thread_;
};

}  // namespace anholon
