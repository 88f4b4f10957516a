// SPDX-License-Identifier: GPL-3.0-or-later
#include "sparse_mocap/tautges2011/reconstructor.hpp"

#include <string>
#include <utility>

#include "sparse_mocap/base/errors.hpp"
#include "sparse_mocap/motion/heading.hpp"
#include "sparse_mocap/retrieval/diagnostics.hpp"
#include "sparse_mocap/retrieval/extremity_vote.hpp"
#include "sparse_mocap/retrieval/pose_minimizer.hpp"
#include "sparse_mocap/tautges2011/control.hpp"

namespace sparse_mocap::tautges2011 {

using namespace retrieval;

Reconstructor::Reconstructor(const Config& config, const MethodContext& context)
    : database_(context.database),
      signals_(compared_signals(context.sensors, false)),
      num_sensors_(static_cast<Eigen::Index>(context.sensors.size())),
      signal_rows_(database_signals(*database_, signals_)),
      index_(signal_rows_, searched_frames(*database_, false, context.excluded_clips)),
      config_(config.scaled_to(index_.num_rows())),
      energy_model_(make_energy_model(config_)),
      graph_(clips_of_frames(*database_),
             {config_.penalty, 1.0, config_.window_readings, config_.is_time_warping}),
      root_(database_->frame_time_s()),
      follower_(config_.follow_s, database_->frame_time_s()) {}

std::optional<PoseEstimate> Reconstructor::step(const Reading& reading) {
  require_sensors(reading, num_sensors_);
  const Eigen::RowVectorXf alpha = signal_row(reading, signals_);
  // Section 3: S^(t+1), the K frames of the database whose virtual readings are nearest.
  index_.search({alpha.data(), static_cast<std::size_t>(alpha.size())}, config_.num_neighbours,
                nearest_);
  // Section 4: the online lazy neighbourhood graph takes them as its new column.
  graph_.extend(nearest_);
  // Section 5: the I paths of least cost C, weights W (equation (1)), poses Q and X, V and A.
  auto paths = best_paths(graph_.paths(), config_.num_paths);
  auto weights = linear_weights(paths);
  const Neighbourhood neighbours =
      gather(*database_, std::move(paths), std::move(weights), past_ ? &past_->angles : nullptr);
  const PathDerivatives derivatives = path_derivatives(*database_, neighbours.paths);
  // Sections 5.1 and 5.2: the energy, equations (2) to (11).
  const Energy energy(
      skeleton(), neighbours.weights,
      energy_model_->terms({neighbours, derivatives, past_, signals_, database_->frame_time_s()}));
  // Section 5.3: q_best in the local linear model of the poses.
  const PoseSubspace subspace =
      weighted_pca(neighbours.angles, neighbours.weights, config_.pca_variance);
  const Eigen::VectorXd q_best =
      minimize(energy, subspace, starts(neighbours, subspace), config_.max_iterations).angles;
  // Section 6.4: the root moves as the retrieved motions do in the mean.
  PoseEstimate estimate = remember(reading, q_best, root_rates(*database_, neighbours));
  follower_.apply(estimate);
  estimate.extremities = extremity_vote(*database_, neighbours);
  estimate.diagnostics =
      retrieval_diagnostics(*database_, neighbours, signals_, signal_rows_, alpha);
  return estimate;
}

std::vector<PoseEstimate> Reconstructor::flush() {
  reset();
  return {};
}

void Reconstructor::reset() {
  graph_.reset();
  root_.reset();
  past_.reset();
  follower_.reset();
}

// The previous pose; in the first frame the mean and the best path's pose.
std::vector<Eigen::VectorXd> Reconstructor::starts(const Neighbourhood& neighbours,
                                                   const PoseSubspace& subspace) const {
  if (past_) return {past_->angles};
  return {subspace.mean, neighbours.angles.col(0)};
}

PoseEstimate Reconstructor::remember(const Reading& reading, const Eigen::VectorXd& angles,
                                     const RootRates& rates) {
  JointTransforms pose;
  forward_kinematics(skeleton(), Vec3::Zero(), angles, pose);
  const Eigen::VectorXd positions = stacked_ends(pose);
  root_.advance(rates);
  past_ = Past{angles, positions, past_ ? past_->positions : positions,
               heading_accelerations(reading, pose, signals_)};
  return {reading.time_s,
          pose_rotations(skeleton(), angles, root_.yaw_rad()),
          root_.position(),
          rates.contacts,
          {},
          {}};
}

}  // namespace sparse_mocap::tautges2011
