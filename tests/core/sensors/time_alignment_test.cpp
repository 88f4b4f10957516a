// SPDX-License-Identifier: GPL-3.0-or-later
#include "sparse_mocap/sensors/time_alignment.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>
#include <vector>

#include "sparse_mocap/base/conventions.hpp"
#include "support/refusals.hpp"
#include "support/synthetic.hpp"

namespace sparse_mocap {
namespace {

using testing::Random;

struct Signal {
  std::vector<double> times_s, values;
};

// Two bumps like a jump's start and landing, seen at event_s of a clock of its own.
Signal jump(double event_s, double size, double rate_hz, unsigned seed, double noise = 0.3) {
  Random random(seed);
  Signal out;
  for (double t = 0.0; t < 12.0; t += 1.0 / rate_hz) {
    const double a = (t - event_s) / 0.06, b = (t - event_s - 0.55) / 0.04;
    out.times_s.push_back(t);
    out.values.push_back(9.81 + size * (std::exp(-0.5 * a * a) + 1.6 * std::exp(-0.5 * b * b)) +
                         random.in(-noise, noise));
  }
  return out;
}

TimeLag lag_of(const Signal& a, const Signal& b) {
  return align_in_time(a.times_s, a.values, b.times_s, b.values);
}

TEST(AlignInTime, FindsLagsBetweenSamples) {
  for (const double lag_s : {-0.7234, -0.0503, 0.0, 0.0037, 0.412}) {
    const TimeLag found = lag_of(jump(5.0, 15.0, 100.0, 1), jump(5.0 + lag_s, 9.0, 60.0, 2));
    EXPECT_NEAR(found.lag_s, lag_s, 2e-3);
    EXPECT_TRUE(found.is_found());
    EXPECT_NEAR(found.event_s, 5.3, 0.8);
  }
}

TEST(AlignInTime, SaysWhenNothingIsCommon) {
  Random random(5);
  Signal a = jump(5.0, 0.0, 100.0, 1), b = jump(5.0, 0.0, 100.0, 2);
  EXPECT_FALSE(lag_of(a, b).is_found());
  for (auto& value : a.values) value = 9.81;
  EXPECT_FALSE(lag_of(a, b).is_found());
}

TEST(AlignInTime, SaysWhenSeveralLagsFit) {
  Signal a, b;
  for (int i = 0; i < 1200; ++i) {
    a.times_s.push_back(i * 0.01);
    a.values.push_back(9.81 + 4.0 * std::sin(2.0 * kPi * 2.0 * i * 0.01));
  }
  b = a;
  const TimeLag found = lag_of(a, b);
  EXPECT_GT(found.runner_up, 0.95);
  EXPECT_FALSE(found.is_found());
}

TEST(AlignInTime, RefusesRecordingsThatHardlyOverlap) {
  const Signal a = jump(5.0, 15.0, 100.0, 1);
  Signal b = a;
  for (auto& time : b.times_s) time += 10.0;
  EXPECT_REFUSED(std::invalid_argument, "overlap by too little", lag_of(a, b));
  b.values.pop_back();
  EXPECT_REFUSED(std::invalid_argument, "one value for each time", lag_of(a, b));
}

}  // namespace
}  // namespace sparse_mocap
