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
constexpr double kShortest_s = 0.5;  // recordings that tell a clock's rate by their ends

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

double slope(std::span<const double> x, std::span<const double> y) {
  const double length = x.back() - x.front();
  return length > 0.0 ? (y.back() - y.front()) / length : 1.0;
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
  HostTimes out{{}, slope(device_s, arrival_s)};
  double offset_s = arrival_s.front() - device_s.front(), rate = 1.0;
  if (std::abs(out.rate - 1.0) <= kLargestClockDrift ||
      device_s.back() - device_s.front() <= kShortest_s) {
    ClockModel clock({.window_s = std::numeric_limits<double>::infinity()});
    for (std::size_t i = 0; i < device_s.size(); ++i) clock.observe(device_s[i], arrival_s[i]);
    out.rate = rate = 1.0 + 1e-6 * clock.drift_ppm();
    offset_s = clock.offset_s();
  }
  for (const double time_s : device_s) out.times_s.push_back(rate * time_s + offset_s);
  make_ascending(out.times_s);
  return out;
}

}  // namespace sparse_mocap
