// Loops over many states on several threads, which a StopScope can end.
#pragma once
#include <algorithm>
#include <atomic>
#include <exception>
#include <functional>
#include <optional>
#include <thread>
#include <vector>

#include "base/stop.h"

namespace anholon {

using NextPiece =
    std::function<std::optional<std::size_t>()>;  // the first state of a piece; nullopt after the last one

// Calls work(next) in this thread, and in others if there are many pieces of `size` states; together they take all
// pieces of `count` states. If work throws in one of the threads, the others take no further piece, and the exception
// is thrown once they have ended. StopRequested, which comes from a StopScope of this thread, is such an exception.
template <class Work>
void in_pieces(std::size_t count, std::size_t size, const Work& work) {
  std::atomic<std::size_t> first = 0;
  const NextPiece next = [&]() -> std::optional<std::size_t> {
    const std::size_t from = first.fetch_add(size);
    return from < count ? std::optional(from) : std::nullopt;
  };
  std::vector<std::exception_ptr> failed(
      std::max<std::size_t>(1, std::min<std::size_t>(std::thread::hardware_concurrency(), count / size)));
  const auto guarded = [&](std::size_t thread, const NextPiece& pieces) {
    try {
      work(pieces);
    } catch (...) {
      failed[thread] = std::current_exception();
      first = count;
    }
  };
  {
    std::vector<std::jthread> others;
    for (std::size_t k = 1; k < failed.size(); ++k) others.emplace_back([&, k] { guarded(k, next); });
    guarded(0, [&] {
      look_for_stop();
      return next();
    });
  }
  for (const std::exception_ptr& e : failed)
    if (e) std::rethrow_exception(e);
}

}  // namespace anholon
