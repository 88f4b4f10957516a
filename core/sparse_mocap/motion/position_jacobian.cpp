// SPDX-License-Identifier: GPL-3.0-or-later
#include "sparse_mocap/motion/position_jacobian.hpp"

#include <algorithm>

namespace sparse_mocap {

Eigen::MatrixXd position_jacobian(const Skeleton& skeleton, const Eigen::VectorXd& angles,
                                  const JointTransforms& transforms) {
  Eigen::MatrixXd jacobian;
  put_position_jacobian(skeleton, angles, transforms, jacobian);
  return jacobian;
}

void put_position_jacobian(const Skeleton& skeleton, const Eigen::VectorXd& angles,
                           const JointTransforms& transforms, Eigen::MatrixXd& jacobian) {
  const int n = skeleton.num_joints();
  // Each angle turns all that follows about an axis through its joint's pivot.
  static thread_local Eigen::Matrix3Xd axis_world;
  axis_world.resize(3, skeleton.num_angles());
  for (int j = 0; j < n; ++j) {
    const Joint& joint = skeleton.joint(j);
    const auto parent = static_cast<std::size_t>(std::max(joint.parent, 0));
    Mat3 R = joint.parent < 0 ? joint.R_joint_axes
                              : Mat3(transforms.R_world_joint[parent] * joint.R_joint_axes);
    for (std::size_t i = 0; i < joint.axes.size(); ++i) {
      const int column = skeleton.angle_begin(j) + static_cast<int>(i);
      const Vec3 axis = unit(joint.axes[i]);
      axis_world.col(column) = R * axis;
      R = R * Eigen::AngleAxisd(angles[column], axis).toRotationMatrix();
    }
  }
  jacobian.setZero(3 * n, skeleton.num_angles());
  for (int j = 0; j < n; ++j) {
    const Vec3& end = transforms.end[static_cast<std::size_t>(j)];
    for (int a = j; a >= 0; a = skeleton.joint(a).parent) {
      const Vec3 arm = end - transforms.pivot[static_cast<std::size_t>(a)];
      const int begin = skeleton.angle_begin(a);
      for (int i = 0; i < static_cast<int>(skeleton.joint(a).axes.size()); ++i)
        jacobian.block<3, 1>(3 * j, begin + i) = Vec3(axis_world.col(begin + i)).cross(arm);
    }
  }
}

}  // namespace sparse_mocap
