// SPDX-License-Identifier: GPL-3.0-or-later
#include "sparse_mocap/sensors/resampler.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "support/refusals.hpp"
#include "support/synthetic.hpp"

namespace sparse_mocap {
namespace {

using testing::Random;

struct Recorded {
  std::vector<double> times_s;
  Eigen::MatrixXd values{3, 0};
};

// Irregular samples; none while a gap lasts.
Recorded recorded(Random& random, double begin_s, double end_s, double gap_begin_s,
                  double gap_end_s) {
  Recorded out;
  for (double t = begin_s; t < end_s; t += random.in(0.004, 0.016))
    if (t < gap_begin_s || t > gap_end_s) out.times_s.push_back(t);
  out.values = random.matrix(3, static_cast<Eigen::Index>(out.times_s.size()), 20.0);
  return out;
}

// Samples of both in the order of their times, each heard a moment later.
std::vector<ResampledFrame> streamed(Resampler& resampler, const std::vector<Recorded>& sensors) {
  std::vector<ResampledFrame> frames;
  std::vector<std::size_t> next(sensors.size(), 0);
  while (true) {
    std::size_t first = sensors.size();
    for (std::size_t s = 0; s < sensors.size(); ++s)
      if (next[s] < sensors[s].times_s.size() &&
          (first == sensors.size() ||
           sensors[s].times_s[next[s]] < sensors[first].times_s[next[first]]))
        first = s;
    if (first == sensors.size()) break;
    const double now_s = sensors[first].times_s[next[first]];
    EXPECT_TRUE(resampler.push(static_cast<int>(first), now_s,
                               sensors[first].values.col(static_cast<Eigen::Index>(next[first]))));
    ++next[first];
    for (auto& frame : resampler.frames_until(now_s)) {
      EXPECT_GE(now_s, frame.time_s + resampler.delay_s());
      EXPECT_LT(now_s, frame.time_s + resampler.delay_s() + Resampler::kLongestGap_s + 0.02);
      frames.push_back(std::move(frame));
    }
  }
  for (auto& frame : resampler.flush()) frames.push_back(std::move(frame));
  return frames;
}

TEST(Resampler, GivesExactlyWhatTheWholeRecordingGives) {
  Random random(3);
  const std::vector<Recorded> sensors{recorded(random, 7.0, 12.0, 9.0, 9.6),
                                      recorded(random, 7.02, 12.05, 99.0, 99.0)};
  Resampler resampler(2, 25.0);
  const auto frames = streamed(resampler, sensors);
  const double end_s = std::max(sensors[0].times_s.back(), sensors[1].times_s.back());
  ASSERT_EQ(frames.size(), static_cast<std::size_t>((end_s - sensors[0].times_s[0]) * 25.0) + 1);
  int silent = 0;
  for (std::size_t k = 0; k < frames.size(); ++k) {
    EXPECT_DOUBLE_EQ(frames[k].time_s, sensors[0].times_s[0] + static_cast<double>(k) / 25.0);
    for (std::size_t s = 0; s < 2; ++s) {
      const Vec3 value = frames[k].specific_force.col(static_cast<Eigen::Index>(s));
      if (value.hasNaN()) {
        EXPECT_EQ(s, 0U);
        EXPECT_GT(frames[k].time_s, 8.97);
        EXPECT_LT(frames[k].time_s, 9.63);
        ++silent;
        continue;
      }
      const std::vector<double> at{frames[k].time_s};
      const Eigen::MatrixXd whole =
          filtered_at(sensors[s].times_s, sensors[s].values, at, kReadingFilter);
      EXPECT_EQ(value, Vec3(whole.col(0))) << k << " " << s;
    }
  }
  EXPECT_NEAR(silent, 15, 1);
}

TEST(Resampler, WaitsNoLongerThanTheKernelReaches) {
  Resampler resampler(1, 25.0);
  for (int i = 0; i <= 7; ++i) {
    resampler.push(0, i * 0.005, Vec3::UnitX());
    EXPECT_EQ(resampler.frames_until(i * 0.005).size(), i == 7 ? 1U : 0U) << i;
  }
  EXPECT_NEAR(resampler.delay_s(), 0.0345, 1e-12);
}

TEST(Resampler, GoesOnWithoutASensorThatLeft) {
  Resampler resampler(2, 25.0);
  for (int i = 0; i < 200; ++i) {
    resampler.push(0, i * 0.01, Vec3::UnitX());
    if (i < 50) resampler.push(1, i * 0.01, Vec3::UnitY());
  }
  const auto frames = resampler.frames_until(1.99);
  ASSERT_GT(frames.size(), 45U);
  EXPECT_FALSE(frames[11].specific_force.hasNaN());
  EXPECT_FALSE(frames[14].specific_force.col(0).hasNaN());
  EXPECT_TRUE(frames[14].specific_force.col(1).hasNaN());
}

TEST(Resampler, DropsSamplesThatComeTwiceOrAreBroken) {
  Resampler resampler(1, 25.0);
  EXPECT_TRUE(resampler.push(0, 1.0, Vec3::UnitX()));
  EXPECT_FALSE(resampler.push(0, 1.0, Vec3::UnitX()));
  EXPECT_FALSE(resampler.push(0, 0.5, Vec3::UnitX()));
  EXPECT_FALSE(resampler.push(0, 2.0, Vec3(std::nan(""), 0.0, 0.0)));
  EXPECT_REFUSED(std::invalid_argument, "sensors and a positive rate", Resampler(0, 25.0));
  EXPECT_REFUSED(std::invalid_argument, "sensors and a positive rate", Resampler(1, 0.0));
}

}  // namespace
}  // namespace sparse_mocap
