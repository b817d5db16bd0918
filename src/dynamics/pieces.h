// Loops over many states on several threads that end when a StopScope asks for it.
#pragma once
#include <atomic>
#include <functional>
#include <optional>
#include <thread>
#include <vector>

#include "base/stop.h"

namespace anholon {

using NextPiece = std::function<std::optional<std::size_t>()>;  // the first state of a piece; none if there is no more

// Calls work(next) in this thread, and in others if there are many pieces of `size` states; together they take all pieces
// of `count` states. Throws StopRequested, once the others have ended, if a StopScope of this thread asks for an end.
template <class Work>
void in_pieces(std::size_t count, std::size_t size, const Work& work) {
  std::atomic<std::size_t> first = 0;
  const NextPiece next = [&]() -> std::optional<std::size_t> {
    const std::size_t from = first.fetch_add(size);
    return from < count ? std::optional(from) : std::nullopt;
  };
  std::vector<std::jthread> others;
  const std::size_t threads = std::min<std::size_t>(std::thread::hardware_concurrency(), count / size);
  while (others.size() + 1 < threads) others.emplace_back([&] { work(next); });
  work(NextPiece([&] {
    try {
      look_for_stop();
    } catch (...) {
      first = count;
      throw;
    }
    return next();
  }));
}

}  // namespace anholon
