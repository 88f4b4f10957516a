// SPDX-License-Identifier: GPL-3.0-or-later
#include "sparse_mocap/sensors/gravity.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>

#include "sparse_mocap/base/errors.hpp"
#include "sparse_mocap/sensors/filter.hpp"

namespace sparse_mocap {
namespace {

constexpr double kShortestStand_s = 0.5;
constexpr double kQuietStretch_s = 1.0;
constexpr double kLargestUnrest = 0.05;  // of the magnitude

struct Stretch {
  Eigen::Index begin = 0, size = 0;
  double unrest = std::numeric_limits<double>::infinity();
};

// Slow unrest counts (the wearer moves), the sensor's own noise does not.
Stretch quietest(const SensorRecording& standing) {
  const auto& times = standing.times_s;
  const Eigen::MatrixXd smooth =
      filtered_at(times, standing.specific_force, times, GaussianFilter{0.03});
  const Eigen::Index n = smooth.cols();
  const double stretch_s = std::min(kQuietStretch_s, times.back() - times.front());
  const auto size = std::max<Eigen::Index>(
      static_cast<Eigen::Index>(std::lround(stretch_s / standing.sample_time_s())), 2);
  Stretch best;
  for (Eigen::Index begin = 0; begin + size <= n; begin += std::max<Eigen::Index>(size / 10, 1)) {
    const auto part = smooth.middleCols(begin, size);
    const double unrest = std::sqrt((part.colwise() - part.rowwise().mean()).squaredNorm() /
                                    static_cast<double>(size));
    if (unrest < best.unrest) best = {begin, size, unrest};
  }
  return best;
}

[[noreturn]] void refuse(const std::string& what, double number, const std::string& rest) {
  std::ostringstream text;
  text.precision(4);
  text << what << number << rest;
  throw ConfigError(text.str());
}

}  // namespace

StandingGravity standing_gravity(const SensorRecording& standing) {
  const double seconds =
      standing.num_samples() < 3 ? 0.0 : standing.times_s.back() - standing.times_s.front();
  if (seconds < kShortestStand_s)
    refuse("the standing pose lasts ", seconds, " s; stand still for 2 s or longer");
  const Stretch stretch = quietest(standing);
  const Vec3 mean =
      standing.specific_force.middleCols(stretch.begin, stretch.size).rowwise().mean();
  StandingGravity gravity;
  gravity.magnitude = mean.norm();
  if (stretch.unrest > kLargestUnrest * gravity.magnitude)
    refuse("it is not still while the performer stands: its readings vary by ",
           stretch.unrest / gravity.magnitude * kGravity_mps2, " m/s^2; stand still for 2 s");
  gravity.is_in_g = std::abs(gravity.magnitude - 1.0) <= kLargestGravityError;
  const double expected = gravity.is_in_g ? 1.0 : kGravity_mps2;
  if (std::abs(gravity.magnitude - expected) > kLargestGravityError * expected)
    refuse("at rest it reads ", gravity.magnitude,
           ", which is neither 9.81 m/s^2 nor 1 g within 15 %; check its range, its unit, and that "
           "gravity is included");
  gravity.scale = kGravity_mps2 / gravity.magnitude;
  gravity.up = mean.normalized();
  gravity.unrest_mps2 = stretch.unrest * gravity.scale;
  if (standing.has_gyroscope())
    gravity.gyroscope_bias =
        standing.angular_velocity.middleCols(stretch.begin, stretch.size).rowwise().mean();
  return gravity;
}

}  // namespace sparse_mocap
