// SPDX-License-Identifier: GPL-3.0-or-later
#include "sparse_mocap/path_regression/pose_modes.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace sparse_mocap::path_regression {
namespace {

constexpr std::size_t kMostModes = 4;
constexpr double kLeastShare = 0.02;

// Of likeliest_modes, in natural logarithms of shares of a frame at 25 Hz.
constexpr double kPreference = 2.5;      // of modes
constexpr double kTurning = 3.0;         // to leave the known motion, or to return to it
constexpr double kUsualSpeed_mps = 1.0;  // of joints, mean; up to there jumps cost nothing
constexpr double kFastest = 4.0;         // times as fast nothing moves
constexpr double kFrame_s = 0.04;

Eigen::VectorXf distances_m(const Eigen::MatrixXf& positions, const Eigen::VectorXf& pose) {
  Eigen::VectorXf distances(positions.cols());
  for (Eigen::Index i = 0; i < positions.cols(); ++i)
    distances[i] = static_cast<float>(pose_distance_m(positions.col(i), pose));
  return distances;
}

// The weights of poses that are like this one, others being 0.
Eigen::VectorXf weights_alike(const Eigen::MatrixXf& positions, const Eigen::VectorXf& weights,
                              const Eigen::VectorXf& pose) {
  return (distances_m(positions, pose).array() <= static_cast<float>(kAlike_m))
      .select(weights, 0.0F);
}

// From the heaviest pose to where those around it are densest; nothing where that is empty.
PoseMode mode_from(const Eigen::MatrixXf& positions, const Eigen::VectorXf& weights) {
  constexpr int kShifts = 3;
  Eigen::Index heaviest = 0;
  weights.maxCoeff(&heaviest);
  PoseMode mode{positions.col(heaviest), 0.0};
  for (int shift = 0; shift <= kShifts; ++shift) {
    const Eigen::VectorXf near = weights_alike(positions, weights, mode.positions);
    mode.share = static_cast<double>(near.sum());
    if (shift == kShifts || mode.share <= 0.0) break;
    mode.positions.noalias() = positions * (near / near.sum());
  }
  return mode;
}

// State 0 is the known motion, state i + 1 mode i.
Eigen::VectorXd gains(const FrameModes& frame, double num_frames) {
  constexpr double kSome = 1e-3;  // so that nothing counts infinitely
  Eigen::VectorXd out = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(frame.modes.size()) + 1);
  for (std::size_t i = 0; i < frame.modes.size(); ++i) {
    const double ratio = (frame.modes[i].share + kSome) / (frame.known_share + kSome);
    out[static_cast<Eigen::Index>(i) + 1] = num_frames * (std::log(ratio) + kPreference);
  }
  return out;
}

double cost(const FrameModes& from, std::size_t a, const FrameModes& to, std::size_t b,
            double frame_time_s) {
  if (a == 0 || b == 0) return a == b ? 0.0 : kTurning;
  const double jump_m = pose_distance_m(from.modes[a - 1].positions, to.modes[b - 1].positions);
  const double speed = jump_m / (kUsualSpeed_mps * frame_time_s);
  if (speed > kFastest) return std::numeric_limits<double>::infinity();
  const double beyond = std::max(speed - 1.0, 0.0);
  return beyond * beyond;
}

}  // namespace

double pose_distance_m(const Eigen::Ref<const Eigen::VectorXf>& a,
                       const Eigen::Ref<const Eigen::VectorXf>& b) {
  float sum = 0.0F;
  for (Eigen::Index i = 0; i + 2 < a.size(); i += 3)
    sum += (a.segment<3>(i) - b.segment<3>(i)).norm();
  return 3.0 * static_cast<double>(sum) / static_cast<double>(a.size());
}

bool is_alike(const Eigen::Ref<const Eigen::VectorXf>& pose,
              std::span<const Eigen::VectorXf> others) {
  return std::any_of(others.begin(), others.end(), [&](const Eigen::VectorXf& other) {
    return pose_distance_m(pose, other) <= kAlike_m;
  });
}

FrameModes modes_of(const Eigen::MatrixXf& positions, const Eigen::VectorXd& weights,
                    std::span<const Eigen::VectorXf> known) {
  FrameModes frame;
  Eigen::VectorXf left = weights.cast<float>();
  for (const auto& pose : known) {
    const Eigen::VectorXf near = weights_alike(positions, left, pose);
    if (&pose == known.data()) frame.known_share = static_cast<double>(near.sum());
    left -= near;
  }
  while (static_cast<double>(left.sum()) >= kLeastShare && frame.modes.size() < kMostModes) {
    PoseMode mode = mode_from(positions, left);
    if (mode.share <= 0.0) break;
    left -= weights_alike(positions, left, mode.positions);
    if (mode.share >= kLeastShare && !is_alike(mode.positions, known))
      frame.modes.push_back(std::move(mode));
  }
  std::stable_sort(frame.modes.begin(), frame.modes.end(),
                   [](const PoseMode& a, const PoseMode& b) { return a.share > b.share; });
  return frame;
}

double likelihood(std::span<const FrameModes> frames,
                  std::span<const std::optional<std::size_t>> modes, double frame_time_s) {
  const auto state = [&](std::size_t t) { return modes[t] ? *modes[t] + 1 : 0; };
  double sum = 0.0;
  for (std::size_t t = 0; t < frames.size(); ++t) {
    sum += gains(frames[t], frame_time_s / kFrame_s)[static_cast<Eigen::Index>(state(t))];
    if (t > 0) sum -= cost(frames[t - 1], state(t - 1), frames[t], state(t), frame_time_s);
  }
  return sum;
}

std::vector<std::optional<std::size_t>> likeliest_modes(std::span<const FrameModes> frames,
                                                        double frame_time_s) {
  std::vector<std::optional<std::size_t>> chosen(frames.size());
  if (frames.empty()) return chosen;
  const double num_frames = frame_time_s / kFrame_s;
  std::vector<std::vector<std::size_t>> from(frames.size());
  Eigen::VectorXd reached = gains(frames[0], num_frames);
  for (std::size_t t = 1; t < frames.size(); ++t) {
    Eigen::VectorXd here = gains(frames[t], num_frames);
    for (Eigen::Index b = 0; b < here.size(); ++b) {
      double best = -std::numeric_limits<double>::infinity();
      std::size_t& best_from = from[t].emplace_back(0);
      for (Eigen::Index a = 0; a < reached.size(); ++a) {
        const auto state = static_cast<std::size_t>(a);
        const double value = reached[a] - cost(frames[t - 1], state, frames[t],
                                               static_cast<std::size_t>(b), frame_time_s);
        if (value > best) {
          best = value;
          best_from = state;
        }
      }
      here[b] += best;
    }
    reached = std::move(here);
  }
  Eigen::Index last = 0;
  reached.maxCoeff(&last);
  auto state = static_cast<std::size_t>(last);
  for (std::size_t t = frames.size(); t-- > 0;) {
    if (state > 0) chosen[t] = state - 1;
    if (t > 0) state = from[t][state];
  }
  return chosen;
}

}  // namespace sparse_mocap::path_regression
