// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

#include "sparse_mocap/motion/standard_skeleton.hpp"

namespace sparse_mocap {

// The body of a performer.
struct Body {
  std::string performer;  // a name, may be empty
  StandardBones bones{};  // m, from pivot to end in rest pose

  Skeleton skeleton() const { return make_standard_skeleton(bones); }
};

// How tall somebody with these bones stands, sole to crown (m). The skeleton ends at the ankles,
// which are 3.9 % of the height above the ground (Drillis and Contini 1966, as in Winter,
// Biomechanics and Motor Control of Human Movement, figure 4.1).
double standing_height_m(const StandardBones& bones);

// The medium body scaled to a standing height. Throws ConfigError unless it is 0.5 to 2.5 m.
Body body_of_height(double height_m);

// Throws ConfigError, naming the bone, when a bone is not finite or longer than 1 m, a limb has no
// length, or the standing height is not 0.5 to 2.5 m.
void check_body(const Body& body);

}  // namespace sparse_mocap
