// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <string_view>
#include <vector>

#include "sparse_mocap/motion/motion.hpp"
#include "sparse_mocap/motion/skeleton.hpp"
#include "sparse_mocap/motion/standard_skeleton.hpp"

namespace sparse_mocap {

// Feet, toes and hands: what the standard skeleton lacks. A skeleton with extremities has the 21
// standard joints first and then these six; feet turn at the ankles, hands at the wrists.
inline constexpr int kNumExtremities = 6;

namespace extremity {
enum Index : int { lfoot, ltoes, lhand, rfoot, rtoes, rhand };
}  // namespace extremity

const std::array<std::string_view, kNumExtremities>& extremity_names();

// The joint that an extremity hangs on, as an index in a skeleton with extremities.
int extremity_parent(extremity::Index e);

// The joint of a skeleton with extremities.
inline int extremity_joint(int e) { return kNumStandardJoints + e; }

bool is_standard(const Skeleton& skeleton);      // the 21 joints alone
bool has_extremities(const Skeleton& skeleton);  // and the six

// A standard skeleton with extremities, as long as they are on HDM05's skeletons by the length of
// the leg. In rest feet are level and point forward, hands lie along the forearms.
Skeleton with_extremities(const Skeleton& standard_skeleton);
// The other way round; a standard skeleton stays as it is.
Skeleton without_extremities(const Skeleton& skeleton);
Motion without_extremities(const Motion& motion);

// For each joint of a skeleton with extremities the one on the other side.
const std::vector<int>& left_right_with_extremities();

// A rotation as its axis times its angle (rad, at most pi), and back.
Vec3 rotation_vector(const Quat& rotation);
Quat rotation_of_vector(const Vec3& vector);

// R_parent_joint of an extremity that does nothing: a foot at right angles to its shank, straight
// toes, a hand that hangs a little bent.
Mat3 relaxed(const Skeleton& skeleton, extremity::Index e);

}  // namespace sparse_mocap
