// Loops over many states on several threads.
#include <chrono>
#include <stdexcept>

#include <gtest/gtest.h>

#include "dynamics/pieces.h"

namespace anholon {
namespace {

constexpr std::size_t kStates = 6'000, kAtOnce = 2;

TEST(Pieces, EveryStateIsTakenOnce) {
  std::vector<std::atomic<int>> taken(kStates + 1);
  in_pieces(kStates + 1, kAtOnce, [&](const NextPiece& next) {
    while (const std::optional<std::size_t> from = next())
      for (std::size_t k = *from; k < std::min(kStates + 1, *from + kAtOnce); ++k) ++taken[k];
  });
  for (const std::atomic<int>& times : taken) EXPECT_EQ(times, 1);
}

// The computation of a piece may itself ask whether to stop; the other threads end then, too.
TEST(Pieces, StopWithinAPieceEndsAllThreads) {
  std::atomic<std::size_t> pieces = 0;
  const std::thread::id here = std::this_thread::get_id();
  bool asked = false;
  const StopScope scope([&] { return asked; });
  EXPECT_THROW(in_pieces(kStates, kAtOnce,
                         [&](const NextPiece& next) {
                           while (next()) {
                             ++pieces;
                             if (std::this_thread::get_id() == here) asked = true;
                             look_for_stop();
                             std::this_thread::sleep_for(std::chrono::microseconds(200));
                           }
                         }),
               StopRequested);
  EXPECT_LT(pieces, kStates / kAtOnce);
}

TEST(Pieces, ErrorOfAnotherThreadIsThrownHere) {
  if (std::thread::hardware_concurrency() < 2) GTEST_SKIP() << "there is one thread";
  const std::thread::id here = std::this_thread::get_id();
  std::atomic<std::size_t> pieces = 0;
  EXPECT_THROW(in_pieces(kStates, kAtOnce,
                         [&](const NextPiece& next) {
                           while (next()) {
                             ++pieces;
                             if (std::this_thread::get_id() != here) throw std::runtime_error("a state");
                             std::this_thread::sleep_for(std::chrono::microseconds(200));
                           }
                         }),
               std::runtime_error);
  EXPECT_LT(pieces, kStates / kAtOnce);
}

}  // namespace
}  // namespace anholon
