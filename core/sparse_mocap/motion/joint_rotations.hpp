// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "sparse_mocap/motion/skeleton.hpp"

namespace sparse_mocap {

// A pose as R_joint of every joint. Unlike angles it has no seam and no gimbal lock, so that poses
// can be compared and moved a little without a thought of full turns.
using JointRotations = std::vector<Mat3>;

JointRotations joint_rotations(const Skeleton& skeleton, const Eigen::VectorXd& angles);

// The nearest pose that the joints' axes allow: a knee only bends.
JointRotations reachable(const Skeleton& skeleton, JointRotations rotations);

// The pose turned on by a step (rad, as many numbers as the skeleton has angles): joints with three
// axes by a rotation vector in the frame of their axes, the others by adding to their angles.
JointRotations turned(const Skeleton& skeleton, JointRotations rotations,
                      const Eigen::Ref<const Eigen::VectorXd>& step);

// How a pose moves under a small step, at step 0: ends are d(end of every joint) (m/rad), turns
// d(rotation vector of every joint in the world); 3 joints x angles each. The root's pivot stays.
struct StepJacobians {
  Eigen::MatrixXd ends, turns;
};
StepJacobians step_jacobians(const Skeleton& skeleton, const JointRotations& rotations,
                             const JointTransforms& transforms);
void put_step_jacobians(const Skeleton& skeleton, const JointRotations& rotations,
                        const JointTransforms& transforms, Eigen::Ref<Eigen::MatrixXd> ends,
                        Eigen::Ref<Eigen::MatrixXd> turns);

}  // namespace sparse_mocap
