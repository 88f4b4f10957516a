// SPDX-License-Identifier: GPL-3.0-or-later
#include "sparse_mocap/base/ordered_work.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <numeric>
#include <stdexcept>
#include <string>
#include <thread>

#include "support/refusals.hpp"

namespace sparse_mocap {
namespace {

using Token = const std::stop_token&;

const auto kNothing = [](std::size_t) {};

TEST(OrderedWork, HandsResultsOverInOrderOnTheCallingThread) {
  for (const int num_threads : {0, 1, 2, 7, 100}) {
    std::vector<std::size_t> taken;
    const auto caller = std::this_thread::get_id();
    work_in_order(
        50, num_threads,
        [](std::size_t i, Token) {
          // The first pieces take longest, so that later ones are done before.
          std::this_thread::sleep_for(std::chrono::microseconds(50 * (50 - i)));
          return i * i;
        },
        [&](std::size_t i, std::size_t result) {
          EXPECT_EQ(std::this_thread::get_id(), caller);
          EXPECT_EQ(result, i * i);
          taken.push_back(i);
        },
        kNothing);
    std::vector<std::size_t> expected(50);
    std::iota(expected.begin(), expected.end(), std::size_t{0});
    EXPECT_EQ(taken, expected);
  }
}

TEST(OrderedWork, DoesNothingForNothing) {
  work_in_order(
      0, 4, [](std::size_t, Token) { return 1; }, [](std::size_t, int) { FAIL(); },
      [](std::size_t) { FAIL(); });
}

TEST(OrderedWork, UsesAsManyThreadsAsAreAskedFor) {
  std::atomic<int> at_once{0};
  // Each piece waits for the other: with one thread this would never end.
  work_in_order(
      2, 2,
      [&](std::size_t, Token) {
        ++at_once;
        while (at_once < 2) std::this_thread::yield();
        return 0;
      },
      [](std::size_t, int) {}, kNothing);
  EXPECT_EQ(at_once, 2);
  EXPECT_EQ(num_threads_or_all(3), 3);
  EXPECT_GE(num_threads_or_all(0), 1);
}

TEST(OrderedWork, ThrowsTheErrorThatComesFirstInOrder) {
  for (const int num_threads : {1, 4}) {
    int taken = 0;
    std::string what;
    try {
      work_in_order(
          20, num_threads,
          [](std::size_t i, Token) {
            if (i == 5) std::this_thread::sleep_for(std::chrono::milliseconds(20));
            if (i >= 5) throw std::runtime_error(std::to_string(i));
            return 0;
          },
          [&](std::size_t, int) { ++taken; }, kNothing);
    } catch (const std::runtime_error& error) {
      what = error.what();
    }
    EXPECT_EQ(what, "5");
    EXPECT_EQ(taken, 5);
  }
}

TEST(OrderedWork, StopsSoonWhenTheCallerThrows) {
  std::atomic<int> started{0};
  const auto run = [&] {
    work_in_order(
        10'000, 2,
        [&](std::size_t, Token stop) {
          ++started;
          for (int n = 0; n < 1000 && !stop.stop_requested(); ++n)
            std::this_thread::sleep_for(std::chrono::milliseconds(1));
          return 0;
        },
        [](std::size_t, int) {}, [](std::size_t) { throw std::runtime_error("enough"); });
  };
  EXPECT_REFUSED(std::runtime_error, "enough", run());
  EXPECT_LE(started, 2);
}

TEST(OrderedWork, AsksTheCallerNowAndThenWhileAPieceTakesLong) {
  std::atomic<bool> is_asked_twice{false};
  int asked = 0;
  work_in_order(
      1, 1,
      [&](std::size_t, Token) {
        while (!is_asked_twice) std::this_thread::yield();
        return 0;
      },
      [](std::size_t, int) {}, [&](std::size_t) { is_asked_twice = ++asked >= 2; });
  EXPECT_GE(asked, 2);
}

TEST(InPieces, DoesAllOnceOnAnyNumberOfThreads) {
  for (const int num_threads : {0, 1, 2, 7})
    for (const std::size_t count : {0U, 1U, 9U, 10U, 11U, 95U}) {
      std::vector<int> done(count, 0);
      in_pieces(count, 10, num_threads, [&](std::size_t i) { ++done[i]; });
      EXPECT_EQ(done, std::vector<int>(count, 1));
    }
}

TEST(InPieces, ThrowsWhatWorkThrew) {
  for (const int num_threads : {1, 3})
    EXPECT_REFUSED(std::runtime_error, "at 42", in_pieces(100, 10, num_threads, [](std::size_t i) {
                     if (i == 42) throw std::runtime_error("at 42");
                   }));
}

}  // namespace
}  // namespace sparse_mocap
