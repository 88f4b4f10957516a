// SPDX-License-Identifier: GPL-3.0-or-later
#include "sparse_mocap/motion/standard_skeleton.hpp"

#include <algorithm>
#include <stdexcept>

namespace sparse_mocap {
namespace {

using namespace standard_joint;  // the 21 names are the vocabulary of this file

struct Topology {
  std::string_view name;
  int parent;
  // Degrees about fixed x, y, z, in that order: the `axis` of Acclaim.
  Vec3 axis_deg;
  std::vector<Axis> axes;
  Vec3 template_bone_m;
};

// Angle sequences are outermost first, so Acclaim's `dof rx ry rz` reads z, y, x.
const std::array<Topology, kNumStandardJoints>& topology() {
  static const std::vector<Axis> zyx{Axis::z, Axis::y, Axis::x};
  static const std::vector<Axis> zy{Axis::z, Axis::y};
  static const std::vector<Axis> x{Axis::x};
  static const std::vector<Axis> y{Axis::y};
  static const Vec3 none = Vec3::Zero();
  static const Vec3 l_leg{0, 0, 20}, r_leg{0, 0, -20};
  static const Vec3 l_arm{180, -30, -90}, r_arm{180, 30, 90};
  static const Vec3 l_hand{0, 90, 90}, r_hand{0, -90, -90};
  static const std::array<Topology, kNumStandardJoints> table{{
      {"root", -1, none, zyx, {0, 0, 0}},
      {"lhipjoint", root, none, {}, {0.085, -0.105, 0.043}},
      {"lfemur", lhipjoint, l_leg, zyx, {0.140, -0.385, 0}},
      {"ltibia", lfemur, l_leg, x, {0.144, -0.396, 0}},
      {"rhipjoint", root, none, {}, {-0.085, -0.105, 0.043}},
      {"rfemur", rhipjoint, r_leg, zyx, {-0.140, -0.385, 0}},
      {"rtibia", rfemur, r_leg, x, {-0.144, -0.396, 0}},
      {"lowerback", root, none, zyx, {0, 0.140, -0.012}},
      {"upperback", lowerback, none, zyx, {0, 0.142, -0.006}},
      {"thorax", upperback, none, zyx, {0, 0.144, 0}},
      {"lowerneck", thorax, none, zyx, {0, 0.090, 0}},
      {"upperneck", lowerneck, none, zyx, {0, 0.089, -0.007}},
      {"head", upperneck, none, zyx, {0, 0.092, -0.002}},
      {"lclavicle", thorax, none, zy, {0.236, 0.036, -0.014}},
      {"lhumerus", lclavicle, l_arm, zyx, {0.280, 0, 0}},
      {"lradius", lhumerus, l_arm, x, {0.188, 0, 0}},
      {"lwrist", lradius, l_hand, y, {0.094, 0, 0}},
      {"rclavicle", thorax, none, zy, {-0.236, 0.036, -0.014}},
      {"rhumerus", rclavicle, r_arm, zyx, {-0.280, 0, 0}},
      {"rradius", rhumerus, r_arm, x, {-0.188, 0, 0}},
      {"rwrist", rradius, r_hand, y, {-0.094, 0, 0}},
  }};
  return table;
}

Mat3 rotation_of_fixed_axes(const Vec3& degrees) {
  const Vec3 a = degrees * kRadiansPerDegree;
  return (Eigen::AngleAxisd(a.z(), Vec3::UnitZ()) * Eigen::AngleAxisd(a.y(), Vec3::UnitY()) *
          Eigen::AngleAxisd(a.x(), Vec3::UnitX()))
      .toRotationMatrix();
}

Vec3 mirrored(const Vec3& v) { return {-v.x(), v.y(), v.z()}; }

}  // namespace

const std::array<std::string_view, kNumStandardJoints>& standard_joint_names() {
  static const auto names = [] {
    std::array<std::string_view, kNumStandardJoints> out;
    std::transform(topology().begin(), topology().end(), out.begin(),
                   [](const Topology& t) { return t.name; });
    return out;
  }();
  return names;
}

const StandardBones& template_bones() {
  static const auto bones = [] {
    StandardBones out;
    std::transform(topology().begin(), topology().end(), out.begin(),
                   [](const Topology& t) { return t.template_bone_m; });
    return out;
  }();
  return bones;
}

Skeleton make_standard_skeleton(const StandardBones& bones) {
  std::vector<Joint> joints;
  for (std::size_t j = 0; j < topology().size(); ++j) {
    const Topology& t = topology()[j];
    joints.push_back({std::string(t.name), t.parent, Vec3::Zero(), bones[j],
                      rotation_of_fixed_axes(t.axis_deg), t.axes});
  }
  return Skeleton(std::move(joints));
}

StandardBones bones_of(const Skeleton& standard_skeleton) {
  if (standard_skeleton.num_joints() < kNumStandardJoints)
    throw std::invalid_argument("bones_of: not a standard skeleton");
  StandardBones bones;
  for (std::size_t j = 0; j < bones.size(); ++j) bones[j] = standard_skeleton.joints()[j].bone;
  return bones;
}

StandardBones averaged_bones(const std::vector<StandardBones>& bodies) {
  if (bodies.empty()) throw std::invalid_argument("averaged_bones: no bodies");
  StandardBones mean;
  for (std::size_t j = 0; j < mean.size(); ++j) {
    const auto other = static_cast<std::size_t>(standard_left_right()[j]);
    Vec3 sum = Vec3::Zero();
    for (const auto& bones : bodies) sum += bones[j] + mirrored(bones[other]);
    mean[j] = sum / (2.0 * static_cast<double>(bodies.size()));
  }
  return mean;
}

const std::vector<int>& standard_left_right() {
  static const std::vector<int> pairs{root,     rhipjoint, rfemur,    rtibia,  lhipjoint, lfemur,
                                      ltibia,   lowerback, upperback, thorax,  lowerneck, upperneck,
                                      head,     rclavicle, rhumerus,  rradius, rwrist,    lclavicle,
                                      lhumerus, lradius,   lwrist};
  return pairs;
}

double leg_length_m(const StandardBones& bones) {
  return 0.5 * (bones[lfemur].norm() + bones[ltibia].norm() + bones[rfemur].norm() +
                bones[rtibia].norm());
}

}  // namespace sparse_mocap
