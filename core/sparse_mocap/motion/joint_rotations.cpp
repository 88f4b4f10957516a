// SPDX-License-Identifier: GPL-3.0-or-later
#include "sparse_mocap/motion/joint_rotations.hpp"

#include <array>
#include <utility>

namespace sparse_mocap {
namespace {

Mat3 exponential(const Vec3& rotation_vector) {
  const double angle = rotation_vector.norm();
  if (angle < 1e-12) return Mat3::Identity();
  return Eigen::AngleAxisd(angle, rotation_vector / angle).toRotationMatrix();
}

std::array<double, 3> angles_of(const Joint& joint, const Mat3& R_joint) {
  std::array<double, 3> angles{};
  joint_angles(joint, R_joint, nullptr, angles.data());
  return angles;
}

// The axes about which the numbers of a step turn a joint, in the world.
Mat3 step_axes(const Joint& joint, const Mat3& R_joint, const Mat3& R_world_joint) {
  if (joint.axes.size() == 3) {
    Mat3 axes;
    for (std::size_t i = 0; i < 3; ++i)
      axes.col(static_cast<Eigen::Index>(i)) =
          R_world_joint * joint.R_joint_axes * unit(joint.axes[i]);
    return axes;
  }
  Mat3 axes = Mat3::Zero();
  Mat3 R = R_world_joint * R_joint.transpose() * joint.R_joint_axes;
  const auto angles = angles_of(joint, R_joint);
  for (std::size_t i = 0; i < joint.axes.size(); ++i) {
    const Vec3 axis = unit(joint.axes[i]);
    axes.col(static_cast<Eigen::Index>(i)) = R * axis;
    R = R * Eigen::AngleAxisd(angles[i], axis).toRotationMatrix();
  }
  return axes;
}

}  // namespace

JointRotations joint_rotations(const Skeleton& skeleton, const Eigen::VectorXd& angles) {
  JointRotations rotations;
  for (int j = 0; j < skeleton.num_joints(); ++j)
    rotations.push_back(joint_rotation(skeleton.joint(j), angles.data() + skeleton.angle_begin(j)));
  return rotations;
}

JointRotations reachable(const Skeleton& skeleton, JointRotations rotations) {
  for (int j = 0; j < skeleton.num_joints(); ++j) {
    const Joint& joint = skeleton.joint(j);
    if (joint.axes.size() == 3) continue;
    Mat3& R = rotations[static_cast<std::size_t>(j)];
    R = joint_rotation(joint, angles_of(joint, R).data());
  }
  return rotations;
}

JointRotations turned(const Skeleton& skeleton, JointRotations rotations,
                      const Eigen::Ref<const Eigen::VectorXd>& step) {
  for (int j = 0; j < skeleton.num_joints(); ++j) {
    const Joint& joint = skeleton.joint(j);
    const double* turn = step.data() + skeleton.angle_begin(j);
    Mat3& R = rotations[static_cast<std::size_t>(j)];
    if (joint.axes.size() == 3) {
      Vec3 rotation_vector = Vec3::Zero();
      for (std::size_t i = 0; i < 3; ++i) rotation_vector += turn[i] * unit(joint.axes[i]);
      R = R * exponential(joint.R_joint_axes * rotation_vector);
      continue;
    }
    auto angles = angles_of(joint, R);
    for (std::size_t i = 0; i < joint.axes.size(); ++i) angles[i] += turn[i];
    R = joint_rotation(joint, angles.data());
  }
  return rotations;
}

StepJacobians step_jacobians(const Skeleton& skeleton, const JointRotations& rotations,
                             const JointTransforms& transforms) {
  const Eigen::Index rows = 3 * skeleton.num_joints();
  StepJacobians out{Eigen::MatrixXd(rows, skeleton.num_angles()),
                    Eigen::MatrixXd(rows, skeleton.num_angles())};
  put_step_jacobians(skeleton, rotations, transforms, out.ends, out.turns);
  return out;
}

void put_step_jacobians(const Skeleton& skeleton, const JointRotations& rotations,
                        const JointTransforms& transforms, Eigen::Ref<Eigen::MatrixXd> ends,
                        Eigen::Ref<Eigen::MatrixXd> turns) {
  const int n = skeleton.num_joints();
  ends.setZero();
  turns.setZero();
  static thread_local std::vector<Mat3> axes;
  axes.clear();
  for (std::size_t j = 0; j < rotations.size(); ++j)
    axes.push_back(step_axes(skeleton.joints()[j], rotations[j], transforms.R_world_joint[j]));
  for (int j = 0; j < n; ++j) {
    const Vec3& end = transforms.end[static_cast<std::size_t>(j)];
    for (int a = j; a >= 0; a = skeleton.joint(a).parent) {
      const Vec3 arm = end - transforms.pivot[static_cast<std::size_t>(a)];
      const int begin = skeleton.angle_begin(a);
      for (int i = 0; i < static_cast<int>(skeleton.joint(a).axes.size()); ++i) {
        const Vec3 axis = axes[static_cast<std::size_t>(a)].col(i);
        turns.block<3, 1>(3 * j, begin + i) = axis;
        ends.block<3, 1>(3 * j, begin + i) = axis.cross(arm);
      }
    }
  }
}

}  // namespace sparse_mocap
