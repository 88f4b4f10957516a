// SPDX-License-Identifier: GPL-3.0-or-later
#include "sparse_mocap/motion/heading.hpp"

#include <cmath>

#include "sparse_mocap/motion/standard_skeleton.hpp"

namespace sparse_mocap {
namespace {

// The horizontal part of the hip axis, relative to its length, below which it gives no heading.
constexpr double kUprightAxis = 0.2;

}  // namespace

Mat3 yaw_rotation(double yaw_rad) { return Eigen::AngleAxisd(yaw_rad, kUp).toRotationMatrix(); }

double heading_of(const JointTransforms& pose, double last_rad) {
  using namespace standard_joint;
  const Vec3 left = pose.end[lhipjoint] - pose.end[rhipjoint];
  if (std::hypot(left.x(), left.z()) < kUprightAxis * left.norm()) return last_rad;
  const double yaw = std::atan2(-left.z(), left.x());
  return yaw + 2.0 * kPi * std::round((last_rad - yaw) / (2.0 * kPi));
}

std::vector<double> headings(const Motion& standard_motion) {
  std::vector<double> out;
  double last = 0.0;
  for (int t = 0; t < standard_motion.num_frames(); ++t) {
    last = heading_of(standard_motion.transforms(t), last);
    out.push_back(last);
  }
  return out;
}

std::vector<Quat> pose_rotations(const Skeleton& skeleton, const Eigen::VectorXd& angles,
                                 double yaw_rad) {
  std::vector<Quat> rotations;
  for (int j = 0; j < skeleton.num_joints(); ++j)
    rotations.emplace_back(
        joint_rotation(skeleton.joint(j), angles.data() + skeleton.angle_begin(j)));
  rotations[0] = Quat(yaw_rotation(yaw_rad)) * rotations[0];
  return rotations;
}

Eigen::MatrixXd joint_positions(const Motion& motion, PositionFrame frame) {
  const int n = motion.skeleton.num_joints();
  Eigen::MatrixXd out(3 * n, motion.num_frames());
  double yaw = 0.0;
  for (int t = 0; t < motion.num_frames(); ++t) {
    const JointTransforms at = motion.transforms(t);
    Mat3 R_world_frame = Mat3::Identity();
    Vec3 origin = Vec3::Zero();
    if (frame != PositionFrame::world) origin = at.end[0];
    if (frame == PositionFrame::root) R_world_frame = at.R_world_joint[0];
    if (frame == PositionFrame::heading) {
      yaw = heading_of(at, yaw);
      R_world_frame = yaw_rotation(yaw);
    }
    for (int j = 0; j < n; ++j)
      out.block<3, 1>(3 * j, t) =
          R_world_frame.transpose() * (at.end[static_cast<std::size_t>(j)] - origin);
  }
  return out;
}

}  // namespace sparse_mocap
