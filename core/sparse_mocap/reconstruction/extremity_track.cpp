// SPDX-License-Identifier: GPL-3.0-or-later
#include "sparse_mocap/reconstruction/extremity_track.hpp"

#include <algorithm>
#include <cmath>

namespace sparse_mocap {
namespace {

constexpr double kLiveLag_s = 0.06, kTakeLag_s = 0.04;
// Fewer of the retrieved frames than this share fade to what is relaxed.
constexpr double kFewKnow = 0.1;
// A foot is level when it is as certain as the latter that it stands, and free below the former.
constexpr double kFree = 0.4, kLevel = 0.8;
constexpr double kFlat_rad = 15.0 * kRadiansPerDegree, kRaised_rad = 30.0 * kRadiansPerDegree;
constexpr double kMostLift_rad = 90.0 * kRadiansPerDegree;

std::size_t at(int j) { return static_cast<std::size_t>(j); }

double share_of(double lag_s, double frame_time_s) { return 1.0 - std::exp(-frame_time_s / lag_s); }

// Rises smoothly from 0 at `from` to 1 at `to`.
double step_between(double from, double to, double value) {
  const double x = std::clamp((value - from) / (to - from), 0.0, 1.0);
  return x * x * (3.0 - 2.0 * x);
}

// How much a foot is laid flat: one that is tilted further stands on its toes or its heel.
double levelled(double stands, double tilt_rad) {
  return step_between(kFree, kLevel, stands) *
         (1.0 - step_between(kFlat_rad, kRaised_rad, tilt_rad));
}

// The level foot that points where a foot does.
Quat level_like(const Quat& R_world_foot) {
  const Vec3 forward = R_world_foot * Vec3::UnitZ();
  if (std::hypot(forward.x(), forward.z()) < 0.2) return R_world_foot;  // straight up or down
  return Quat(Eigen::AngleAxisd(std::atan2(forward.x(), forward.z()), kUp));
}

// Lifts a bone about the horizontal axis across it until its end is above the floor.
Quat lifted(const Quat& R_world, const Vec3& bone, double begin_height_m) {
  const Vec3 along = R_world * bone;
  const Vec3 axis = along.cross(kUp);
  if (begin_height_m + along.y() >= 0.0 || axis.norm() < 1e-3 * bone.norm()) return R_world;
  const double slope = std::asin(std::clamp(along.y() / bone.norm(), -1.0, 1.0));
  const double wanted = -std::asin(std::clamp(begin_height_m / bone.norm(), 0.0, 1.0));
  const double lift = std::min(wanted - slope, kMostLift_rad);
  return Quat(Eigen::AngleAxisd(lift, axis.normalized())) * R_world;
}

}  // namespace

ExtremityTrack::ExtremityTrack(const Skeleton& method_skeleton, double rate_hz)
    : skeleton_(method_skeleton),
      is_standard_(is_standard(method_skeleton)),
      frame_time_s_(1.0 / rate_hz) {
  if (!is_standard_) return;
  skeleton_ = with_extremities(method_skeleton);
  for (int e = 0; e < kNumExtremities; ++e)
    relaxed_[at(e)] = Quat(relaxed(skeleton_, static_cast<extremity::Index>(e)));
}

ExtremityTrack::State ExtremityTrack::wanted(const PoseEstimate& estimate) const {
  State state;
  for (std::size_t e = 0; e < relaxed_.size(); ++e) {
    const double known = std::clamp(estimate.extremities.certainty[e] / kFewKnow, 0.0, 1.0);
    state.rotations[e] = relaxed_[e].slerp(known, estimate.extremities.R_parent_joint[e]);
  }
  state.stands = estimate.contacts;
  return state;
}

ExtremityTrack::State ExtremityTrack::between(const State& from, const State& to, double share) {
  State state;
  for (std::size_t e = 0; e < state.rotations.size(); ++e)
    state.rotations[e] = from.rotations[e].slerp(share, to.rotations[e]);
  state.stands = from.stands + share * (to.stands - from.stands);
  return state;
}

void ExtremityTrack::append(const State& state, PoseEstimate& estimate) const {
  auto& rotations = estimate.rotations;
  rotations.insert(rotations.end(), state.rotations.begin(), state.rotations.end());
  std::vector<Mat3> R_joint;
  for (const Quat& q : rotations) R_joint.push_back(q.toRotationMatrix());
  JointTransforms pose;
  forward_kinematics(skeleton_, estimate.root_position, R_joint, pose);
  for (const auto foot : {extremity::lfoot, extremity::rfoot}) {
    const int joint = extremity_joint(foot), toes = joint + 1;
    const double ankle_m = pose.pivot[at(joint)].y();
    Quat R_world_foot(pose.R_world_joint[at(joint)]);
    const Quat flat = level_like(R_world_foot);
    const double level = levelled(state.stands[foot == extremity::lfoot ? 0 : 1],
                                  R_world_foot.angularDistance(flat));
    R_world_foot = R_world_foot.slerp(level, flat);
    R_world_foot = lifted(R_world_foot, skeleton_.joint(joint).bone, ankle_m);
    const double ball_m = ankle_m + (R_world_foot * skeleton_.joint(joint).bone).y();
    const Quat R_foot_toes = rotations[at(toes)].slerp(level, Quat::Identity());
    const Quat R_world_toes =
        lifted(R_world_foot * R_foot_toes, skeleton_.joint(toes).bone, ball_m);
    const Quat R_world_shank(pose.R_world_joint[at(extremity_parent(foot))]);
    rotations[at(joint)] = (R_world_shank.conjugate() * R_world_foot).normalized();
    rotations[at(toes)] = (R_world_foot.conjugate() * R_world_toes).normalized();
  }
}

void ExtremityTrack::complete(PoseEstimate& estimate) {
  if (!is_standard_) return;
  const State now = wanted(estimate);
  last_ = last_ ? between(*last_, now, share_of(kLiveLag_s, frame_time_s_)) : now;
  append(*last_, estimate);
}

void ExtremityTrack::complete(std::vector<PoseEstimate>& take) const {
  if (!is_standard_ || take.empty()) return;
  std::vector<State> states;
  for (const auto& estimate : take) states.push_back(wanted(estimate));
  const double share = share_of(kTakeLag_s, frame_time_s_);
  for (std::size_t t = 1; t < states.size(); ++t)
    states[t] = between(states[t - 1], states[t], share);
  for (std::size_t t = states.size() - 1; t > 0; --t)
    states[t - 1] = between(states[t], states[t - 1], share);
  for (std::size_t t = 0; t < take.size(); ++t) append(states[t], take[t]);
}

}  // namespace sparse_mocap
