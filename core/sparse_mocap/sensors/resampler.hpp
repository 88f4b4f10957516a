// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "sparse_mocap/base/conventions.hpp"
#include "sparse_mocap/sensors/filter.hpp"

namespace sparse_mocap {

// All sensors at one instant: 3 x sensors, m/s^2; NaN where one is silent.
struct ResampledFrame {
  double time_s = 0.0;
  Eigen::Matrix3Xd specific_force;
};

// Brings live sensors onto a database's time line through the database's own low-pass.
//
// A frame is given as soon as every sensor has been heard beyond the reach of its kernel, so that
// no later sample can change it: kReadingFilter.reach_s() after its time. It then equals
// filtered_at over the whole recording. A sensor that stays away for longest_gap_s more no longer
// holds up the others; it is NaN where it is silent for longer than longest_gap_s.
class Resampler {
 public:
  static constexpr double kLongestGap_s = 0.1;

  // Throws std::invalid_argument unless there are sensors and the rate is positive.
  Resampler(int num_sensors, double rate_hz, GaussianFilter filter = kReadingFilter);

  // One sample; its time on the common clock must be after the sensor's last one, else it is
  // dropped and false returned. Frames begin with the first sample of all.
  bool push(int sensor, double time_s, const Vec3& specific_force);

  // The frames that are ready at now_s, in order; now_s is on the common clock.
  std::vector<ResampledFrame> frames_until(double now_s);

  // The frames up to the last sample; the performance has ended.
  std::vector<ResampledFrame> flush();

  double delay_s() const { return filter_.reach_s(); }

 private:
  struct Heard {
    std::vector<double> times_s;
    std::vector<Vec3> values;
  };

  bool is_ready(double time_s, double now_s) const;
  ResampledFrame frame_at(double time_s, bool has_ended) const;
  void forget(double before_s);
  double next_time_s() const { return *begin_s_ + static_cast<double>(num_given_) / rate_hz_; }

  double rate_hz_;
  GaussianFilter filter_;
  std::vector<Heard> heard_;
  std::optional<double> begin_s_;
  long long num_given_ = 0;
};

}  // namespace sparse_mocap
