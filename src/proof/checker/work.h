// The limit of the work of a verification.
#pragma once
#include <cstdint>

namespace anholon::verification {

// The number of operations left to a verification, so that a hostile certificate cannot run for ever.
class Work {
 public:
  bool spend(std::uint64_t n) { return (left_ -= n < left_ ? n : left_) > 0; }
  bool done() const { return left_ == 0; }

 private:
  std::uint64_t left_ = 20'000'000'000;
};

}  // namespace anholon::verification
