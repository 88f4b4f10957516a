// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <stdexcept>
#include <string>
#include <vector>

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
  std::array<int, kNumStandardJoints> source_joint;
  // Turns the standard's rest pose into the source's, limb by limb: identity unless a limb rests in
  // another direction (T-pose against A-pose).
  std::array<Mat3, kNumStandardJoints> R_source_standard;
  // The source's proportions on the standard topology, m (after unit_scale).
  StandardBones bones;
  // The source's lengths times this are metres: 1 unless the file's own unit gives no human size.
  double unit_scale = 1.0;
  std::vector<std::string> warnings;
};

// Finds the standard joints by their names. Throws MappingError naming what is missing.
HumanoidMapping map_humanoid(const Skeleton& source);

// The source's movement on a standard skeleton: world rotations are carried over joint by joint,
// root translation is scaled by the ratio of leg lengths so that feet do not slide. A rest pose or
// T-pose that exporters put before the movement is dropped (it makes accelerations of thousands of
// m/s^2) and reported in warnings.
Motion to_standard(const Motion& source, const HumanoidMapping& mapping, const Skeleton& standard,
                   std::vector<std::string>* warnings = nullptr);

// Pose vectors (43 angles, rad) of a motion on a standard skeleton, continuous in time.
// 43 x frames.
Eigen::MatrixXd standard_angles(const Motion& standard_motion);

}  // namespace sparse_mocap
