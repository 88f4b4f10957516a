// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <span>
#include <vector>

namespace sparse_mocap {

// When samples were taken, on the machine's clock.
struct HostTimes {
  std::vector<double> times_s;  // ascending
  double rate = 1.0;            // seconds of the machine to one of the device
};

// Quartz drifts by 1e-4 at most; a device's clock that is off by more is not in real time.
inline constexpr double kLargestClockDrift = 0.01;

// Times that ascend, for arrivals of a device without a clock: samples that arrived at once are
// spread over the time before.
std::vector<double> spread_evenly(std::span<const double> arrival_s);

// The times of a whole recording: the device's clock is laid under the arrivals by ClockModel, anew
// after each step of that clock, so that a pause is as long as it was; without a clock (a time that
// is not finite) the arrivals are spread. A rate that is not real (an emulator that plays faster)
// is returned, but the device's own seconds are kept. Throws std::invalid_argument unless there are
// as many times as arrivals.
HostTimes host_times(std::span<const double> device_s, std::span<const double> arrival_s);

}  // namespace sparse_mocap
