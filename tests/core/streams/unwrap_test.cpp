// SPDX-License-Identifier: GPL-3.0-or-later
#include "sparse_mocap/streams/unwrap.hpp"

#include <gtest/gtest.h>

namespace sparse_mocap::streams {
namespace {

std::uint64_t cut(std::uint64_t count, int bits) {
  return bits == 64 ? count : count % (std::uint64_t{1} << bits);
}

TEST(PacketCounter, CountsOnThroughWrapsOfAnyWidth) {
  for (const int bits : {2, 8, 12, 16, 24, 32}) {
    PacketCounter counter(bits);
    const std::uint64_t start = cut(~std::uint64_t{0}, bits) - 2;
    const std::int64_t first = counter.unwrap(start).counter;
    for (std::uint64_t step = 1; step < 10; ++step) {
      const auto count = counter.unwrap(cut(start + step, bits));
      EXPECT_EQ(count.counter, first + static_cast<std::int64_t>(step)) << bits;
      EXPECT_EQ(count.missing, 0);
    }
  }
}

TEST(PacketCounter, TellsRepeatsStepsBackAndGapsAsSuch) {
  PacketCounter counter(16);
  counter.unwrap(65534);
  EXPECT_TRUE(counter.unwrap(65534).is_repeated);
  const auto gap = counter.unwrap(8);
  EXPECT_EQ(gap.missing, 9);
  EXPECT_EQ(gap.counter, 65544);
  EXPECT_TRUE(counter.unwrap(65530).is_backwards);
  EXPECT_EQ(counter.unwrap(65531).counter, 65545);  // it goes on from there
}

TEST(TickClock, AscendsThroughWrapsAndRestarts) {
  for (const int bits : {16, 24, 32}) {
    TickClock clock(bits, 1e-3);
    const std::uint64_t start = cut(~std::uint64_t{0}, bits) - 20;
    const double first_s = clock.unwrap(start).time_s;
    for (std::uint64_t step = 1; step < 10; ++step)
      EXPECT_NEAR(clock.unwrap(cut(start + 10 * step, bits)).time_s,
                  first_s + 0.01 * static_cast<double>(step), 1e-9);
    const auto late = clock.unwrap(cut(start + 10, bits));  // 80 ms back
    EXPECT_TRUE(late.is_repeated);
    EXPECT_FALSE(late.is_restarted);
    const auto again = clock.unwrap(cut(start - 30, bits));
    EXPECT_TRUE(again.is_restarted);
    EXPECT_NEAR(again.time_s, first_s + 0.1, 1e-9);  // on by the last step's length
  }
}

TEST(TickClock, BearsAnyNumber) {
  TickClock clock(64, 1e-9);
  double last_s = 0.0;
  for (const std::uint64_t raw : {std::uint64_t{0}, ~std::uint64_t{0}, std::uint64_t{1} << 63,
                                  ~std::uint64_t{0} / 2, std::uint64_t{5}}) {
    const double time_s = clock.unwrap(raw).time_s;
    EXPECT_GE(time_s, last_s);
    last_s = time_s;
  }
}

}  // namespace
}  // namespace sparse_mocap::streams
