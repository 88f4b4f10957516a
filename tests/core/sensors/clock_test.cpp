// SPDX-License-Identifier: GPL-3.0-or-later
#include "sparse_mocap/sensors/clock.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "sparse_mocap/streams/unwrap.hpp"
#include "support/refusals.hpp"
#include "support/synthetic.hpp"

namespace sparse_mocap {
namespace {

using testing::Random;

struct Stream {
  double drift = 0.0;      // device seconds are this much shorter
  double jitter_s = 0.05;  // arrivals are late by up to this
  int burst = 1;           // samples that arrive together
  double rate_hz = 100.0;
  double minutes = 10.0;
};

// The largest error of the final model over the recording. Device ticks of 0.1 ms wrap at 16 bit,
// host time begins somewhere.
double largest_error_s(const Stream& stream, unsigned seed, ClockModel& clock) {
  Random random(seed);
  streams::TickClock ticks(16, 1e-4);
  const double begin_s = 12345.678;
  std::vector<double> device, host;
  double last = -1.0;
  const int samples = static_cast<int>(stream.minutes * 60.0 * stream.rate_hz);
  for (int first = 0; first < samples; first += stream.burst) {
    const int end = std::min(first + stream.burst, samples);
    const double late_s = random.in(0.0, stream.jitter_s);
    for (int i = first; i < end; ++i) {
      const double true_s = begin_s + i / stream.rate_hz;
      const auto tick = static_cast<std::uint64_t>(
          std::llround((i / stream.rate_hz + 3.0) * (1.0 - stream.drift) * 1e4));
      device.push_back(ticks.unwrap(tick % 65536).time_s);
      host.push_back(true_s);
      const double told =
          clock.observe(device.back(), begin_s + (end - 1) / stream.rate_hz + late_s);
      EXPECT_GE(told, last);
      last = told;
    }
  }
  double worst = 0.0;
  for (std::size_t i = 0; i < device.size(); ++i)
    worst = std::max(worst, std::abs(clock.host_time_s(device[i]) - host[i]));
  return worst;
}

TEST(ClockModel, IsWithinAMillisecondUnderDriftJitterAndWraps) {
  for (const double drift : {-100e-6, 100e-6})
    for (const int burst : {1, 20}) {
      ClockModel clock;
      EXPECT_LT(largest_error_s({.drift = drift, .burst = burst}, 1, clock), 1e-3) << burst;
      EXPECT_NEAR(clock.drift_ppm(), 1e6 * drift, 1.0);
      EXPECT_EQ(clock.num_segments(), 1);
    }
}

TEST(ClockModel, IsWithinAMillisecondAtEveryRate) {
  for (const double rate_hz : {30.0, 60.0, 2000.0}) {
    ClockModel clock;
    EXPECT_LT(largest_error_s({.drift = 100e-6, .rate_hz = rate_hz}, 2, clock), 1e-3) << rate_hz;
  }
}

// The window is ten minutes long: what it lets go of must not be missed.
TEST(ClockModel, DoesNotDriftInAnHour) {
  Random random(8);
  ClockModel clock;
  double worst_s = 0.0;
  for (int i = 0; i < 3600 * 100; ++i) {
    const double true_s = 5e4 + i * 0.01;
    const double told = clock.observe(i * 0.01 * (1.0 - 100e-6), true_s + random.in(0.0, 0.05));
    if (i > 60 * 100) worst_s = std::max(worst_s, std::abs(told - true_s));
  }
  EXPECT_LT(worst_s, 1e-3);
}

// Three hundred arrivals leave room for a line 2 ms off now and then, however it is chosen.
TEST(ClockModel, IsWithinAMillisecondWithThreeHundredBurstsToGoBy) {
  std::vector<double> errors_s;
  for (unsigned seed = 1; seed <= 20; ++seed) {
    ClockModel clock;
    errors_s.push_back(largest_error_s({.drift = 100e-6, .burst = 200}, seed, clock));
    EXPECT_NEAR(clock.drift_ppm(), 100.0, 8.0);
  }
  std::sort(errors_s.begin(), errors_s.end());
  EXPECT_LT(errors_s[9], 1e-3);
  EXPECT_LT(errors_s[17], 2e-3);
  EXPECT_LT(errors_s[19], 3e-3);
}

// Where the largest delay drifts and the least does not, the least decides.
TEST(ClockModel, KeepsToTheLeastDelayWhenTheLargestGrows) {
  Random random(5);
  ClockModel clock;
  for (int i = 0; i < 600; ++i)
    clock.observe(i, 100.0 + i + random.in(0.0, 0.016 * (1.0 + i / 600.0)));
  for (const double at : {0.0, 599.0}) EXPECT_NEAR(clock.host_time_s(at), 100.0 + at, 0.5e-3);
}

// However sharp the line is that many delays keep to.
TEST(ClockModel, KeepsToTheLeastDelayWhenManyAreAlike) {
  Random random(6);
  ClockModel clock;
  for (int i = 0; i < 600; ++i)
    clock.observe(i, 100.0 + i + (i % 2 == 0 ? random.in(0.0, 0.016) : 0.016 + 10e-6 * i));
  for (const double at : {0.0, 599.0}) EXPECT_NEAR(clock.host_time_s(at), 100.0 + at, 0.8e-3);
}

TEST(ClockModel, TellsTheJitter) {
  ClockModel clock;
  largest_error_s({.jitter_s = 0.04}, 1, clock);
  EXPECT_NEAR(clock.mean_lateness_s(), 0.02, 0.001);
}

TEST(ClockModel, ManagesWithASampleCounterAndANominalRate) {
  ClockModel clock({.largest_drift = 0.05});
  EXPECT_LT(largest_error_s({.drift = 0.02}, 1, clock), 2e-3);
  EXPECT_NEAR(clock.drift_ppm(), 1e6 * (1.0 / 0.98 - 1.0), 10.0);
}

TEST(ClockModel, StartsAnewWhenTheDeviceRestarts) {
  ClockModel clock;
  for (int i = 0; i < 1000; ++i) clock.observe(50.0 + i * 0.01, 100.0 + i * 0.01);
  double last = clock.host_time_s(59.99);
  for (int i = 0; i < 1000; ++i) {
    const double host = clock.observe(i * 0.01, 113.0 + i * 0.01);
    EXPECT_GE(host, last);
    last = host;
  }
  EXPECT_EQ(clock.num_segments(), 2);
  EXPECT_NEAR(clock.host_time_s(5.0), 118.0, 1e-6);
}

// As after a stall of a device that counts samples: its clock stands still meanwhile.
TEST(ClockModel, StartsAnewWhenTheDeviceHasFallenBehind) {
  for (const double pause_s : {0.1, 1.0, 10.0}) {
    ClockModel clock;
    Random random(3);
    for (int i = 0; i < 1000; ++i) clock.observe(i * 0.01, i * 0.01 + random.in(0.0, 0.03));
    int num_late = 0;
    for (int i = 1000; i < 2000; ++i) {
      const double true_s = i * 0.01 + pause_s;
      const double told_s = clock.observe(i * 0.01, true_s + random.in(0.0, 0.03));
      if (std::abs(told_s - true_s) > 0.03) ++num_late;
    }
    EXPECT_EQ(clock.num_segments(), 2) << pause_s;
    EXPECT_LE(num_late, 16) << pause_s;
    EXPECT_NEAR(clock.host_time_s(15.0), 15.0 + pause_s, 2e-3);
  }
}

TEST(ClockModel, SitsOutWhatWasOnlyLateForAMoment) {
  ClockModel clock;
  for (int i = 0; i < 3000; ++i)
    clock.observe(i * 0.01, i * 0.01 + (i % 100 < 20 ? 0.01 * (20 - i % 100) : 0.0));
  EXPECT_EQ(clock.num_segments(), 1);
  EXPECT_NEAR(clock.host_time_s(10.0), 10.0, 1e-3);
}

TEST(ClockModel, StartsAnewWhenTheDeviceRunsAheadOfWhatHasArrived) {
  ClockModel clock;
  for (int i = 0; i < 100; ++i) clock.observe(i * 0.01, i * 0.01);
  clock.observe(5000.0, 1.0);
  EXPECT_EQ(clock.num_segments(), 2);
  EXPECT_NEAR(clock.host_time_s(5000.0), 1.0, 1e-9);
}

TEST(ClockModel, BoundsTheDriftThatAFewArrivalsSuggest) {
  ClockModel clock;
  clock.observe(0.0, 10.05);
  clock.observe(1.5, 11.5);
  clock.observe(3.0, 13.04);
  EXPECT_LE(std::abs(clock.drift_ppm()), 500.0 + 1e-9);
  EXPECT_LE(clock.host_time_s(1.5), 11.5 + 1e-9);
}

TEST(ClockModel, RefusesWhatIsNoTime) {
  ClockModel clock;
  EXPECT_REFUSED(std::invalid_argument, "a time is not finite", clock.observe(std::nan(""), 1.0));
  EXPECT_REFUSED(std::invalid_argument, "a time is not finite",
                 clock.observe(1.0, std::numeric_limits<double>::infinity()));
  EXPECT_REFUSED(std::invalid_argument, "a setting is out of its range",
                 ClockModel({.largest_drift = 0.0}));
}

}  // namespace
}  // namespace sparse_mocap
