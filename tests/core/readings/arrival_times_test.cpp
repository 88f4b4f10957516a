// SPDX-License-Identifier: GPL-3.0-or-later
#include "sparse_mocap/readings/arrival_times.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <stdexcept>

namespace sparse_mocap {
namespace {

const double kNone = std::numeric_limits<double>::quiet_NaN();

void expect_near(const std::vector<double>& found, const std::vector<double>& wanted) {
  ASSERT_EQ(found.size(), wanted.size());
  for (std::size_t i = 0; i < found.size(); ++i) EXPECT_NEAR(found[i], wanted[i], 1e-9) << i;
}

TEST(ArrivalTimes, NeedOneArrivalForEachTime) {
  const std::vector<double> one{1.0}, two{1.0, 2.0};
  EXPECT_THROW(host_times(one, two), std::invalid_argument);
  EXPECT_TRUE(host_times({}, {}).times_s.empty());
  EXPECT_TRUE(spread_evenly({}).empty());
  expect_near(spread_evenly(one), one);
}

// Steps of 0.01 s by hand: the first burst has the step of the others.
TEST(ArrivalTimes, SpreadBurstsOverTheTimeBefore) {
  expect_near(spread_evenly(std::vector<double>{1.0, 1.0, 1.02, 1.02, 1.04, 1.04}),
              {0.99, 1.0, 1.01, 1.02, 1.03, 1.04});
  expect_near(spread_evenly(std::vector<double>{1.0, 1.0}), {0.99, 1.0});
}

TEST(ArrivalTimes, SpreadABurstNoFurtherThanTheOneBefore) {
  // 0.03 s is the usual step; after 1.03 three samples have 0.03 s between them.
  expect_near(spread_evenly(std::vector<double>{1.0, 1.03, 1.06, 1.09, 1.12, 1.12, 1.12}),
              {1.0, 1.03, 1.06, 1.09, 1.10, 1.11, 1.12});
}

TEST(ArrivalTimes, AscendEvenWhereArrivalsDoNot) {
  const auto times_s = spread_evenly(std::vector<double>{1.0, 0.9, 0.9, 1.1});
  for (std::size_t i = 1; i < times_s.size(); ++i) EXPECT_GT(times_s[i], times_s[i - 1]);
}

TEST(ArrivalTimes, AreSpreadWithoutADevicesClock) {
  const std::vector<double> device{1.0, kNone, 1.02, 1.03}, arrival{5.0, 5.0, 5.02, 5.02};
  const HostTimes found = host_times(device, arrival);
  expect_near(found.times_s, {4.99, 5.0, 5.01, 5.02});
  EXPECT_EQ(found.rate, 1.0);
}

TEST(ArrivalTimes, FollowADevicesClock) {
  std::vector<double> device, arrival;
  for (int i = 0; i < 1000; ++i) {
    device.push_back(0.01 * i);
    arrival.push_back(70.0 + 0.01 * i + (i % 7 == 3 ? 0.004 : 0.0));
  }
  const HostTimes found = host_times(device, arrival);
  EXPECT_NEAR(found.rate, 1.0, 1e-5);
  for (std::size_t i = 0; i < device.size(); ++i)
    EXPECT_NEAR(found.times_s[i], 70.0 + device[i], 1e-4);
}

TEST(ArrivalTimes, KeepTheSecondsOfAClockThatIsNotInRealTime) {
  std::vector<double> device, arrival;
  for (int i = 0; i < 100; ++i) {
    device.push_back(3.0 + 0.01 * i);
    arrival.push_back(70.0 + 0.001 * i);
  }
  const HostTimes found = host_times(device, arrival);
  EXPECT_NEAR(found.rate, 0.1, 1e-9);
  for (std::size_t i = 0; i < device.size(); ++i)
    EXPECT_NEAR(found.times_s[i], 67.0 + device[i], 1e-9);
}

// A device that counts samples stands still in a pause; two pauses, one of them short.
TEST(ArrivalTimes, ArePausedAsLongAsTheDeviceWas) {
  std::vector<double> device, arrival, taken;
  for (int i = 0; i < 3000; ++i) {
    taken.push_back(50.0 + 0.01 * i + (i >= 1000 ? 5.0 : 0.0) + (i >= 2800 ? 0.3 : 0.0));
    device.push_back(0.01 * i);
    arrival.push_back(taken.back() + (i % 5) * 0.004);
  }
  const HostTimes found = host_times(device, arrival);
  EXPECT_NEAR(found.rate, 1.0, 1e-3);
  for (std::size_t i = 0; i < device.size(); ++i)
    EXPECT_NEAR(found.times_s[i], taken[i], 3e-3) << i;
}

TEST(ArrivalTimes, FollowADeviceThatRestarts) {
  std::vector<double> device, arrival;
  for (int i = 0; i < 1000; ++i) {
    device.push_back(i < 600 ? 100.0 + 0.01 * i : 0.01 * (i - 600));
    arrival.push_back(7.0 + 0.01 * i + (i < 600 ? 0.0 : 1.5));
  }
  const HostTimes found = host_times(device, arrival);
  for (std::size_t i = 0; i < device.size(); ++i)
    EXPECT_NEAR(found.times_s[i], arrival[i], 1e-3) << i;
}

TEST(ArrivalTimes, ATakeOfASecondHasARealClock) {
  std::vector<double> device, arrival;
  for (int i = 0; i < 120; ++i) {
    device.push_back(0.01 * i);
    arrival.push_back(3.0 + 0.01 * i + (i == 0 ? 0.03 : 0.0));
  }
  EXPECT_NEAR(host_times(device, arrival).rate, 1.0, 1e-3);
}

}  // namespace
}  // namespace sparse_mocap
