// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <stdexcept>
#include <string>
#include <vector>

#include "sparse_mocap/motion/humanoid_carriers.hpp"
#include "sparse_mocap/motion/motion.hpp"
#include "sparse_mocap/motion/standard_skeleton.hpp"

namespace sparse_mocap {

// A skeleton that is not a human body, or whose joints are not recognised; what() says why.
class MappingError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

// How a foreign skeleton carries the standard one.
struct HumanoidMapping {
  // The source joint that moves each standard joint, -1 where the source has none (the standard
  // joint then follows its parent).
  SourceJoints source;
  // What moves each standard bone, with the rest poses matched.
  Carriers carriers;
  // Turns the file's world into one with y up; identity for most files.
  Mat3 R_world_file = Mat3::Identity();
  // The source's proportions on the standard topology, m (after unit_scale).
  StandardBones bones;
  // The source's lengths times this are metres: 1 unless the file's own unit gives no human size.
  double unit_scale = 1.0;
  std::vector<std::string> warnings;
};

// Finds the standard joints by hand where given, by names, then by shape, and matches the rest
// poses once. The motion serves where the skeleton alone does not tell: which axis is up, and how a
// body stands whose angles at zero are no pose (bones along their joints' own axes).
// Throws MappingError when this is no human body.
HumanoidMapping map_humanoid(const Motion& source, const JointNames& by_hand = {});

// As above from the skeleton alone, whose angles at zero must be a pose.
HumanoidMapping map_humanoid(const Skeleton& source, const JointNames& by_hand = {});

// The source's movement on a standard skeleton. World rotations are carried over joint by joint, so
// limbs point where the source's do; an upper limb twists where the source's elbow or knee leaves
// the plane of a hinge. Root translation is scaled by the ratio of leg lengths so that feet do not
// slide. A rest pose or T-pose that exporters put before the movement is dropped (it makes
// accelerations of thousands of m/s^2) and reported in warnings.
Motion to_standard(const Motion& source, const HumanoidMapping& mapping, const Skeleton& standard,
                   std::vector<std::string>* warnings = nullptr);

// Pose vectors (43 angles, rad) of a motion on a standard skeleton, continuous in time.
// 43 x frames.
Eigen::MatrixXd standard_angles(const Motion& standard_motion);

}  // namespace sparse_mocap
