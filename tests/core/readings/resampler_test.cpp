// SPDX-License-Identifier: GPL-3.0-or-later
#include "sparse_mocap/readings/resampler.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "sparse_mocap/base/quaternions.hpp"
#include "support/random.hpp"

namespace sparse_mocap {
namespace {

using testing::Random;

bool push(Resampler& resampler, double time_s, const Eigen::VectorXd& value) {
  return resampler.push(time_s, {value.data(), static_cast<std::size_t>(value.size())});
}

TEST(Resampler, DropsSamplesThatComeTwiceOrAreBroken) {
  Resampler resampler(Resampler::Kind::vector);
  EXPECT_FALSE(resampler.reaches(-1.0));
  EXPECT_TRUE(push(resampler, 1.0, Vec3::UnitX()));
  EXPECT_FALSE(push(resampler, 1.0, Vec3::UnitY()));
  EXPECT_FALSE(push(resampler, 0.5, Vec3::UnitY()));
  EXPECT_FALSE(push(resampler, 2.0, Vec3(std::nan(""), 0.0, 0.0)));
  EXPECT_FALSE(push(resampler, std::nan(""), Vec3::UnitY()));
  EXPECT_TRUE(resampler.reaches(1.0));
  EXPECT_FALSE(resampler.reaches(1.1));
  EXPECT_EQ(resampler.at(1.0, kReadingFilter, true), Vec3::UnitX());
}

TEST(Resampler, FiltersAsIfNothingHadBeenForgotten) {
  Random random(3);
  Resampler whole(Resampler::Kind::vector), forgetful(Resampler::Kind::vector);
  for (double t = 0.0; t < 20.0; t += random.in(0.004, 0.016)) {
    const Vec3 value = random.vector(20.0);
    push(whole, t, value);
    push(forgetful, t, value);
  }
  for (double t = 0.1; t < 19.0; t += 0.04) {
    forgetful.forget(t - kReadingFilter.reach_s());
    EXPECT_EQ(forgetful.at(t, kReadingFilter, false), whole.at(t, kReadingFilter, false)) << t;
  }
}

TEST(Resampler, IsSilentInLongGapsAndFarBeyondTheEnds) {
  Resampler resampler(Resampler::Kind::vector);
  for (const double t : {1.0, 1.1, 1.25, 1.26}) push(resampler, t, Vec3::UnitX());
  const auto is_silent = [&](double t, bool has_ended) {
    return resampler.at(t, kReadingFilter, has_ended).hasNaN();
  };
  EXPECT_TRUE(is_silent(0.89, true));
  EXPECT_FALSE(is_silent(0.91, true));
  EXPECT_FALSE(is_silent(1.05, true));
  EXPECT_FALSE(is_silent(1.1, true));
  EXPECT_TRUE(is_silent(1.11, true));  // 0.15 s without a sample
  EXPECT_TRUE(is_silent(1.24, true));
  EXPECT_FALSE(is_silent(1.25, true));
  EXPECT_FALSE(is_silent(1.35, true));
  EXPECT_TRUE(is_silent(1.37, true));
  EXPECT_TRUE(is_silent(1.27, false));  // what comes next is not known yet
  EXPECT_FALSE(is_silent(1.26, false));
}

// A turn at an even speed about a fixed axis: between any two samples it is where it would be.
TEST(Resampler, TurnsEvenlyBetweenRotationsAndTheShorterWay) {
  const Vec3 axis = Vec3(1.0, 2.0, -2.0) / 3.0;
  Resampler resampler(Resampler::Kind::rotation);
  for (int i = 0; i <= 100; ++i) {
    const double angle = 0.04 * i * i / 10.0, sign = i % 3 == 0 ? -1.0 : 1.0;
    push(resampler, 0.01 * i, sign * wxyz_of(Quat(Eigen::AngleAxisd(angle, axis))));
  }
  for (int i = 0; i < 100; ++i)
    for (const double part : {0.0, 0.3, 0.8}) {
      const double angle = 0.04 * (i * i + part * (2 * i + 1)) / 10.0;
      const Quat wanted(Eigen::AngleAxisd(angle, axis));
      const Quat found = quaternion_of(resampler.at(0.01 * (i + part), kReadingFilter, true));
      EXPECT_LT(found.angularDistance(wanted), 1e-7) << i << " " << part;
      EXPECT_NEAR(found.norm(), 1.0, 1e-12);
    }
}

}  // namespace
}  // namespace sparse_mocap
