// SPDX-License-Identifier: GPL-3.0-or-later
#include "sparse_mocap/path_regression/take_headings.hpp"

#include <algorithm>
#include <limits>
#include <span>

#include "sparse_mocap/path_regression/sensor_headings.hpp"
#include "sparse_mocap/path_regression/take_search.hpp"

namespace sparse_mocap::path_regression {
namespace {

using Hints = std::vector<std::vector<HeadingHint>>;

constexpr double kLong_s = 45.0;
constexpr double kStretch_s = 5.0;
constexpr std::size_t kOfStretches = 3;  // of a long take one in three is searched

bool is_long(const FrameSolver& solver, std::size_t num_readings) {
  return static_cast<double>(num_readings) > kLong_s * solver.database().rate_hz();
}

// What these readings of a take say of headings. at(number of them that are searched) may throw.
void put_hints(const FrameSolver& solver, int num_threads, std::span<const Reading> readings,
               const std::function<void(std::size_t)>& at,
               std::span<std::vector<HeadingHint>> hints) {
  std::vector<Reading> without(readings.begin(), readings.end());
  for (Reading& reading : without)
    reading.orientation.setConstant(std::numeric_limits<double>::quiet_NaN());
  const retrieval::FeatureRows signals = signal_rows(without, solver.signals());
  const TwoWayPaths paths = paths_of(solver, signals, num_threads, at);
  auto found = in_parallel<std::vector<HeadingHint>>(
      readings.size(), num_threads, [&](std::size_t) { at(readings.size()); },
      [&](std::size_t t) {
        static thread_local std::vector<Mat3> posed;
        solver.retrieve_posed_sensors(paths.paths(t), window_at(signals, t), posed);
        std::vector<HeadingHint> of_reading;
        put_heading_hints(readings[t], posed, of_reading);
        return of_reading;
      });
  std::move(found.begin(), found.end(), hints.begin());
}

}  // namespace

bool asks_for_headings(const FrameSolver& solver, std::size_t num_readings) {
  return solver.has_own_headings() || (solver.has_headings() && is_long(solver, num_readings));
}

// Headings drift slowly, so a long take tells them by a part of its readings.
void share_headings(const FrameSolver& solver, int num_threads, const Progress& progress,
                    std::vector<Reading>& take) {
  const auto stretch = static_cast<std::size_t>(kStretch_s * solver.database().rate_hz());
  const std::size_t length = is_long(solver, take.size()) ? stretch : take.size();
  Hints hints(take.size());
  for (std::size_t t = 0; t < take.size(); ++t) put_no_hints(take[t], hints[t]);
  for (std::size_t begin = 0; begin < take.size(); begin += kOfStretches * length) {
    const std::size_t count = std::min(length, take.size() - begin);
    const auto at = [&](std::size_t t) { progress.report(begin + t, take.size(), "searching"); };
    put_hints(solver, num_threads, std::span(take).subspan(begin, count), at,
              std::span(hints).subspan(begin, count));
  }
  const auto offsets_rad = whole_take_offsets(solver.headings(), hints);
  for (std::size_t t = 0; t < take.size(); ++t) turn_headings(offsets_rad[t], take[t]);
}

}  // namespace sparse_mocap::path_regression
