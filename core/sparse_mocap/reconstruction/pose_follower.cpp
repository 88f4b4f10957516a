// SPDX-License-Identifier: GPL-3.0-or-later
#include "sparse_mocap/reconstruction/pose_follower.hpp"

#include <cmath>

namespace sparse_mocap {
namespace {

// A critically damped spring that is let go at an offset from rest, after some time: exact.
template <typename Value>
void relax(Value& offset, Value& velocity, double lag_s, double time_s) {
  const double rate = 2.0 / lag_s;  // a spring of this rate lags behind a steady movement by lag_s
  const double left = std::exp(-rate * time_s);
  const Value pull = velocity + rate * offset;
  offset = left * (offset + time_s * pull);
  velocity = left * (velocity - rate * time_s * pull);
}

}  // namespace

void PoseFollower::apply(PoseEstimate& estimate) {
  if (lag_s_ <= 0.0) return;
  if (joints_.size() != estimate.rotations.size()) {
    joints_.clear();
    for (const Quat& rotation : estimate.rotations) joints_.push_back({rotation, Vec3::Zero()});
    height_m_ = estimate.root_position.y();
    climb_mps_ = 0.0;
    return;
  }
  for (std::size_t j = 0; j < joints_.size(); ++j) {
    Quat& wanted = estimate.rotations[j];
    Vec3 offset = rotation_vector(wanted.conjugate() * joints_[j].rotation);
    relax(offset, joints_[j].velocity_radps, lag_s_, frame_time_s_);
    joints_[j].rotation = (wanted * rotation_of_vector(offset)).normalized();
    wanted = joints_[j].rotation;
  }
  double above = height_m_ - estimate.root_position.y();
  relax(above, climb_mps_, lag_s_, frame_time_s_);
  height_m_ = estimate.root_position.y() += above;
}

}  // namespace sparse_mocap
