// SPDX-License-Identifier: GPL-3.0-or-later
#include "sparse_mocap/tautges2011/reconstructor.hpp"

#include <array>
#include <span>

#include "sparse_mocap/motion/heading.hpp"
#include "sparse_mocap/retrieval/diagnostics.hpp"
#include "sparse_mocap/retrieval/extremity_vote.hpp"
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
      alpha_(static_cast<Eigen::Index>(3 * signals_.size())),
      energy_(database_->skeleton()),
      follower_(config_.follow_s, database_->frame_time_s()) {}

std::optional<PoseEstimate> Reconstructor::step(const Reading& reading) {
  PoseEstimate estimate;
  step_into(reading, estimate);
  return estimate;
}

bool Reconstructor::step_into(const Reading& reading, PoseEstimate& estimate) {
  require_sensors(reading, num_sensors_);
  put_signals(reading, signals_, alpha_);
  // Section 3: S^(t+1), the K frames of the database whose virtual readings are nearest.
  index_.search({alpha_.data(), static_cast<std::size_t>(alpha_.size())}, config_.num_neighbours,
                nearest_);
  // Section 4: the online lazy neighbourhood graph takes them as its new column.
  graph_.extend(nearest_);
  // Section 5: the I paths of least cost C, weights W (equation (1)), poses Q and X, V and A.
  put_best_paths(graph_.paths(), config_.num_paths, neighbours_.paths);
  put_linear_weights(neighbours_.paths, neighbours_.weights);
  put_poses(*database_, past_ ? &past_->angles : nullptr, neighbours_);
  if (config_.pose == PoseSource::energy) put_energy();
  // Section 5.3: q_best in the local linear model of the poses.
  put_weighted_pca(neighbours_.angles, neighbours_.weights, config_.pca_variance, subspace_);
  const Minimum best = best_pose();
  remember(reading, best.angles);
  // Section 6.4: the root moves as the retrieved motions do in the mean.
  put_pose(reading.time_s, root_rates(*database_, neighbours_), estimate);
  follower_.apply(estimate);
  estimate.extremities = extremity_vote(*database_, neighbours_);
  put_retrieval_diagnostics(*database_, neighbours_, signals_, signal_rows_, alpha_,
                            estimate.diagnostics);
  estimate.diagnostics["components"].setConstant(1, static_cast<double>(subspace_.basis.cols()));
  estimate.diagnostics["iterations"].setConstant(1, best.iterations);
  return true;
}

// Sections 5.1 and 5.2: the energy, equations (2) to (11).
void Reconstructor::put_energy() {
  put_path_derivatives(*database_, neighbours_.paths, derivatives_);
  energy_.weights() = neighbours_.weights;
  energy_model_->put_terms({neighbours_, derivatives_, past_, signals_, database_->frame_time_s()},
                           energy_.terms());
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

// From the previous pose; in the first frame from the mean or the best path's pose.
Minimum Reconstructor::best_pose() const {
  if (config_.pose == PoseSource::mean) return {subspace_.mean, 0.0, 0, true};
  const std::array<PoseVector, 2> first{subspace_.mean, neighbours_.angles.col(0)};
  const std::array<PoseVector, 1> next{past_ ? PoseVector(past_->angles) : PoseVector()};
  const auto starts =
      past_ ? std::span<const PoseVector>(next) : std::span<const PoseVector>(first);
  return minimize(energy_, subspace_, starts, config_.max_iterations);
}

void Reconstructor::remember(const Reading& reading, const PoseVector& angles) {
  const bool is_first = !past_;
  if (is_first) past_.emplace();
  past_->angles = angles;
  forward_kinematics(skeleton(), Vec3::Zero(), past_->angles, pose_);
  past_->positions_before.swap(past_->positions);
  past_->positions.resize(3 * skeleton().num_joints());
  for (std::size_t j = 0; j < pose_.end.size(); ++j)
    past_->positions.segment<3>(3 * static_cast<Eigen::Index>(j)) = pose_.end[j];
  if (is_first) past_->positions_before = past_->positions;
  put_heading_accelerations(reading, pose_, signals_, past_->accelerations);
}

// The pose that is remembered, in the world.
void Reconstructor::put_pose(double time_s, const RootRates& rates, PoseEstimate& estimate) {
  root_.advance(rates);
  estimate.time_s = time_s;
  estimate.root_position = root_.position();
  estimate.contacts = rates.contacts;
  estimate.rotations.clear();
  for (int j = 0; j < skeleton().num_joints(); ++j)
    estimate.rotations.emplace_back(
        joint_rotation(skeleton().joint(j), past_->angles.data() + skeleton().angle_begin(j)));
  estimate.rotations[0] = Quat(yaw_rotation(root_.yaw_rad())) * estimate.rotations[0];
}

}  // namespace sparse_mocap::tautges2011
