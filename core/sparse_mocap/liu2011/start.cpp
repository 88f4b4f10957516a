// SPDX-License-Identifier: GPL-3.0-or-later
#include "sparse_mocap/liu2011/start.hpp"

#include <cmath>
#include <limits>
#include <utility>

#include "sparse_mocap/motion/heading.hpp"

namespace sparse_mocap::liu2011 {
namespace {

constexpr double kPerRotation = 0.5;  // |R - S|^2 / 2 is the angle between them squared, if small

Vec3 level(const Vec3& v) { return {v.x(), 0.0, v.z()}; }

// Gathers sum a.(R_y b) as cosine * cos(yaw) + sine * sin(yaw).
struct YawVote {
  double cosine = 0.0, sine = 0.0;

  void add(double weight, const Vec3& measured, const Vec3& modelled) {
    cosine += weight * (measured.x() * modelled.x() + measured.z() * modelled.z());
    sine += weight * (measured.x() * modelled.z() - measured.z() * modelled.x());
  }
  double yaw_rad() const { return std::atan2(sine, cosine); }
};

}  // namespace

Placement placed(std::span<const Observation> observed, std::span<const SensorPose> modelled,
                 const ControlWeights& weights) {
  const double per_m2 = 1.0 / (weights.sigma_position_m * weights.sigma_position_m);
  const double per_turn =
      kPerRotation / (weights.sigma_orientation_rad * weights.sigma_orientation_rad);
  Vec3 measured_mean = Vec3::Zero(), modelled_mean = Vec3::Zero();
  double count = 0.0;
  for (std::size_t s = 0; s < observed.size(); ++s) {
    if (!observed[s].has_position) continue;
    measured_mean += level(observed[s].measured.position);
    modelled_mean += level(modelled[s].position);
    count += 1.0;
  }
  if (count > 0.0) measured_mean /= count, modelled_mean /= count;
  YawVote vote;
  for (std::size_t s = 0; s < observed.size(); ++s) {
    if (observed[s].has_position)
      vote.add(per_m2, observed[s].measured.position - measured_mean,
               modelled[s].position - modelled_mean);
    for (Eigen::Index axis = 0; observed[s].has_orientation && axis < 3; ++axis)
      vote.add(per_turn, observed[s].measured.R_frame_sensor.col(axis),
               modelled[s].R_frame_sensor.col(axis));
  }
  Placement out;
  out.frame.yaw_rad = vote.yaw_rad();
  const Mat3 R = yaw_rotation(out.frame.yaw_rad);
  if (count > 0.0) out.frame.origin = measured_mean - R * modelled_mean;
  for (std::size_t s = 0; s < observed.size(); ++s) {
    if (observed[s].has_position)
      out.squared_error +=
          per_m2 * (R * modelled[s].position + out.frame.origin - observed[s].measured.position)
                       .squaredNorm();
    if (observed[s].has_orientation)
      out.squared_error +=
          per_turn *
          (R * modelled[s].R_frame_sensor - observed[s].measured.R_frame_sensor).squaredNorm();
  }
  return out;
}

Start::Start(const MotionExamples& examples, const std::vector<bool>& is_searched)
    : examples_(examples) {
  for (int frame = 0; frame < examples.num_frames(); ++frame)
    if (is_searched[static_cast<std::size_t>(frame)]) frames_.push_back(frame);
}

std::vector<BodyPose> Start::history(std::span<const Observation> observed,
                                     const ControlWeights& weights, int num_poses,
                                     std::size_t most_frames) const {
  int nearest = frames_.front();
  Placement best{{}, std::numeric_limits<double>::infinity()};
  JointTransforms transforms;
  std::vector<SensorPose> modelled(observed.size());
  const std::size_t stride = frames_.size() / most_frames + 1;
  for (std::size_t i = 0; i < frames_.size() && !observed.empty(); i += stride) {
    const int frame = frames_[i];
    forward_kinematics(examples_.body(), examples_.pose(frame), transforms);
    for (std::size_t s = 0; s < observed.size(); ++s)
      modelled[s] = sensor_pose(observed[s].worn, transforms);
    const Placement here = placed(observed, modelled, weights);
    if (here.squared_error >= best.squared_error) continue;
    best = here;
    nearest = frame;
  }
  // The frame's own heading frame is known; its history is told in that of the frame before.
  const HeadingFrame step = examples_.step(nearest);
  HeadingFrame before;
  before.yaw_rad = best.frame.yaw_rad - step.yaw_rad;
  before.origin = best.frame.origin - yaw_rotation(before.yaw_rad) * step.origin;
  std::vector<BodyPose> history;
  for (const auto& place : examples_.history(nearest, num_poses))
    history.push_back(before.to_parent(place.heading.to_parent(examples_.pose(place.frame))));
  return history;
}

}  // namespace sparse_mocap::liu2011
