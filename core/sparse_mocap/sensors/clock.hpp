// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <deque>
#include <limits>

namespace sparse_mocap {

struct ClockSettings {
  double largest_drift = 500e-6;  // a device's clock against the host's, as a part
  double window_s = 600.0;        // older arrivals are forgotten
  double largest_step_s = 1.0;    // a device's clock that leaps further was set anew
  // One that has fallen behind, as while the device was stalled: when all arrivals of so long are
  // late by more than radio and buffers make them.
  double late_s = 0.06;
  double late_for_s = 0.15;
};

// Maps a device's clock to the host's monotonic one.
//
// Samples arrive only ever late: by buffering, by bursts, by radio. So the line host = offset +
// rate * device is the highest below all arrivals, its rate within largest_drift of 1 (the lower
// convex hull of Zhang, Liu and Xia, "Clock synchronization algorithms for network measurements",
// INFOCOM 2002). What all arrivals are late by at least cannot be seen and stays in the offset. A
// device without a clock is one whose time is its sample counter over its nominal rate; allow it
// more drift.
class ClockModel {
 public:
  explicit ClockModel(ClockSettings settings = {});

  // One sample or burst: unwrapped device time and when it was received. Returns the host time of
  // the sample; never before the time returned last. Times that are not finite throw
  // std::invalid_argument.
  double observe(double device_s, double arrival_s);

  // By all that is known now; meaningful from the first observe on.
  double host_time_s(double device_s) const;

  double offset_s() const;   // host minus device where the device's time is 0
  double drift_ppm() const;  // of the device's clock: positive when the host's seconds are longer
  double mean_lateness_s() const;  // of arrivals over the window: the jitter
  // 1 + how often the device's clock was reset or had fallen behind.
  int num_segments() const { return num_segments_; }
  // How many arrivals belonged to this segment when it was noticed: those since the step.
  int num_at_begin() const { return num_at_begin_; }
  // How many of the last arrivals were all late; when that goes on, a segment began with the first.
  int num_late() const { return num_late_; }

 private:
  // The arrivals of one second of device time: the least late, and the sums of all.
  struct Bucket {
    std::int64_t second = 0;
    double device_s = 0.0, arrival_s = 0.0;
    double device_sum = 0.0, arrival_sum = 0.0;
    int count = 0;
  };

  bool was_reset(double device_s, double arrival_s) const;
  bool has_fallen_behind(double device_s, double arrival_s);
  void start_segment(double device_s, double arrival_s);
  void add(double device_s, double arrival_s);
  void fit();

  ClockSettings settings_;
  std::deque<Bucket> buckets_;
  double origin_device_s_ = 0.0, origin_host_s_ = 0.0;  // keeps numbers small
  double intercept_s_ = 0.0, drift_ = 0.0;              // host' = intercept + (1 + drift) device'
  double last_device_s_ = 0.0;
  double last_host_s_ = -std::numeric_limits<double>::infinity();
  int num_segments_ = 0;
  int num_at_begin_ = 1;
  int num_late_ = 0;
  double late_since_s_ = 0.0;  // when the first of them arrived
};

}  // namespace sparse_mocap
