// SPDX-License-Identifier: GPL-3.0-or-later
#include "sparse_mocap/tautges2011/neighbourhood.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace sparse_mocap::tautges2011 {

std::vector<Path> best_paths(std::span<const Path> paths, int num_paths) {
  std::vector<Path> best(paths.begin(), paths.end());
  const auto count = std::min(best.size(), static_cast<std::size_t>(num_paths));
  const auto last = best.begin() + static_cast<std::ptrdiff_t>(count);
  const auto is_better = [](const Path& a, const Path& b) {
    return a.reward != b.reward ? a.reward > b.reward : a.frame < b.frame;
  };
  std::partial_sort(best.begin(), last, best.end(), is_better);
  best.erase(last, best.end());
  return best;
}

Eigen::VectorXd path_weights(std::span<const Path> paths, WeightRule rule, double sharpness) {
  const auto n = static_cast<Eigen::Index>(paths.size());
  Eigen::VectorXd rewards(n);
  for (Eigen::Index i = 0; i < n; ++i) rewards[i] = paths[static_cast<std::size_t>(i)].reward;
  Eigen::VectorXd weights;
  if (rule == WeightRule::linear) {
    weights = rewards.array() - rewards.minCoeff();
  } else {
    const double mean = rewards.mean();
    const double deviation = std::sqrt((rewards.array() - mean).square().mean());
    const double scale = deviation > 0.0 ? sharpness / deviation : 0.0;
    weights = (scale * (rewards.array() - rewards.maxCoeff())).exp();
  }
  const double total = weights.sum();
  if (total <= 0.0) return Eigen::VectorXd::Constant(n, 1.0 / static_cast<double>(n));
  return weights / total;
}

void kinematics_at(const MotionDatabase& database, int frame, Eigen::Ref<Eigen::VectorXd> velocity,
                   Eigen::Ref<Eigen::VectorXd> acceleration) {
  const Clip& clip = database.clips()[static_cast<std::size_t>(database.clip_index(frame))];
  const double dt = database.frame_time_s();
  if (clip.num_frames() < 3) {
    velocity.setZero();
    acceleration.setZero();
    return;
  }
  const int centre = std::clamp(frame, clip.begin + 1, clip.end - 2);
  const auto row = [&](int n) { return database.positions().row(n).transpose().cast<double>(); };
  velocity = (row(centre + 1) - row(centre - 1)) / (2.0 * dt);
  acceleration = (row(centre + 1) - 2.0 * row(centre) + row(centre - 1)) / (dt * dt);
}

namespace {

// The rows of the database positions that lead into a frame from the one before, inside its clip.
Eigen::VectorXd step_into(const MotionDatabase& database, const Clip& clip, int frame) {
  const int into = std::max(frame, std::min(clip.begin + 1, clip.end - 1));
  const int from = std::max(into - 1, clip.begin);
  return (database.positions().row(into) - database.positions().row(from))
      .transpose()
      .cast<double>();
}

void gather_derivatives(const MotionDatabase& database, Neighbourhood& out) {
  const Eigen::Index dimensions = database.positions().cols();
  const auto n = static_cast<Eigen::Index>(out.paths.size());
  for (auto* matrix : {&out.velocities, &out.accelerations, &out.velocities_before})
    matrix->resize(dimensions, n);
  Eigen::VectorXd unused(dimensions);
  for (Eigen::Index i = 0; i < n; ++i) {
    const Path& path = out.paths[static_cast<std::size_t>(i)];
    const Clip& clip = database.clips()[static_cast<std::size_t>(database.clip_index(path.frame))];
    kinematics_at(database, path.frame, out.velocities.col(i), out.accelerations.col(i));
    const int before =
        path.previous_frame >= 0 ? path.previous_frame : std::max(path.frame - 1, clip.begin);
    kinematics_at(database, before, out.velocities_before.col(i), unused);
  }
}

bool needs_derivatives(const Config& config) {
  return config.w_smooth > 0.0 || config.w_contr > 0.0 ||
         (config.w_motion > 0.0 && config.motion_rule == MotionRule::taylor);
}

}  // namespace

Neighbourhood gather(const MotionDatabase& database, const Config& config, std::vector<Path> paths,
                     Eigen::VectorXd weights, const Eigen::VectorXd* near_angles) {
  Neighbourhood out;
  out.paths = std::move(paths);
  out.weights = std::move(weights);
  const auto n = static_cast<Eigen::Index>(out.paths.size());
  out.angles.resize(database.angles().cols(), n);
  out.positions.resize(database.positions().cols(), n);
  out.steps.resize(database.positions().cols(), n);
  for (Eigen::Index i = 0; i < n; ++i) {
    const int frame = out.paths[static_cast<std::size_t>(i)].frame;
    const Clip& clip = database.clips()[static_cast<std::size_t>(database.clip_index(frame))];
    out.angles.col(i) = database.angles().row(frame).transpose().cast<double>();
    out.positions.col(i) = database.positions().row(frame).transpose().cast<double>();
    out.steps.col(i) = step_into(database, clip, frame);
  }
  if (needs_derivatives(config)) gather_derivatives(database, out);
  if (near_angles != nullptr) unwind_pose(database.skeleton(), *near_angles, out.angles.col(0));
  const Eigen::VectorXd best = out.angles.col(0);
  for (Eigen::Index i = 1; i < n; ++i) unwind_pose(database.skeleton(), best, out.angles.col(i));
  return out;
}

}  // namespace sparse_mocap::tautges2011
