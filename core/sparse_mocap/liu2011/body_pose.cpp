// SPDX-License-Identifier: GPL-3.0-or-later
#include "sparse_mocap/liu2011/body_pose.hpp"

#include <array>
#include <cmath>
#include <utility>

#include "sparse_mocap/motion/heading.hpp"

namespace sparse_mocap::liu2011 {
namespace {

std::array<double, 3> angles_of(const Joint& joint, const Mat3& R_joint) {
  std::array<double, 3> angles{};
  joint_angles(joint, R_joint, nullptr, angles.data());
  return angles;
}

Mat3 cross_matrix(const Vec3& v) {
  Mat3 out;
  out << 0.0, -v.z(), v.y(), v.z(), 0.0, -v.x(), -v.y(), v.x(), 0.0;
  return out;
}

// What turns `from` into `to`, as many numbers as the joint has axes.
void joint_vector(const Joint& joint, const Mat3& from, const Mat3& to, double* out) {
  if (joint.axes.size() == 3) {
    const Vec3 turn = joint.R_joint_axes.transpose() * logarithm(from.transpose() * to);
    for (std::size_t i = 0; i < 3; ++i) out[i] = unit(joint.axes[i]).dot(turn);
    return;
  }
  const auto before = angles_of(joint, from), after = angles_of(joint, to);
  for (std::size_t i = 0; i < joint.axes.size(); ++i)
    out[i] = std::remainder(after[i] - before[i], 2.0 * kPi);
}

}  // namespace

BodyPose HeadingFrame::to_parent(BodyPose pose) const {
  const Mat3 R = yaw_rotation(yaw_rad);
  pose.root_position = R * pose.root_position + origin;
  pose.rotations[0] = R * pose.rotations[0];
  return pose;
}

BodyPose HeadingFrame::from_parent(BodyPose pose) const {
  const Mat3 R = yaw_rotation(-yaw_rad);
  pose.root_position = R * (pose.root_position - origin);
  pose.rotations[0] = R * pose.rotations[0];
  return pose;
}

HeadingFrame HeadingFrame::inverse() const {
  return {-yaw_rad, -(yaw_rotation(-yaw_rad) * origin)};
}

HeadingFrame heading_frame_of(const Skeleton& skeleton, const BodyPose& pose, double last_rad) {
  JointTransforms transforms;
  forward_kinematics(skeleton, pose, transforms);
  return {heading_of(transforms, last_rad), {pose.root_position.x(), 0.0, pose.root_position.z()}};
}

void forward_kinematics(const Skeleton& skeleton, const BodyPose& pose, JointTransforms& out) {
  sparse_mocap::forward_kinematics(skeleton, pose.root_position, pose.rotations, out);
}

Eigen::VectorXd pose_vector(const Skeleton& skeleton, const BodyPose& reference,
                            const BodyPose& pose) {
  Eigen::VectorXd vector(num_freedoms(skeleton));
  vector.head<3>() = pose.root_position - reference.root_position;
  for (int j = 0; j < skeleton.num_joints(); ++j)
    joint_vector(skeleton.joint(j), reference.rotations[static_cast<std::size_t>(j)],
                 pose.rotations[static_cast<std::size_t>(j)],
                 vector.data() + 3 + skeleton.angle_begin(j));
  return vector;
}

Eigen::VectorXd pose_vectors(const Skeleton& skeleton, const BodyPose& reference,
                             std::span<const BodyPose> poses) {
  const Eigen::Index n = num_freedoms(skeleton);
  Eigen::VectorXd out(n * static_cast<Eigen::Index>(poses.size()));
  for (std::size_t i = 0; i < poses.size(); ++i)
    out.segment(static_cast<Eigen::Index>(i) * n, n) = pose_vector(skeleton, reference, poses[i]);
  return out;
}

BodyPose moved(const Skeleton& skeleton, BodyPose pose, const Eigen::VectorXd& step) {
  pose.root_position += step.head<3>();
  pose.rotations = turned(skeleton, std::move(pose.rotations), step.tail(skeleton.num_angles()));
  return pose;
}

Eigen::MatrixXd pose_vector_jacobian(const Skeleton& skeleton, const Eigen::VectorXd& vector) {
  Eigen::MatrixXd jacobian = Eigen::MatrixXd::Identity(vector.size(), vector.size());
  for (int j = 0; j < skeleton.num_joints(); ++j) {
    const Joint& joint = skeleton.joint(j);
    if (joint.axes.size() != 3) continue;
    const Eigen::Index begin = 3 + skeleton.angle_begin(j);
    Mat3 axes;  // numbers of the vector to a rotation vector
    for (std::size_t i = 0; i < 3; ++i)
      axes.col(static_cast<Eigen::Index>(i)) = unit(joint.axes[i]);
    const Vec3 turn = axes * vector.segment<3>(begin);
    jacobian.block<3, 3>(begin, begin) = axes.transpose() * right_jacobian_inverse(turn) * axes;
  }
  return jacobian;
}

Vec3 logarithm(const Mat3& R) {
  Quat q(R);
  if (q.w() < 0.0) q.coeffs() = -q.coeffs();
  const double sine = q.vec().norm();
  if (sine < 1e-9) return 2.0 * q.vec();
  return q.vec() * (2.0 * std::atan2(sine, q.w()) / sine);
}

Mat3 left_jacobian_inverse(const Vec3& rotation_vector) {
  const double angle = rotation_vector.norm();
  const Mat3 cross = cross_matrix(rotation_vector);
  const double half = 0.5 * angle;
  const double factor =
      angle < 1e-4 ? 1.0 / 12.0 : (1.0 - half * std::cos(half) / std::sin(half)) / (angle * angle);
  return Mat3::Identity() - 0.5 * cross + factor * cross * cross;
}

Mat3 right_jacobian_inverse(const Vec3& rotation_vector) {
  return left_jacobian_inverse(-rotation_vector);
}

}  // namespace sparse_mocap::liu2011
