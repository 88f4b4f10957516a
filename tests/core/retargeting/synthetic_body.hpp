// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cmath>
#include <string>
#include <vector>

#include "sparse_mocap/motion/motion.hpp"

namespace sparse_mocap::testing {

struct BodyPartAt {
  const char* name;
  int parent;
  Vec3 position;  // in T-pose, m
};

// A person of 1.8 m in T-pose, facing +z.
inline std::vector<BodyPartAt> person() {
  return {{"Hips", -1, {0, 0.95, 0}},
          {"Spine", 0, {0, 1.07, 0}},
          {"Chest", 1, {0, 1.25, 0}},
          {"Neck", 2, {0, 1.5, 0}},
          {"Head", 3, {0, 1.6, 0}},
          {"HeadEnd", 4, {0, 1.78, 0}},
          {"LeftCollar", 2, {0.03, 1.45, 0}},
          {"LeftArm", 6, {0.2, 1.45, 0}},
          {"LeftForeArm", 7, {0.48, 1.45, 0}},
          {"LeftHand", 8, {0.74, 1.45, 0}},
          {"LeftFingers", 9, {0.84, 1.45, 0}},
          {"RightCollar", 2, {-0.03, 1.45, 0}},
          {"RightArm", 11, {-0.2, 1.45, 0}},
          {"RightForeArm", 12, {-0.48, 1.45, 0}},
          {"RightHand", 13, {-0.74, 1.45, 0}},
          {"RightFingers", 14, {-0.84, 1.45, 0}},
          {"LeftUpLeg", 0, {0.1, 0.9, 0}},
          {"LeftLeg", 16, {0.1, 0.5, 0}},
          {"LeftFoot", 17, {0.1, 0.08, 0}},
          {"LeftToes", 18, {0.1, 0, 0.18}},
          {"RightUpLeg", 0, {-0.1, 0.9, 0}},
          {"RightLeg", 20, {-0.1, 0.5, 0}},
          {"RightFoot", 21, {-0.1, 0.08, 0}},
          {"RightToes", 22, {-0.1, 0, 0.18}}};
}

inline bool is_below(const std::vector<BodyPartAt>& body, int joint, const std::string& ancestor) {
  for (; joint >= 0; joint = body[static_cast<std::size_t>(joint)].parent)
    if (body[static_cast<std::size_t>(joint)].name == ancestor) return true;
  return false;
}

inline Mat3 turn(double degrees, const Vec3& axis) {
  return Eigen::AngleAxisd(degrees * kRadiansPerDegree, axis).toRotationMatrix();
}

// The turn of each joint's frame from the T-pose to another rest pose of the same body.
using RestTurn = Mat3 (*)(const std::vector<BodyPartAt>& body, int joint);

inline Mat3 t_pose(const std::vector<BodyPartAt>&, int) { return Mat3::Identity(); }
inline Mat3 a_pose(const std::vector<BodyPartAt>& body, int joint) {
  if (is_below(body, joint, "LeftArm")) return turn(-50.0, Vec3::UnitZ());
  if (is_below(body, joint, "RightArm")) return turn(50.0, Vec3::UnitZ());
  return Mat3::Identity();
}
inline Mat3 i_pose(const std::vector<BodyPartAt>& body, int joint) {
  if (is_below(body, joint, "LeftArm")) return turn(-85.0, Vec3::UnitZ());
  if (is_below(body, joint, "RightArm")) return turn(85.0, Vec3::UnitZ());
  return Mat3::Identity();
}
inline Mat3 lying(const std::vector<BodyPartAt>&, int) { return turn(-90.0, Vec3::UnitX()); }
// Every bone along its own joint's x: no pose at all.
inline Mat3 along_x(const std::vector<BodyPartAt>& body, int joint) {
  if (is_below(body, joint, "LeftArm")) return Mat3::Identity();
  if (is_below(body, joint, "RightArm")) return turn(180.0, Vec3::UnitX());
  if (is_below(body, joint, "LeftUpLeg")) return turn(90.0, Vec3::UnitZ());
  if (is_below(body, joint, "RightUpLeg")) return turn(-90.0, Vec3::UnitZ());
  return turn(-90.0, Vec3::UnitZ());
}

// World rotations of a person who walks, swings bent arms and turns.
inline Mat3 world_rotation(const std::vector<BodyPartAt>& body, int joint, double phase) {
  const Mat3 heading = turn(20.0 * phase, Vec3::UnitY());
  const double swing = std::sin(phase);
  for (const double side : {1.0, -1.0}) {
    const std::string name = side > 0 ? "Left" : "Right";
    const Mat3 arm =
        heading * turn(30.0 * side * swing, Vec3::UnitX()) * turn(-70.0 * side, Vec3::UnitZ());
    const Mat3 elbow = turn(-side * (45.0 + 25.0 * swing), Vec3::UnitY());
    const Mat3 leg = heading * turn(-35.0 * side * swing, Vec3::UnitX());
    if (is_below(body, joint, name + "ForeArm")) return arm * elbow;
    if (is_below(body, joint, name + "Arm")) return arm;
    if (is_below(body, joint, name + "Leg"))
      return leg * turn(35.0 + 20.0 * side * swing, Vec3::UnitX());
    if (is_below(body, joint, name + "UpLeg")) return leg;
  }
  if (is_below(body, joint, "Chest")) return heading * turn(8.0 * swing, Vec3::UnitY());
  return heading;
}

inline Skeleton skeleton_of(const std::vector<BodyPartAt>& body, RestTurn rest) {
  std::vector<Joint> joints;
  for (int j = 0; j < static_cast<int>(body.size()); ++j) {
    const auto& part = body[static_cast<std::size_t>(j)];
    Joint joint;
    joint.name = part.name;
    joint.parent = part.parent;
    joint.axes = {Axis::z, Axis::x, Axis::y};
    if (part.parent >= 0)
      joint.offset_parent = rest(body, part.parent) *
                            (part.position - body[static_cast<std::size_t>(part.parent)].position);
    joints.push_back(joint);
  }
  return Skeleton(joints);
}

// The person's walk on a skeleton with this rest pose.
inline Motion walk(RestTurn rest, const std::vector<BodyPartAt>& body = person()) {
  Motion motion;
  motion.skeleton = skeleton_of(body, rest);
  motion.frame_time_s = 1.0 / 30.0;
  for (int t = 0; t < 60; ++t) {
    const double phase = 0.1 * t;
    motion.root_positions.emplace_back(0.1 * phase, 0.95, 0.4 * phase);
    for (int j = 0; j < static_cast<int>(body.size()); ++j) {
      const int parent = body[static_cast<std::size_t>(j)].parent;
      const Mat3 R = world_rotation(body, j, phase) * rest(body, j).transpose();
      const Mat3 R_parent =
          parent < 0 ? Mat3::Identity()
                     : Mat3(world_rotation(body, parent, phase) * rest(body, parent).transpose());
      motion.rotations.emplace_back(Mat3(R_parent.transpose() * R));
    }
  }
  return motion;
}

}  // namespace sparse_mocap::testing
