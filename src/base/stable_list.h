// A list that grows at its end and whose elements never move.
#pragma once
#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <memory>
#include <span>
#include <utility>

namespace anholon {

// A reference or a span of elements is valid as long as the list. Block k holds 2^k times as many elements as the first
// one; an element is found from the highest bit of its index.
template <class T>
class StableList {
 public:
  std::size_t size() const { return size_; }
  const T& operator[](std::size_t i) const {
    const std::size_t at = i + kFirst;
    const auto block = static_cast<std::size_t>(std::bit_width(at)) - kFirstWidth;
    return blocks_[block][at - (kFirst << block)];
  }

  void push_back(T value) {
    room(1) = std::move(value);
    ++size_;
  }

  // Appends `values` side by side and returns the index of the first one. If the last block has too little room for
  // them, the rest of the block stays empty.
  std::size_t append(std::span<const T> values) {
    if (values.empty()) return size_;
    std::copy(values.begin(), values.end(), &room(values.size()));
    const std::size_t first = size_;
    size_ += values.size();
    return first;
  }

  // Returns the `count` elements from `first` on. REQUIRES: one call of `append` has added them.
  std::span<const T> part(std::size_t first, std::size_t count) const {
    return count == 0 ? std::span<const T>() : std::span<const T>(&(*this)[first], count);
  }

  // Makes this list a copy of the first `count` elements of another one; elements that are side by side there are so
  // here.
  void assign(const StableList& other, std::size_t count) {
    for (std::size_t k = 0; k < kBlocks; ++k) {
      const std::size_t start = start_of(k), end = std::min(count, start_of(k + 1));
      blocks_[k].reset();
      if (start >= end || !other.blocks_[k]) continue;  // a long part may have left out a block
      blocks_[k] = std::make_unique<T[]>(kFirst << k);
      std::copy_n(other.blocks_[k].get(), end - start, blocks_[k].get());
    }
    size_ = count;
  }

 private:
  static constexpr std::size_t kFirstWidth = 7, kFirst = std::size_t{1} << (kFirstWidth - 1), kBlocks = 33;

  static std::size_t start_of(std::size_t block) { return (kFirst << block) - kFirst; }

  // Returns the first element of room for `count` elements side by side; `size_` is its index afterwards.
  T& room(std::size_t count) {
    auto block = static_cast<std::size_t>(std::bit_width(size_ + kFirst)) - kFirstWidth;
    while (size_ + count > start_of(block + 1)) size_ = start_of(++block);
    if (!blocks_[block]) blocks_[block] = std::make_unique<T[]>(kFirst << block);
    return blocks_[block][size_ - start_of(block)];
  }

  std::array<std::unique_ptr<T[]>, kBlocks> blocks_;
  std::size_t size_ = 0;
};

}  // namespace anholon
