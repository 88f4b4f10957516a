// SPDX-License-Identifier: GPL-3.0-or-later
#include "sparse_mocap/retargeting/to_rig.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

#include "retargeting/synthetic_body.hpp"
#include "sparse_mocap/motion/standard_skeleton.hpp"
#include "sparse_mocap/retargeting/to_standard.hpp"
#include "support/synthetic.hpp"

namespace sparse_mocap {
namespace {

using testing::BodyPartAt;
using testing::person;
using testing::swaying_motion;
using testing::template_skeleton;
using testing::turn;
using testing::walk;

Motion on_standard(const Motion& motion) {
  const SkeletonMapping mapping = map_skeleton(motion);
  return to_standard(motion, mapping, make_standard_skeleton(mapping.bones));
}

// The movement of one motion on the rig of another, which also shows how that rig stands.
Motion on_rig_of(const Motion& standard_motion, const Motion& rig) {
  return to_rig(standard_motion, map_skeleton(rig), rig.skeleton);
}

// The largest distance (m) between joints of one name.
double worst_distance_m(const Motion& a, const Motion& b) {
  EXPECT_EQ(a.num_frames(), b.num_frames());
  double worst = 0.0;
  for (int t = 0; t < std::min(a.num_frames(), b.num_frames()); ++t) {
    const JointTransforms p = a.transforms(t), q = b.transforms(t);
    for (int j = 0; j < a.skeleton.num_joints(); ++j) {
      const std::string& name = a.skeleton.joint(j).name;
      const int same = b.skeleton.find(name);
      EXPECT_GE(same, 0) << name;
      if (same < 0) continue;
      const double distance =
          (p.pivot[static_cast<std::size_t>(j)] - q.pivot[static_cast<std::size_t>(same)]).norm();
      worst = std::max(worst, distance);
    }
  }
  return worst;
}

// The largest angle (rad) between the bones from one joint to another in two motions.
double worst_angle_rad(const Motion& a, const Motion& b, const char* begin, const char* end) {
  double worst = 0.0;
  for (int t = 0; t < a.num_frames(); ++t) {
    const auto bone = [&](const Motion& motion) {
      const auto at = [&](const char* name) {
        return static_cast<std::size_t>(motion.skeleton.find(name));
      };
      const JointTransforms pose = motion.transforms(t);
      return Vec3(pose.pivot[at(end)] - pose.pivot[at(begin)]);
    };
    worst = std::max(worst, std::atan2(bone(a).cross(bone(b)).norm(), bone(a).dot(bone(b))));
  }
  return worst;
}

Skeleton scaled(const Skeleton& skeleton, double scale) {
  auto joints = skeleton.joints();
  for (auto& joint : joints) joint.offset_parent *= scale;
  return Skeleton(joints);
}

// The walk is made for each rest pose by itself, so each is the truth for the others.
TEST(ToRig, BringsTheMovementToEveryRestPoseOfTheBody) {
  const Motion standard = on_standard(walk(testing::t_pose));
  for (const auto rest : {testing::t_pose, testing::a_pose, testing::i_pose, testing::lying}) {
    const Motion expected = walk(rest);
    EXPECT_LT(worst_distance_m(on_rig_of(standard, expected), expected), 2e-3);
  }
}

// Its own movement comes back exactly; that of another rest pose up to how shoulders are held,
// which such a rig does not say.
TEST(ToRig, BringsTheMovementToBonesAlongTheirJointsAxes) {
  const Motion expected = walk(testing::along_x);
  const Motion own = on_rig_of(on_standard(expected), expected);
  EXPECT_LT(worst_distance_m(own, expected), 1e-4);
  const Motion there = on_rig_of(on_standard(walk(testing::t_pose)), expected);
  EXPECT_LT(worst_distance_m(there, expected), 5e-2);
  for (const auto& [begin, end] : {std::pair{"LeftUpLeg", "LeftLeg"},
                                   {"RightLeg", "RightFoot"},
                                   {"LeftArm", "LeftForeArm"},
                                   {"RightForeArm", "RightHand"}})
    EXPECT_LT(worst_angle_rad(there, expected, begin, end), 0.1 * kRadiansPerDegree) << begin;
}

TEST(ToRig, GivesTheStandardSkeletonItsOwnMotionBack) {
  const Motion motion = swaying_motion(template_skeleton(), 1, 25, 60.0);
  const Motion back = to_rig(motion, map_skeleton(motion.skeleton), motion.skeleton);
  EXPECT_LT(worst_distance_m(back, motion), 1e-9);
  EXPECT_DOUBLE_EQ(back.frame_time_s, motion.frame_time_s);
}

TEST(ToRig, ScalesTheRootsWayWithTheLegs) {
  const Motion motion = walk(testing::t_pose);
  Motion rig = motion;
  rig.skeleton = scaled(motion.skeleton, 0.7);
  Motion expected = rig;
  for (auto& position : expected.root_positions) position *= 0.7;
  EXPECT_LT(worst_distance_m(on_rig_of(on_standard(motion), rig), expected), 2e-3);
}

TEST(ToRig, AnswersInTheRigsOwnUnitAndWorld) {
  const Motion standard = on_standard(walk(testing::t_pose));
  const Mat3 R = turn(90.0, Vec3::UnitX());  // y to z
  Motion expected = walk(testing::t_pose);
  auto joints = expected.skeleton.joints();
  for (auto& joint : joints) joint.offset_parent = R * joint.offset_parent * 1000.0;
  expected.skeleton = Skeleton(joints);
  for (auto& p : expected.root_positions) p = R * p * 1000.0;
  for (auto& q : expected.rotations) q = Quat(R) * q * Quat(R).conjugate();
  EXPECT_LT(worst_distance_m(on_rig_of(standard, expected), expected), 2.0);  // mm
}

TEST(ToRig, LeavesJointsThatMapToNothingAtRest) {
  const Motion rig = walk(testing::a_pose);
  const Motion there = on_rig_of(on_standard(walk(testing::t_pose)), rig);
  for (const char* name : {"LeftToes", "RightToes", "LeftFingers", "RightFingers", "HeadEnd"})
    for (int t = 0; t < there.num_frames(); ++t)
      EXPECT_LT(there.rotation(t, rig.skeleton.find(name)).angularDistance(Quat::Identity()), 1e-9)
          << name;
}

// Where the angles at zero are no pose, rest is how the joints are held while the body stands.
TEST(ToRig, KeepsTheRestOfRigsWhoseAnglesAtZeroAreNoPose) {
  Motion rig = walk(testing::along_x);
  const Quat curled(turn(70.0, Vec3::UnitY()));
  const int fingers = rig.skeleton.find("LeftFingers");
  for (int t = 0; t < rig.num_frames(); ++t) rig.rotation(t, fingers) = curled;
  const Motion there = on_rig_of(on_standard(walk(testing::t_pose)), rig);
  for (int t = 0; t < there.num_frames(); ++t)
    EXPECT_LT(there.rotation(t, fingers).angularDistance(curled), 1e-6);
}

// Pelvises differ in shape; what stands on the legs is the middle of the hips.
TEST(ToRig, LaysTheHipsWhereTheStandardHasThem) {
  const Motion standard = swaying_motion(template_skeleton(), 2, 25, 60.0);
  const Motion rig = walk(testing::t_pose);
  const Motion there = on_rig_of(standard, rig);
  const auto at = [&](const char* name) {
    return static_cast<std::size_t>(rig.skeleton.find(name));
  };
  const double legs = leg_length_m(template_bones()) / (0.4 + 0.42);
  for (int t = 0; t < standard.num_frames(); ++t) {
    const JointTransforms from = standard.transforms(t), to = there.transforms(t);
    const Vec3 hips = from.pivot[standard_joint::lfemur] + from.pivot[standard_joint::rfemur];
    const Vec3 hips_there = to.pivot[at("LeftUpLeg")] + to.pivot[at("RightUpLeg")];
    EXPECT_LT((hips - legs * hips_there).norm(), 1e-6);
  }
}

// Characters often stand on a root joint at the ground, which no part of the body is.
TEST(ToRig, MovesARootThatIsNotThePelvis) {
  std::vector<BodyPartAt> body = person();
  for (auto& part : body) ++part.parent;
  body.insert(body.begin(), {"Reference", -1, {0, 0, 0}});
  Motion rig;
  rig.skeleton = testing::skeleton_of(body, testing::t_pose);
  const Motion expected = walk(testing::t_pose);
  const Motion there = on_rig_of(on_standard(expected), rig);
  EXPECT_LT(worst_distance_m(expected, there), 2e-3);
  for (int t = 0; t < there.num_frames(); ++t) {
    EXPECT_LT(there.rotation(t, 0).angularDistance(Quat::Identity()), 1e-9);
    EXPECT_NEAR(there.root_positions[static_cast<std::size_t>(t)].y(), 0.0, 2e-3);
  }
}

// Spine and Spine1 lie along the lower back, Spine2 and Spine3 along the upper back.
TEST(ToRig, BendsASpineOfMoreJointsWhereTheStandardsBends) {
  std::vector<BodyPartAt> body = person();
  body[1].position = {0, 1.02, 0};
  body[2].position = {0, 1.34, 0};
  for (auto& part : body)
    if (part.parent >= 2) part.parent += 3;
  body.insert(
      body.begin() + 2,
      {{"Spine1", 1, {0, 1.10, 0}}, {"Spine2", 2, {0, 1.18, 0}}, {"Spine3", 3, {0, 1.26, 0}}});
  body[5].parent = 4;
  Motion rig;
  rig.skeleton = testing::skeleton_of(body, testing::t_pose);
  Motion bent = testing::resting_motion(template_skeleton(), 2, 25.0);  // the second frame
  for (const auto j :
       {standard_joint::lowerback, standard_joint::upperback, standard_joint::thorax})
    bent.rotation(1, j) = Quat(turn(20.0, Vec3::UnitX()));
  const Motion there = on_rig_of(bent, rig);
  const JointTransforms rest = there.transforms(0), pose = there.transforms(1);
  for (const auto& [name, turned_deg] : {std::pair{"Hips", 0.0},
                                         {"Spine", 20.0},
                                         {"Spine1", 20.0},
                                         {"Spine2", 40.0},
                                         {"Spine3", 40.0},
                                         {"Chest", 60.0},
                                         {"Head", 60.0},
                                         {"LeftArm", 60.0}}) {
    const auto at = static_cast<std::size_t>(rig.skeleton.find(name));
    const Mat3 turned = pose.R_world_joint[at] * rest.R_world_joint[at].transpose();
    EXPECT_LT((turned - turn(turned_deg, Vec3::UnitX())).norm(), 1e-9) << name;
  }
}

TEST(ToRig, RefusesAnotherRigAndOtherMotions) {
  const Motion motion = walk(testing::t_pose);
  const SkeletonMapping mapping = map_skeleton(motion);
  const Motion standard = on_standard(motion);
  EXPECT_THROW(to_rig(standard, mapping, standard.skeleton), std::invalid_argument);
  EXPECT_THROW(to_rig(motion, mapping, motion.skeleton), std::invalid_argument);
}

}  // namespace
}  // namespace sparse_mocap
