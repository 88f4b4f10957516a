// SPDX-License-Identifier: GPL-3.0-or-later
#include "sparse_mocap/retrieval/neighbourhood.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace sparse_mocap::retrieval {
namespace {

void put_rewards(std::span<const Path> paths, Eigen::VectorXd& rewards) {
  rewards.resize(static_cast<Eigen::Index>(paths.size()));
  for (Eigen::Index i = 0; i < rewards.size(); ++i)
    rewards[i] = paths[static_cast<std::size_t>(i)].reward;
}

void normalise(Eigen::VectorXd& weights) {
  const double total = weights.sum();
  if (total <= 0.0)
    weights.setConstant(1.0 / static_cast<double>(weights.size()));
  else
    weights /= total;
}

}  // namespace

std::vector<Path> best_paths(std::span<const Path> paths, int num_paths) {
  std::vector<Path> best;
  put_best_paths(paths, num_paths, best);
  return best;
}

void put_best_paths(std::span<const Path> paths, int num_paths, std::vector<Path>& best) {
  best.assign(paths.begin(), paths.end());
  const auto count = std::min(best.size(), static_cast<std::size_t>(num_paths));
  const auto last = best.begin() + static_cast<std::ptrdiff_t>(count);
  const auto is_better = [](const Path& a, const Path& b) {
    return a.reward != b.reward ? a.reward > b.reward : a.frame < b.frame;
  };
  std::nth_element(best.begin(), last, best.end(), is_better);
  std::sort(best.begin(), last, is_better);
  best.erase(last, best.end());
}

Eigen::VectorXd linear_weights(std::span<const Path> paths) {
  Eigen::VectorXd weights;
  put_linear_weights(paths, weights);
  return weights;
}

void put_linear_weights(std::span<const Path> paths, Eigen::VectorXd& weights) {
  put_rewards(paths, weights);
  weights.array() -= weights.minCoeff();
  normalise(weights);
}

Eigen::VectorXd softmax_weights(std::span<const Path> paths, double sharpness) {
  Eigen::VectorXd weights;
  put_softmax_weights(paths, sharpness, weights);
  return weights;
}

void put_softmax_weights(std::span<const Path> paths, double sharpness, Eigen::VectorXd& weights) {
  put_rewards(paths, weights);
  const double mean = weights.mean(), best = weights.maxCoeff();
  const double deviation = std::sqrt((weights.array() - mean).square().mean());
  const double scale = deviation > 0.0 ? sharpness / deviation : 0.0;
  weights = (scale * (weights.array() - best)).exp();
  normalise(weights);
}

Neighbourhood gather(const MotionDatabase& database, std::vector<Path> paths,
                     Eigen::VectorXd weights, const Eigen::VectorXd* near_angles) {
  Neighbourhood out;
  out.paths = std::move(paths);
  out.weights = std::move(weights);
  put_poses(database, near_angles, out);
  return out;
}

void put_poses(const MotionDatabase& database, const Eigen::VectorXd* near_angles,
               Neighbourhood& out) {
  const auto n = static_cast<Eigen::Index>(out.paths.size());
  out.angles.resize(database.angles().cols(), n);
  out.positions.resize(database.positions().cols(), n);
  for (Eigen::Index i = 0; i < n; ++i) {
    const int frame = out.paths[static_cast<std::size_t>(i)].frame;
    out.angles.col(i) = database.angles().row(frame).transpose().cast<double>();
    out.positions.col(i) = database.positions().row(frame).transpose().cast<double>();
  }
  if (near_angles != nullptr) unwind_pose(database.skeleton(), *near_angles, out.angles.col(0));
  static thread_local Eigen::VectorXd best;
  best = out.angles.col(0);
  for (Eigen::Index i = 1; i < n; ++i) unwind_pose(database.skeleton(), best, out.angles.col(i));
}

std::vector<std::int32_t> clips_of_frames(const MotionDatabase& database) {
  std::vector<std::int32_t> clips;
  for (int frame = 0; frame < database.num_frames(); ++frame)
    clips.push_back(database.clip_index(frame));
  return clips;
}

const Clip& clip_at(const MotionDatabase& database, int frame) {
  return database.clips()[static_cast<std::size_t>(database.clip_index(frame))];
}

}  // namespace sparse_mocap::retrieval
