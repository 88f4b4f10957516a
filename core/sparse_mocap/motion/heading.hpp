// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "sparse_mocap/motion/motion.hpp"

namespace sparse_mocap {

// Turns about the up axis; positive yaw turns forward (z) towards the left (x).
Mat3 yaw_rotation(double yaw_rad);

// The heading of a body (yaw, rad): its hips' right-to-left axis projected on the ground. When that
// axis stands nearly upright there is none, and `last_rad` is kept. Returned near last_rad (no
// jumps of a full turn).
double heading_of(const JointTransforms& standard_pose, double last_rad);

// The headings of a motion on a standard skeleton, continuous; one a frame.
std::vector<double> headings(const Motion& standard_motion);

// The joint rotations of a pose vector (rad) whose root has no heading, turned to yaw_rad.
std::vector<Quat> pose_rotations(const Skeleton& skeleton, const Eigen::VectorXd& angles,
                                 double yaw_rad);

// In which frame joint positions are given; root position removed in the first two.
enum class PositionFrame {
  heading,  // heading removed: y up, x left, z forward
  root,     // the root's full orientation removed
  world,
};

// Positions of the joints' ends, 3 joints x frames (m).
Eigen::MatrixXd joint_positions(const Motion& standard_motion, PositionFrame frame);

}  // namespace sparse_mocap
