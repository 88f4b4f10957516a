// SPDX-License-Identifier: GPL-3.0-or-later
#include "sparse_mocap/liu2011/reconstructor.hpp"

#include <algorithm>
#include <utility>

#include "sparse_mocap/liu2011/pose_priors.hpp"
#include "sparse_mocap/retrieval/diagnostics.hpp"
#include "sparse_mocap/retrieval/extremity_vote.hpp"
#include "sparse_mocap/retrieval/root_motion.hpp"

namespace sparse_mocap::liu2011 {
namespace {

std::vector<BodyPose> in_frame(const std::vector<BodyPose>& poses, const HeadingFrame& frame) {
  std::vector<BodyPose> out;
  for (const BodyPose& pose : poses) out.push_back(frame.from_parent(pose));
  return out;
}

retrieval::WeightedPaths as_paths(const std::vector<retrieval::Neighbour>& nearest,
                                  const Eigen::VectorXd& weights) {
  retrieval::WeightedPaths weighted;
  weighted.weights = weights / weights.sum();
  for (const auto& neighbour : nearest) {
    weighted.paths.push_back({});
    weighted.paths.back().frame = neighbour.row;
  }
  return weighted;
}

}  // namespace

Reconstructor::Reconstructor(const Config& config, const MethodContext& context)
    : examples_(context.database, context.body.value_or(context.database->skeleton())),
      config_(config),
      control_(config.control()),
      num_poses_(config.num_poses(context.database->rate_hz())),
      worn_(worn_sensors(examples_.body(), context.sensors)),
      is_searched_(retrieval::searched_frames(*context.database, false, context.excluded_clips)),
      search_(examples_, worn_,
              {num_poses_, config.search_position_per_m, config.search_orientation}, is_searched_),
      start_(examples_, is_searched_),
      signals_(retrieval::compared_signals(context.sensors, false)),
      signal_rows_(retrieval::database_signals(*context.database, signals_)) {}

std::optional<PoseEstimate> Reconstructor::step(const Reading& reading) {
  require_sensors(reading, static_cast<Eigen::Index>(worn_.size()));
  if (recent_.empty())
    recent_ = start_.history(observations(reading, worn_, {}), control_, num_poses_);
  const HeadingFrame frame = heading_frame_of(skeleton(), recent_.front(), yaw_rad_);
  const std::vector<BodyPose> recent = in_frame(recent_, frame);                  // Q-tilde
  const std::vector<Observation> observed = observations(reading, worn_, frame);  // c_t
  // Section 5: the K closest examples, and the model that is learnt from them, equations (2) to
  // (8).
  search_.search(recent, observed, config_.num_neighbours, nearest_);
  const LocalExamples examples = local_examples(examples_, nearest_, num_poses_);
  const PosePrior prior = pose_prior(skeleton(), examples, recent, config_);
  // Section 6: the pose of least E_control + E_prior, equations (9) to (14), from the closest one.
  const BodyPose start = config_.prior == PriorModel::inverse_kinematics
                             ? recent.front()
                             : examples_.next(nearest_.front().row);
  Estimate estimate =
      map_estimate(skeleton(), observed, control_, prior, start, config_.max_iterations);
  yaw_rad_ = frame.yaw_rad;
  remember(frame.to_parent(std::move(estimate.pose)));
  return told(reading, examples.weights);
}

std::vector<PoseEstimate> Reconstructor::flush() {
  reset();
  return {};
}

void Reconstructor::reset() {
  recent_.clear();
  yaw_rad_ = 0.0;
}

void Reconstructor::remember(BodyPose pose) {
  recent_.pop_back();
  recent_.insert(recent_.begin(), std::move(pose));
}

// The newest pose, and what the examples say of it.
PoseEstimate Reconstructor::told(const Reading& reading, const Eigen::VectorXd& weights) const {
  const auto weighted = as_paths(nearest_, weights);
  const BodyPose& pose = recent_.front();
  PoseEstimate estimate;
  estimate.time_s = reading.time_s;
  for (const Mat3& R : pose.rotations) estimate.rotations.push_back(Quat(R).normalized());
  estimate.root_position = pose.root_position;
  estimate.contacts = retrieval::root_rates(examples_.database(), weighted).contacts;
  estimate.extremities = retrieval::extremity_vote(examples_.database(), weighted);
  estimate.diagnostics =
      retrieval::retrieval_diagnostics(examples_.database(), weighted, signals_, signal_rows_,
                                       retrieval::signal_row(reading, signals_));
  return estimate;
}

}  // namespace sparse_mocap::liu2011
