// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>

#include "sparse_mocap/motion/skeleton.hpp"
#include "support/synthetic.hpp"

namespace sparse_mocap {
namespace {

using testing::Random;

constexpr std::array kAxes{Axis::x, Axis::y, Axis::z};

std::vector<std::vector<Axis>> all_sequences_of_different_axes() {
  std::vector<std::vector<Axis>> out;
  for (const Axis a : kAxes) {
    out.push_back({a});
    for (const Axis b : kAxes) {
      if (a == b) continue;
      out.push_back({a, b});
      for (const Axis c : kAxes)
        if (c != a && c != b) out.push_back({a, b, c});
    }
  }
  return out;
}

Joint turned_joint(Random& random, std::vector<Axis> axes) {
  Joint joint;
  joint.name = "joint";
  joint.R_joint_axes = random.rotation().toRotationMatrix();
  joint.axes = std::move(axes);
  return joint;
}

// Rodrigues' formula, so that nothing is shared with what is tested.
Mat3 turn(const Vec3& axis, double angle) {
  Mat3 k;
  k << 0, -axis.z(), axis.y(), axis.z(), 0, -axis.x(), -axis.y(), axis.x(), 0;
  return Mat3::Identity() + std::sin(angle) * k + (1.0 - std::cos(angle)) * k * k;
}

TEST(JointRotation, TurnsAboutTheJointsAxesOutermostFirst) {
  Random random(1);
  for (const auto& axes : all_sequences_of_different_axes()) {
    const Joint joint = turned_joint(random, axes);
    const Eigen::VectorXd angles = random.column(3, 4.0);
    Mat3 expected = Mat3::Identity();
    for (std::size_t i = 0; i < axes.size(); ++i) {
      const Vec3 axis = joint.R_joint_axes.col(static_cast<int>(axes[i]));
      expected = expected * turn(axis, angles[static_cast<Eigen::Index>(i)]);
    }
    EXPECT_LT((joint_rotation(joint, angles.data()) - expected).norm(), 1e-12);
  }
}

TEST(JointAngles, FindTheAnglesOfEverySequenceOfAxes) {
  Random random(2);
  for (const auto& axes : all_sequences_of_different_axes()) {
    for (int trial = 0; trial < 40; ++trial) {
      const Joint joint = turned_joint(random, axes);
      const Eigen::VectorXd wanted = random.column(3, 6.0);
      std::array<double, 3> found{};
      joint_angles(joint, joint_rotation(joint, wanted.data()), wanted.data(), found.data());
      for (std::size_t i = 0; i < axes.size(); ++i)
        EXPECT_NEAR(found[i], wanted[static_cast<Eigen::Index>(i)], 1e-6);
    }
  }
}

TEST(JointAngles, ReachAnyRotationWithThreeAxesFromAnyReference) {
  Random random(3);
  for (const auto& axes : all_sequences_of_different_axes()) {
    if (axes.size() != 3) continue;
    for (int trial = 0; trial < 100; ++trial) {
      const Joint joint = turned_joint(random, axes);
      const Mat3 R = random.rotation().toRotationMatrix();
      const Eigen::VectorXd reference = random.column(3, 10.0);
      std::array<double, 3> found{};
      joint_angles(joint, R, trial % 2 == 0 ? reference.data() : nullptr, found.data());
      EXPECT_LT((joint_rotation(joint, found.data()) - R).norm(), 1e-9);
    }
  }
}

TEST(JointAngles, TakeTheTripleNearerToTheReferenceWhichMayBeTheOutput) {
  Random random(4);
  const Joint joint = turned_joint(random, {Axis::z, Axis::y, Axis::x});
  for (int trial = 0; trial < 100; ++trial) {
    const Eigen::Vector3d wanted = random.column(3, 8.0);
    Eigen::Vector3d angles = wanted + random.column(3, 0.3);
    joint_angles(joint, joint_rotation(joint, wanted.data()), angles.data(), angles.data());
    EXPECT_LT((angles - wanted).norm(), 1e-6);
  }
}

TEST(JointAngles, SurviveGimbalLock) {
  Random random(5);
  for (const auto& axes : all_sequences_of_different_axes()) {
    if (axes.size() != 3) continue;
    for (const double off : {0.0, 1e-12, 1e-10, 1e-9, 1e-8, 1e-6, 1e-3}) {
      for (const double side : {-1.0, 1.0}) {
        const Joint joint = turned_joint(random, axes);
        const Eigen::Vector3d locked(random.in(-3, 3), side * (kPi / 2 - off), random.in(-3, 3));
        const Mat3 R = joint_rotation(joint, locked.data());
        Eigen::Vector3d found;
        joint_angles(joint, R, nullptr, found.data());
        // Beside the lock the two outer angles are each known only to 1e-16 / off.
        EXPECT_LT((joint_rotation(joint, found.data()) - R).norm(), 3e-6) << off;
      }
    }
  }
}

double distance_at(const Joint& joint, const Mat3& R, double a, double b) {
  const std::array<double, 2> angles{a, b};
  return (joint_rotation(joint, angles.data()) - R).norm();
}

TEST(JointAngles, AreTheClosestThatOneAxisAllows) {
  Random random(6);
  for (int trial = 0; trial < 30; ++trial) {
    const Joint joint = turned_joint(random, {kAxes[static_cast<std::size_t>(trial % 3)]});
    const Mat3 R = random.rotation().toRotationMatrix();
    double found = 0.0, best = std::numeric_limits<double>::infinity();
    joint_angles(joint, R, nullptr, &found);
    for (int i = 0; i < 3600; ++i) {
      const double angle = i * kPi / 1800;
      best = std::min(best, (joint_rotation(joint, &angle) - R).norm());
    }
    EXPECT_LT((joint_rotation(joint, &found) - R).norm(), best + 1e-9);
  }
}

// A grid of 5 degrees comes within 0.1 of the optimum's distance at worst; a local optimum would
// be off by more.
TEST(JointAngles, AreTheClosestThatTwoAxesAllow) {
  Random random(7);
  const std::vector<std::vector<Axis>> pairs{
      {Axis::z, Axis::y}, {Axis::x, Axis::z}, {Axis::y, Axis::x}, {Axis::y, Axis::z}};
  for (int trial = 0; trial < 80; ++trial) {
    const Joint joint = turned_joint(random, pairs[static_cast<std::size_t>(trial % 4)]);
    const Mat3 R = random.rotation().toRotationMatrix();
    std::array<double, 2> found{};
    joint_angles(joint, R, nullptr, found.data());
    double best = std::numeric_limits<double>::infinity();
    for (int i = 0; i < 72; ++i)
      for (int k = 0; k < 72; ++k)
        best = std::min(best, distance_at(joint, R, i * kPi / 36, k * kPi / 36));
    EXPECT_LT(distance_at(joint, R, found[0], found[1]), best + 1e-9) << "trial " << trial;
  }
}

TEST(JointAngles, LeaveAJointWithoutAxesAlone) {
  Joint joint;
  joint.R_joint_axes = turn(Vec3::UnitX(), 0.5);
  double untouched = 42.0;
  joint_angles(joint, turn(Vec3::UnitY(), 1.0), nullptr, &untouched);
  EXPECT_EQ(untouched, 42.0);
  EXPECT_EQ(joint_rotation(joint, nullptr), Mat3::Identity());
}

}  // namespace
}  // namespace sparse_mocap
