// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <span>

#include "sparse_mocap/motion/joint_rotations.hpp"

namespace sparse_mocap::liu2011 {

// A pose and where it stands, in a frame that the context names.
struct BodyPose {
  Vec3 root_position = Vec3::Zero();  // m
  JointRotations rotations;           // R_joint; the root's is R_frame_root
};

// Where a heading frame stands in another: on the ground, turned about the vertical.
struct HeadingFrame {
  double yaw_rad = 0.0;
  Vec3 origin = Vec3::Zero();  // m, y = 0

  BodyPose to_parent(BodyPose pose) const;
  BodyPose from_parent(BodyPose pose) const;
  HeadingFrame inverse() const;  // of the parent in it
};

// The heading frame under a pose; where the pose has no heading, last_rad is kept.
HeadingFrame heading_frame_of(const Skeleton& skeleton, const BodyPose& pose, double last_rad);

void forward_kinematics(const Skeleton& skeleton, const BodyPose& pose, JointTransforms& out);

// The numbers of a pose vector q: root position, then as many as the skeleton has angles.
inline Eigen::Index num_freedoms(const Skeleton& skeleton) { return 3 + skeleton.num_angles(); }

// The pose as a vector about a reference pose: how far the root is from there (m), and what turns
// each joint of the reference into the pose's (rad): a rotation vector in the frame of the joint's
// axes for joints with three axes, differences of angles for the others. moved() undoes it.
Eigen::VectorXd pose_vector(const Skeleton& skeleton, const BodyPose& reference,
                            const BodyPose& pose);
// The same of poses one after another.
Eigen::VectorXd pose_vectors(const Skeleton& skeleton, const BodyPose& reference,
                             std::span<const BodyPose> poses);
BodyPose moved(const Skeleton& skeleton, BodyPose pose, const Eigen::VectorXd& step);

// d(the pose's vector) / d(a further small step from the pose), given that vector.
Eigen::MatrixXd pose_vector_jacobian(const Skeleton& skeleton, const Eigen::VectorXd& vector);

// Rotation vectors, rad.
Vec3 logarithm(const Mat3& R);
// The inverses of the left and right Jacobians of the exponential map of rotations:
// log(exp(d) exp(v)) = v + left_inverse(v) d, log(exp(v) exp(d)) = v + right_inverse(v) d.
Mat3 left_jacobian_inverse(const Vec3& rotation_vector);
Mat3 right_jacobian_inverse(const Vec3& rotation_vector);

}  // namespace sparse_mocap::liu2011
