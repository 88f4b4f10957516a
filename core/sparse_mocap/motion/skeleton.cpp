// SPDX-License-Identifier: GPL-3.0-or-later
#include "sparse_mocap/motion/skeleton.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <set>
#include <stdexcept>
#include <utility>

namespace sparse_mocap {
namespace {

int index_of(Axis axis) { return static_cast<int>(axis); }

Mat3 elementary_rotation(Axis axis, double angle) {
  return Eigen::AngleAxisd(angle, unit(axis)).toRotationMatrix();
}

double wrapped_near(double angle, double reference) {
  return angle + 2.0 * kPi * std::round((reference - angle) / (2.0 * kPi));
}

// The angle about one axis that brings I closest to R (chordal distance).
double closest_single_angle(const Mat3& R, Axis axis) {
  const int i = index_of(axis);
  const int j = (i + 1) % 3;
  const int k = (i + 2) % 3;
  return std::atan2(R(k, j) - R(j, k), R(j, j) + R(k, k));
}

// R = R(outer, a) * R(inner, b), closest in the chordal sense, by alternation: each half step is
// the exact optimum for one angle, so the distance never grows.
std::array<double, 2> closest_two_angles(const Mat3& R, Axis outer, Axis inner,
                                         std::array<double, 2> start) {
  auto [a, b] = start;
  for (int iteration = 0; iteration < 100; ++iteration) {
    const double a_new = closest_single_angle(R * elementary_rotation(inner, -b), outer);
    const double b_new = closest_single_angle(elementary_rotation(outer, -a_new) * R, inner);
    const double change = std::abs(a_new - a) + std::abs(b_new - b);
    a = a_new;
    b = b_new;
    if (change < 1e-13) break;
  }
  return {a, b};
}

// Three different axes: the two triples (Tait-Bryan) that give R.
std::array<std::array<double, 3>, 2> tait_bryan_angles(const Mat3& R,
                                                       const std::vector<Axis>& axes) {
  const int i = index_of(axes[0]);
  const int j = index_of(axes[1]);
  const int k = index_of(axes[2]);
  const double sign = (j == (i + 1) % 3) ? 1.0 : -1.0;
  const double sin_b = sign * R(i, k);
  const double cos_b = std::hypot(R(i, i), R(i, j));
  const double b = std::atan2(sin_b, cos_b);
  if (cos_b < 1e-9) {
    const double a = std::atan2(sign * R(k, j), R(j, j));
    return {{{a, b, 0.0}, {a, b, 0.0}}};
  }
  const double a = std::atan2(-sign * R(j, k), R(k, k));
  const double c = std::atan2(-sign * R(i, j), R(i, i));
  return {{{a, b, c}, {a + kPi, kPi - b, c + kPi}}};
}

// Joint by joint; offset_parent(j) and R_joint(j) are those of joint j.
template <typename Offset, typename Rotation>
void place_joints(const Skeleton& skeleton, const Vec3& position_root, const Offset& offset_parent,
                  const Rotation& R_joint, JointTransforms& out) {
  const auto n = static_cast<std::size_t>(skeleton.num_joints());
  out.R_world_joint.resize(n);
  out.pivot.resize(n);
  out.end.resize(n);
  for (std::size_t j = 0; j < n; ++j) {
    const Joint& joint = skeleton.joints()[j];
    if (joint.parent < 0) {
      out.pivot[j] = position_root;
      out.R_world_joint[j] = R_joint(j);
    } else {
      const auto p = static_cast<std::size_t>(joint.parent);
      out.pivot[j] = out.end[p] + out.R_world_joint[p] * offset_parent(j);
      out.R_world_joint[j].noalias() = out.R_world_joint[p] * R_joint(j);
    }
    out.end[j] = out.pivot[j] + out.R_world_joint[j] * joint.bone;
  }
}

bool are_different(const std::vector<Axis>& axes) {
  return axes[0] != axes[1] && axes[1] != axes[2] && axes[0] != axes[2];
}

}  // namespace

Vec3 unit(Axis axis) { return Vec3::Unit(index_of(axis)); }

Skeleton::Skeleton(std::vector<Joint> joints) : joints_(std::move(joints)) {
  std::set<std::string_view> names;
  for (int j = 0; j < num_joints(); ++j) {
    const Joint& joint = joints_[static_cast<std::size_t>(j)];
    if (joint.name.empty() || !names.insert(joint.name).second)
      throw std::invalid_argument("skeleton: joint name empty or repeated: '" + joint.name + "'");
    if ((joint.parent < 0) != (j == 0) || joint.parent >= j)
      throw std::invalid_argument("skeleton: parent of '" + joint.name + "' must precede it");
    if (!joint.offset_parent.allFinite() || !joint.bone.allFinite() ||
        !joint.R_joint_axes.allFinite())
      throw std::invalid_argument("skeleton: lengths of '" + joint.name + "' are not finite");
    if (joint.axes.size() > 3 || (joint.axes.size() == 3 && !are_different(joint.axes)))
      throw std::invalid_argument("skeleton: '" + joint.name + "' repeats an axis");
    angle_begins_.push_back(num_angles_);
    num_angles_ += static_cast<int>(joint.axes.size());
  }
}

int Skeleton::find(std::string_view name) const {
  for (int j = 0; j < num_joints(); ++j)
    if (joint(j).name == name) return j;
  return -1;
}

Mat3 joint_rotation(const Joint& joint, const double* angles) {
  if (joint.axes.empty()) return Mat3::Identity();
  Mat3 R = joint.R_joint_axes;
  // A turn about one axis mixes the two other columns.
  for (std::size_t i = 0; i < joint.axes.size(); ++i) {
    const double s = std::sin(angles[i]), c = std::cos(angles[i]);
    const int axis = index_of(joint.axes[i]);
    const int j = (axis + 1) % 3, k = (axis + 2) % 3;
    const Vec3 column_j = R.col(j), column_k = R.col(k);
    R.col(j) = c * column_j + s * column_k;
    R.col(k) = c * column_k - s * column_j;
  }
  return R * joint.R_joint_axes.transpose();
}

void joint_angles(const Joint& joint, const Mat3& R_joint, const double* reference,
                  double* angles) {
  const std::size_t count = joint.axes.size();
  if (count == 0) return;
  const Mat3 R = joint.R_joint_axes.transpose() * R_joint * joint.R_joint_axes;
  std::array<double, 3> near{};  // a copy: angles may be the reference
  if (reference != nullptr) std::copy_n(reference, count, near.begin());
  std::array<double, 3> best{};
  if (count == 1) {
    best[0] = wrapped_near(closest_single_angle(R, joint.axes[0]), near[0]);
  } else if (count == 2) {
    const auto pair = closest_two_angles(R, joint.axes[0], joint.axes[1], {near[0], near[1]});
    for (std::size_t i = 0; i < 2; ++i) best[i] = wrapped_near(pair[i], near[i]);
  } else {
    double shortest = std::numeric_limits<double>::infinity();
    for (auto candidate : tait_bryan_angles(R, joint.axes)) {
      double distance = 0.0;
      for (std::size_t i = 0; i < 3; ++i) {
        candidate[i] = wrapped_near(candidate[i], near[i]);
        distance += (candidate[i] - near[i]) * (candidate[i] - near[i]);
      }
      if (distance >= shortest) continue;
      shortest = distance;
      best = candidate;
    }
  }
  std::copy_n(best.begin(), count, angles);
}

void unwind_pose(const Skeleton& skeleton, const Eigen::VectorXd& reference,
                 Eigen::Ref<Eigen::VectorXd> angles) {
  for (Eigen::Index i = 0; i < angles.size(); ++i)
    angles[i] = wrapped_near(angles[i], reference[i]);
  for (int j = 0; j < skeleton.num_joints(); ++j) {
    if (skeleton.joint(j).axes.size() != 3) continue;
    const Vec3 near = reference.segment<3>(skeleton.angle_begin(j));
    auto triple = angles.segment<3>(skeleton.angle_begin(j));
    const Vec3 other(wrapped_near(triple[0] + kPi, near[0]), wrapped_near(kPi - triple[1], near[1]),
                     wrapped_near(triple[2] + kPi, near[2]));
    if ((other - near).squaredNorm() < (triple - near).squaredNorm()) triple = other;
  }
}

void forward_kinematics(const Skeleton& skeleton, const Vec3& position_root,
                        const std::vector<Mat3>& R_joint, JointTransforms& out) {
  place_joints(
      skeleton, position_root,
      [&](std::size_t j) -> const Vec3& { return skeleton.joints()[j].offset_parent; },
      [&](std::size_t j) -> const Mat3& { return R_joint[j]; }, out);
}

void forward_kinematics(const Skeleton& skeleton, const std::vector<Vec3>& offset_parent,
                        const Vec3& position_root, const std::vector<Mat3>& R_joint,
                        JointTransforms& out) {
  place_joints(
      skeleton, position_root, [&](std::size_t j) -> const Vec3& { return offset_parent[j]; },
      [&](std::size_t j) -> const Mat3& { return R_joint[j]; }, out);
}

void forward_kinematics(const Skeleton& skeleton, const Vec3& position_root,
                        const Eigen::VectorXd& angles, JointTransforms& out) {
  place_joints(
      skeleton, position_root,
      [&](std::size_t j) -> const Vec3& { return skeleton.joints()[j].offset_parent; },
      [&](std::size_t j) {
        const int begin = skeleton.angle_begin(static_cast<int>(j));
        return joint_rotation(skeleton.joints()[j], angles.data() + begin);
      },
      out);
}

Eigen::VectorXd stacked_ends(const JointTransforms& transforms) {
  Eigen::VectorXd ends(3 * static_cast<Eigen::Index>(transforms.end.size()));
  for (std::size_t j = 0; j < transforms.end.size(); ++j)
    ends.segment<3>(3 * static_cast<Eigen::Index>(j)) = transforms.end[j];
  return ends;
}

JointTransforms rest_pose(const Skeleton& skeleton) {
  JointTransforms rest;
  forward_kinematics(
      skeleton, Vec3::Zero(),
      std::vector<Mat3>(static_cast<std::size_t>(skeleton.num_joints()), Mat3::Identity()), rest);
  return rest;
}

}  // namespace sparse_mocap
