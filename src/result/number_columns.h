// Columns of numbers of the same length, which lie side by side in one block of memory once they are settled.
//
// While rows come in, each column grows by itself. settle() moves the columns into the block one by one and frees each
// as soon as it is moved, so memory never holds all numbers twice. Copies of settled columns share the block, which
// does not change; threads may read it.
#pragma once
#include <cstddef>
#include <memory>
#include <span>
#include <vector>

namespace anholon {

// Takes large pieces of memory from the system and gives them back when they are freed: otherwise a column that has
// moved would stay in the heap.
void* take_pages(std::size_t bytes);
void free_pages(void* place, std::size_t bytes);

template <class T>
struct PageAllocator {
  using value_type = T;
  PageAllocator() = default;
  template <class U>
  PageAllocator(const PageAllocator<U>&) {}
  T* allocate(std::size_t n) { return static_cast<T*>(take_pages(n * sizeof(T))); }
  void deallocate(T* place, std::size_t n) { free_pages(place, n * sizeof(T)); }
  friend bool operator==(const PageAllocator&, const PageAllocator&) { return true; }
};

class NumberColumns {
 public:
  using Growing = std::vector<double, PageAllocator<double>>;

  NumberColumns() = default;
  NumberColumns(const std::vector<std::vector<double>>& columns);

  std::size_t size() const { return block_ ? settled_ : growing_.size(); }
  bool empty() const { return size() == 0; }
  std::size_t rows() const { return block_ ? rows_ : growing_.empty() ? 0 : growing_[0].size(); }
  // The numbers of column k.
  std::span<const double> operator[](std::size_t k) const {
    return block_ ? std::span<const double>(block_.get() + k * rows_, rows_) : std::span<const double>(growing_[k]);
  }
  // Replaces all columns by `count` empty ones.
  void reset(std::size_t count);
  // A column that takes further numbers. REQUIRES: not settled.
  Growing& growing(std::size_t k);
  // Adds a column. REQUIRES: not settled.
  void push_back(const std::vector<double>& column);
  // Moves the numbers into one block. REQUIRES: all columns have the same length.
  void settle();
  // All columns one after the other; empty before settle().
  std::span<const double> block() const { return {block_.get(), block_ ? settled_ * rows_ : 0}; }

 private:
  std::vector<Growing> growing_;
  std::shared_ptr<const double> block_;
  std::size_t settled_ = 0, rows_ = 0;  // size of the block
};

}  // namespace anholon
