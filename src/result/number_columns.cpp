#include "result/number_columns.h"

#include <algorithm>
#include <new>

#include <sys/mman.h>

#include "base/assert.h"

namespace anholon {

namespace {

// For smaller pieces the heap is faster, and it keeps little memory.
constexpr std::size_t kLeastPages = std::size_t{1} << 20;

}  // namespace

void* take_pages(std::size_t bytes) {
  if (bytes < kLeastPages) return ::operator new(bytes);
  void* place = mmap(nullptr, bytes, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
  if (place == MAP_FAILED) throw std::bad_alloc();
  return place;
}

void free_pages(void* place, std::size_t bytes) {
  if (bytes < kLeastPages)
    ::operator delete(place);
  else
    munmap(place, bytes);
}

NumberColumns::NumberColumns(const std::vector<std::vector<double>>& columns) {
  for (const std::vector<double>& column : columns) push_back(column);
}

void NumberColumns::reset(std::size_t count) {
  block_.reset();
  growing_.assign(count, {});
}

NumberColumns::Growing& NumberColumns::growing(std::size_t k) {
  ANHOLON_ASSERT(!block_);
  return growing_[k];
}

void NumberColumns::push_back(const std::vector<double>& column) {
  ANHOLON_ASSERT(!block_);
  growing_.emplace_back(column.begin(), column.end());
}

void NumberColumns::settle() {
  if (block_ || growing_.empty()) return;
  const std::size_t rows = growing_[0].size(),
                    bytes = std::max<std::size_t>(1, growing_.size() * rows) * sizeof(double);
  double* place = static_cast<double*>(take_pages(bytes));
  std::shared_ptr<const double> block(place, [bytes](double* p) { free_pages(p, bytes); });
  for (Growing& column : growing_) {
    ANHOLON_ASSERT(column.size() == rows);
    place = std::copy(column.begin(), column.end(), place);
    Growing().swap(column);
  }
  settled_ = growing_.size(), rows_ = rows;
  growing_.clear();
  block_ = std::move(block);
}

}  // namespace anholon
