// SPDX-License-Identifier: GPL-3.0-or-later
//
// Made-up poses that the tests of this module share.
#pragma once

#include "sparse_mocap/liu2011/body_pose.hpp"
#include "support/synthetic.hpp"

namespace sparse_mocap::testing {

// A pose with joints turned by up to size_rad about each axis, somewhere near the origin.
inline liu2011::BodyPose random_pose(const Skeleton& skeleton, Random& random, double size_rad) {
  return {random.vector(0.5) + Vec3(0.0, 0.9, 0.0),
          joint_rotations(skeleton, random.column(skeleton.num_angles(), size_rad))};
}

// How far two poses of a skeleton are apart: the largest distance of a joint, m.
inline double distance_m(const Skeleton& skeleton, const liu2011::BodyPose& a,
                         const liu2011::BodyPose& b) {
  JointTransforms at, bt;
  liu2011::forward_kinematics(skeleton, a, at);
  liu2011::forward_kinematics(skeleton, b, bt);
  double largest = 0.0;
  for (std::size_t j = 0; j < at.end.size(); ++j)
    largest = std::max(largest, (at.end[j] - bt.end[j]).norm());
  return largest;
}

// A frame of a motion as it stands in the world.
inline liu2011::BodyPose pose_of(const Motion& motion, int frame) {
  liu2011::BodyPose pose{motion.root_positions[static_cast<std::size_t>(frame)], {}};
  for (int j = 0; j < motion.skeleton.num_joints(); ++j)
    pose.rotations.push_back(motion.rotation(frame, j).toRotationMatrix());
  return pose;
}

}  // namespace sparse_mocap::testing
