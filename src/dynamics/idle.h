// Objects that are expensive to make, and that several callers use one after the other.
#pragma once
#include <mutex>
#include <optional>
#include <vector>

namespace anholon {

// Many threads may use it.
template <class T>
class Idle {
 public:
  // Returns an object that is not in use; nullopt if there is none.
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
