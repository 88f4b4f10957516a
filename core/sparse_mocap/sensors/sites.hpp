// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "sparse_mocap/motion/standard_skeleton.hpp"

namespace sparse_mocap {

// A place on the body where a sensor is worn.
//
// Mounting (Tautges et al. 2011, section 3): x along the bone away from the body; at the arms z up
// when they are stretched out with palms down; at legs and trunk z forward; y completes a
// right-handed frame.
struct Site {
  std::string_view name;
  standard_joint::Index orientation;  // the joint whose rotation the sensor follows
  standard_joint::Index carrier;      // the joint along whose bone it sits
  Mat3 R_joint_sensor;
};

// All sites that a database holds readings of, in the order of its arrays.
const std::vector<Site>& all_sites();

// The index in all_sites. Throws ConfigError naming the known sites.
int find_site(std::string_view name);

// left_wrist, right_wrist, left_ankle, right_ankle: the sensors of the paper.
const std::vector<int>& paper_sites();

}  // namespace sparse_mocap
