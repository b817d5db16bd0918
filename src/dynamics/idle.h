// Objects that are expensive to make, of which one caller after the other uses one.
#pragma once
#include <mutex>
#include <optional>
#include <vector>

namespace anholon {

// May be used by many threads.
template <class T>
class Idle {
 public:
  // An object that nobody uses now; nullopt if there is none.
  std::optional<T> take() {
    const std::lock_guard lock(mutex_);
    if (list_.empty()) return std::nullopt;
    std::optional<T> one(std::move(list_.back()));
    list_.pop_back();
    return one;
  }
  void give_back(T one) {
    const std::lock_guard lock(mutex_);
    list_.push_back(std::move(one));
  }

 private:
  std::mutex mutex_;
  std::vector<T> list_;
};

}  // namespace anholon
