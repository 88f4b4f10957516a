// SPDX-License-Identifier: GPL-3.0-or-later
#include "sparse_mocap/eom2014/phases.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "sparse_mocap/base/errors.hpp"

namespace sparse_mocap::eom2014 {
namespace {

constexpr double kShortest_s = 0.1;  // of a stand or swing
constexpr double kTogether_s = 0.1;  // feet that leave the floor within this jump
constexpr double kStanding_s = 0.4;  // longer on both feet than a step is

using Stands = std::array<std::vector<bool>, 2>;  // left, right

// The frame after the run of equal values that begins at a frame.
std::size_t run_end(const std::vector<bool>& values, std::size_t begin) {
  std::size_t end = begin;
  while (end < values.size() && values[end] == values[begin]) ++end;
  return end;
}

Stands stands_of(const Eigen::Matrix2Xd& contacts, double rate_hz) {
  const auto shortest = static_cast<std::size_t>(std::lround(kShortest_s * rate_hz));
  Stands stands;
  for (std::size_t side = 0; side < 2; ++side) {
    auto& on = stands[side];
    for (const double contact : contacts.row(static_cast<Eigen::Index>(side)))
      on.push_back(contact > 0.5);
    for (std::size_t begin = 0, end = 0; begin < on.size(); begin = end) {
      end = run_end(on, begin);
      const bool is_inside = begin > 0 && end < on.size();
      if (is_inside && end - begin < shortest)
        std::fill(on.begin() + static_cast<std::ptrdiff_t>(begin),
                  on.begin() + static_cast<std::ptrdiff_t>(end), on[begin - 1]);
    }
  }
  return stands;
}

// The frames in which both feet stand, for long or after a jump.
bool stands_for_long(const Stands& stands, std::size_t begin, double rate_hz) {
  std::size_t end = begin;
  while (end < stands[0].size() && stands[0][end] && stands[1][end]) ++end;
  return static_cast<double>(end - begin) >= kStanding_s * rate_hz;
}

bool leaves(const std::vector<bool>& on, std::size_t t) { return t > 0 && on[t - 1] && !on[t]; }

// The frame in which a foot lands or leaves next; the number of frames if it does not.
std::size_t next_change(const std::vector<bool>& on, std::size_t t) { return run_end(on, t); }

Phase first_phase(const Stands& stands, double rate_hz) {
  const bool left = stands[0][0], right = stands[1][0];
  const std::size_t left_change = next_change(stands[0], 0);
  const std::size_t right_change = next_change(stands[1], 0);
  if (left && right) {
    if (stands_for_long(stands, 0, rate_hz) || left_change == right_change) return Phase::standing;
    return left_change < right_change ? Phase::right_step : Phase::left_step;
  }
  if (left != right) return left ? Phase::right_step : Phase::left_step;
  const auto apart = static_cast<double>(std::max(left_change, right_change) -
                                         std::min(left_change, right_change));
  if (apart <= kTogether_s * rate_hz) return Phase::jump;
  return left_change > right_change ? Phase::left_step : Phase::right_step;
}

// What a foot that leaves the floor begins; last_left: when each foot left it.
Phase begun(std::size_t side, std::size_t t, const Stands& stands,
            const std::array<double, 2>& last_left, double rate_hz) {
  const std::size_t other = 1 - side;
  const bool is_with_other = static_cast<double>(t) - last_left[other] <= kTogether_s * rate_hz;
  if (!stands[other][t] && is_with_other) return Phase::jump;
  return side == 0 ? Phase::left_step : Phase::right_step;
}

bool is_step(Phase phase) { return phase == Phase::left_step || phase == Phase::right_step; }

// The step after standing becomes the start, and the one before it the stop; a single step between
// is neither.
void name_starts_and_stops(std::vector<Phase>& phases) {
  const std::vector<Phase> found = phases;
  for (std::size_t begin = 0, end = 0; begin < found.size(); begin = end) {
    while (end < found.size() && found[end] == found[begin]) ++end;
    if (!is_step(found[begin])) continue;
    const bool is_first = begin > 0 && found[begin - 1] == Phase::standing;
    const bool is_last = end < found.size() && found[end] == Phase::standing;
    if (is_first == is_last) continue;
    std::fill(phases.begin() + static_cast<std::ptrdiff_t>(begin),
              phases.begin() + static_cast<std::ptrdiff_t>(end),
              is_first ? Phase::start : Phase::stop);
  }
}

std::optional<Phase> phase_named(std::string_view name) {
  for (int p = 0; p < kNumPhases; ++p)
    if (name_of(static_cast<Phase>(p)) == name) return static_cast<Phase>(p);
  return std::nullopt;
}

std::string all_names() {
  std::string names;
  for (int p = 0; p < kNumPhases; ++p)
    names += (p == 0 ? "" : ", ") + std::string(name_of(static_cast<Phase>(p)));
  return names;
}

}  // namespace

std::string_view name_of(Phase phase) {
  static constexpr std::array<std::string_view, kNumPhases> kNames{
      "standing", "left_step", "right_step", "jump", "start", "stop"};
  return kNames.at(static_cast<std::size_t>(phase));
}

std::vector<Phase> phases_of(const Eigen::Matrix2Xd& contacts, double rate_hz) {
  if (contacts.cols() == 0) return {};
  const Stands stands = stands_of(contacts, rate_hz);
  std::vector<Phase> phases;
  Phase phase = first_phase(stands, rate_hz);
  std::array<double, 2> last_left{-1e9, -1e9};
  for (std::size_t t = 0; t < stands[0].size(); ++t) {
    const bool both = stands[0][t] && stands[1][t];
    const bool both_begin = both && t > 0 && !(stands[0][t - 1] && stands[1][t - 1]);
    if (both_begin && (phase == Phase::jump || stands_for_long(stands, t, rate_hz)))
      phase = Phase::standing;
    for (std::size_t side = 0; side < 2; ++side) {
      if (!leaves(stands[side], t)) continue;
      last_left[side] = static_cast<double>(t);
      phase = begun(side, t, stands, last_left, rate_hz);
      if (phase == Phase::jump)
        std::fill(phases.begin() + static_cast<std::ptrdiff_t>(last_left[1 - side]), phases.end(),
                  Phase::jump);
    }
    phases.push_back(phase);
  }
  name_starts_and_stops(phases);
  return phases;
}

int num_steps(const Eigen::Matrix2Xd& contacts, double rate_hz) {
  int count = 0;
  for (const auto& on : stands_of(contacts, rate_hz))
    for (std::size_t t = 1; t < on.size(); ++t) count += leaves(on, t) ? 1 : 0;
  return count;
}

std::vector<Segment> segments_of(const std::vector<Phase>& phases, double rate_hz) {
  std::vector<Segment> segments;
  for (std::size_t t = 0; t < phases.size(); ++t)
    if (t == 0 || phases[t] != phases[t - 1])
      segments.push_back({static_cast<double>(t) / rate_hz, std::string(name_of(phases[t]))});
  return segments;
}

std::vector<Phase> phases_from(const std::vector<Segment>& segments, Eigen::Index num_frames,
                               double rate_hz, const std::string& clip) {
  const std::string begin = "the phases of the clip '" + clip + "' ";
  if (segments.empty() || segments.front().begin_s != 0.0)
    throw ConfigError(begin + "do not begin at 0 s");
  std::vector<Phase> phases(static_cast<std::size_t>(num_frames));
  for (std::size_t s = 0; s < segments.size(); ++s) {
    const auto phase = phase_named(segments[s].label);
    if (!phase)
      throw ConfigError(begin + "have one named '" + segments[s].label + "'; choose from " +
                        all_names());
    if (s > 0 && !(segments[s].begin_s > segments[s - 1].begin_s))
      throw ConfigError(begin + "are not in the order of their times");
    const double first = std::round(segments[s].begin_s * rate_hz);
    if (first < static_cast<double>(num_frames))
      std::fill(phases.begin() + static_cast<std::ptrdiff_t>(first), phases.end(), *phase);
  }
  return phases;
}

}  // namespace sparse_mocap::eom2014
