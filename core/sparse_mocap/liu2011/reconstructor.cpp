// SPDX-License-Identifier: GPL-3.0-or-later
#include "sparse_mocap/liu2011/reconstructor.hpp"

#include <algorithm>
#include <utility>

#include "sparse_mocap/liu2011/pose_priors.hpp"
#include "sparse_mocap/liu2011/sensor_motion.hpp"
#include "sparse_mocap/motion/heading.hpp"
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

Reconstructor::Reconstructor(const Config& config, const MethodContext& context,
                             Direction direction)
    : is_searched_(retrieval::searched_frames(*context.database, false, context.excluded_clips)),
      examples_(context.database, context.body.value_or(context.database->skeleton()), direction,
                is_searched_),
      config_(config),
      control_(config.control()),
      num_poses_(config.num_poses(context.database->rate_hz())),
      worn_(worn_sensors(examples_.body(), context.sensors)),
      search_(examples_, worn_,
              {num_poses_, config.search_position_per_m, config.search_orientation}, is_searched_),
      start_(examples_, is_searched_),
      signals_(retrieval::compared_signals(context.sensors, false)),
      signal_rows_(retrieval::database_signals(*context.database, signals_)),
      drift_(worn_.size(), config.heading_drift_deg * kRadiansPerDegree, rate_hz()) {}

std::optional<PoseEstimate> Reconstructor::step(const Reading& reading) {
  require_sensors(reading, static_cast<Eigen::Index>(worn_.size()));
  if (recent_.empty())
    recent_ =
        start_.history(drift_.corrected(observations(reading, worn_, {})), control_, num_poses_);
  HeadingFrame frame = heading_frame_of(skeleton(), recent_.front(), yaw_rad_);
  Estimate estimate = estimated(frame, reading);
  restart_if_lost(reading, frame, estimate);
  yaw_rad_ = frame.yaw_rad;
  remember(frame.to_parent(std::move(estimate.pose)));
  accelerations_ = linear_accelerations(reading);
  return told(reading, nearest_weights_);
}

// c_t, in the heading frame of the newest pose.
std::vector<Observation> Reconstructor::observed_in(const HeadingFrame& frame,
                                                    std::span<const BodyPose> recent,
                                                    const Reading& reading) const {
  std::vector<Observation> observed = drift_.corrected(observations(reading, worn_, frame));
  if (config_.motion_deviation_m > 0.0 && accelerations_.cols() > 0)
    add_moved_positions(skeleton(), recent, yaw_rotation(-frame.yaw_rad) * accelerations_,
                        1.0 / rate_hz(), config_.motion_deviation_m / config_.sigma_position_m,
                        observed);
  return observed;
}

// The pose of the reading in the heading frame of the pose before.
Estimate Reconstructor::estimated(const HeadingFrame& frame, const Reading& reading) {
  const std::vector<BodyPose> recent = in_frame(recent_, frame);  // Q-tilde
  const std::vector<Observation> observed = observed_in(frame, recent, reading);
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
  nearest_weights_ = examples.weights;
  const PosteriorEnergy energy(skeleton(), observed, control_, prior);
  is_off_track_ = is_off_track(observed, control_, energy.control(estimate.pose));
  if (config_.heading_drift_deg > 0.0) {
    std::vector<SensorPose> expected;
    JointTransforms mean;
    forward_kinematics(skeleton(), examples.reference, mean);
    for (const Observation& one : observed) expected.push_back(sensor_pose(one.worn, mean));
    drift_.update(observed, expected);
  }
  return estimate;
}

// Begins anew from the sensors alone when they have been far off for a while, if that fits better.
void Reconstructor::restart_if_lost(const Reading& reading, HeadingFrame& frame,
                                    Estimate& estimate) {
  constexpr std::size_t kMostFrames = 8000;  // it must not hold up a live performance
  num_off_track_ = is_off_track_ ? num_off_track_ + 1 : 0;
  if (config_.restart_after_s <= 0.0 || num_off_track_ <= config_.restart_after_s * rate_hz())
    return;
  num_off_track_ = 0;
  const std::vector<BodyPose> before = recent_;
  const HeadingFrame frame_before = frame;
  recent_ = start_.history(drift_.corrected(observations(reading, worn_, {})), control_, num_poses_,
                           kMostFrames);
  frame = heading_frame_of(skeleton(), recent_.front(), yaw_rad_);
  accelerations_.resize(3, 0);
  Estimate anew = estimated(frame, reading);
  if (!is_off_track_ || anew.value < estimate.value) {
    estimate = std::move(anew);
    return;
  }
  recent_ = before;
  frame = frame_before;
}

std::vector<PoseEstimate> Reconstructor::flush() {
  reset();
  return {};
}

void Reconstructor::reset() {
  recent_.clear();
  yaw_rad_ = 0.0;
  drift_.reset();
  accelerations_.resize(3, 0);
  num_off_track_ = 0;
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
