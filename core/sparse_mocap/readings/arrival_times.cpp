// SPDX-License-Identifier: GPL-3.0-or-later
#include "sparse_mocap/readings/arrival_times.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "sparse_mocap/sensors/clock.hpp"

namespace sparse_mocap {
namespace {

constexpr double kLeastStep_s = 1e-6;
constexpr double kUsualStep_s = 0.01;
// A recording's clock stepped only where arrivals are late for longer than radio makes them.
constexpr double kLateFor_s = 2.0, kLateForAtEnd_s = 0.25;
constexpr double kUnsure_s = 0.1;  // of a clock's rate by the ends of a recording

void make_ascending(std::vector<double>& times_s) {
  double latest = -std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < times_s.size(); ++i) {
    const double steps = static_cast<double>(i) * kLeastStep_s;
    latest = std::max(latest, times_s[i] - steps);
    times_s[i] = latest + steps;
  }
}

// Samples that arrived at once.
struct Burst {
  std::size_t first = 0;
  std::size_t count = 0;
  double arrival_s = 0.0;
};

std::vector<Burst> bursts_of(std::span<const double> arrival_s) {
  std::vector<Burst> out;
  for (std::size_t i = 0; i < arrival_s.size(); ++i) {
    if (i == 0 || arrival_s[i] > arrival_s[i - 1]) out.push_back({i, 0, arrival_s[i]});
    ++out.back().count;
  }
  return out;
}

double median(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  const std::size_t middle = values.size() / 2;
  return values.size() % 2 == 1 ? values[middle] : (values[middle - 1] + values[middle]) / 2.0;
}

double usual_step_s(const std::vector<Burst>& bursts) {
  if (bursts.size() < 2) return kUsualStep_s;
  std::vector<double> steps;
  for (std::size_t b = 1; b < bursts.size(); ++b)
    steps.push_back((bursts[b].arrival_s - bursts[b - 1].arrival_s) /
                    static_cast<double>(bursts[b].count));
  return median(std::move(steps));
}

ClockSettings whole_recording() {
  ClockSettings settings;
  settings.window_s = std::numeric_limits<double>::infinity();
  settings.late_for_s = kLateFor_s;
  return settings;
}

// The end of the part, from begin on, in which the device's clock does not step.
std::size_t end_of_segment(std::span<const double> device_s, std::span<const double> arrival_s,
                           std::size_t begin) {
  ClockModel clock(whole_recording());
  for (std::size_t i = begin; i < device_s.size(); ++i) {
    clock.observe(device_s[i], arrival_s[i]);
    if (clock.num_segments() > 1) return i + 1 - static_cast<std::size_t>(clock.num_at_begin());
  }
  const std::size_t late = device_s.size() - static_cast<std::size_t>(clock.num_late());
  const bool has_stepped =
      late < device_s.size() && arrival_s.back() - arrival_s[late] >= kLateForAtEnd_s;
  return has_stepped ? late : device_s.size();
}

// The parts in which the device's clock does not step, as the index of each end.
std::vector<std::size_t> segment_ends(std::span<const double> device_s,
                                      std::span<const double> arrival_s) {
  std::vector<std::size_t> ends;
  for (std::size_t begin = 0; begin < device_s.size(); begin = ends.back())
    ends.push_back(end_of_segment(device_s, arrival_s, begin));
  return ends;
}

// How far the seconds of the device and of the machine have gone, without the steps between.
struct Spans {
  double device_s = 0.0, arrival_s = 0.0;
  double longest_burst_s = 0.0;  // of the device's seconds that arrived at once

  double rate() const { return device_s > 0.0 ? arrival_s / device_s : 1.0; }
  bool is_real_time() const {
    const double apart_s = std::abs(arrival_s - device_s);
    return apart_s <= kLargestClockDrift * device_s || apart_s <= kUnsure_s + longest_burst_s;
  }
};

Spans spans_of(std::span<const double> device_s, std::span<const double> arrival_s,
               const std::vector<std::size_t>& ends) {
  Spans spans;
  std::size_t begin = 0;
  for (const std::size_t end : ends) {
    spans.device_s += device_s[end - 1] - device_s[begin];
    spans.arrival_s += arrival_s[end - 1] - arrival_s[begin];
    std::size_t first = begin;
    for (std::size_t i = begin; i < end; ++i) {
      if (arrival_s[i] > arrival_s[first]) first = i;
      spans.longest_burst_s = std::max(spans.longest_burst_s, device_s[i] - device_s[first]);
    }
    begin = end;
  }
  return spans;
}

}  // namespace

std::vector<double> spread_evenly(std::span<const double> arrival_s) {
  std::vector<double> times_s(arrival_s.begin(), arrival_s.end());
  if (times_s.size() < 2) return times_s;
  const std::vector<Burst> bursts = bursts_of(arrival_s);
  const double step_s = usual_step_s(bursts);
  double before_s = bursts[0].arrival_s - step_s * static_cast<double>(bursts[0].count);
  for (const Burst& burst : bursts) {
    const double room_s = burst.arrival_s - before_s;
    const double own_s = std::min(step_s, room_s / static_cast<double>(burst.count));
    for (std::size_t i = 0; i < burst.count; ++i)
      times_s[burst.first + i] -= static_cast<double>(burst.count - 1 - i) * own_s;
    before_s = burst.arrival_s;
  }
  make_ascending(times_s);
  return times_s;
}

HostTimes host_times(std::span<const double> device_s, std::span<const double> arrival_s) {
  if (device_s.size() != arrival_s.size())
    throw std::invalid_argument("host_times: one arrival for each time is needed");
  const auto is_time = [](double time_s) { return std::isfinite(time_s); };
  if (device_s.empty() || !std::all_of(device_s.begin(), device_s.end(), is_time))
    return {spread_evenly(arrival_s), 1.0};
  const std::vector<std::size_t> ends = segment_ends(device_s, arrival_s);
  const Spans spans = spans_of(device_s, arrival_s, ends);
  HostTimes out{{}, spans.rate()};
  if (!spans.is_real_time()) {
    for (const double time_s : device_s)
      out.times_s.push_back(arrival_s.front() + time_s - device_s.front());
  } else {
    std::size_t begin = 0;
    for (const std::size_t end : ends) {
      ClockModel clock(whole_recording());
      for (std::size_t i = begin; i < end; ++i) clock.observe(device_s[i], arrival_s[i]);
      for (std::size_t i = begin; i < end; ++i)
        out.times_s.push_back(clock.host_time_s(device_s[i]));
      out.rate = 1.0 + 1e-6 * clock.drift_ppm();
      begin = end;
    }
  }
  make_ascending(out.times_s);
  return out;
}

}  // namespace sparse_mocap
