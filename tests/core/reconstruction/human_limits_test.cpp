// SPDX-License-Identifier: GPL-3.0-or-later
#include "sparse_mocap/reconstruction/human_limits.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "sparse_mocap/motion/standard_skeleton.hpp"
#include "support/synthetic.hpp"

namespace sparse_mocap {
namespace {

using namespace standard_joint;

const Skeleton kSkeleton = testing::template_skeleton();
constexpr double kRate_hz = 25.0;

PoseEstimate resting() {
  PoseEstimate estimate;
  estimate.rotations.assign(kNumStandardJoints, Quat::Identity());
  return estimate;
}

Quat bent(int joint, double degrees) {
  const double angle = degrees * kRadiansPerDegree;
  return Quat(joint_rotation(kSkeleton.joint(joint), &angle));
}

double degrees_between(const Quat& a, const Quat& b) {
  return a.angularDistance(b) / kRadiansPerDegree;
}

TEST(HumanLimits, LeaveAMotionThatPeopleDoAlone) {
  HumanLimits limits(kSkeleton, kRate_hz);
  for (int t = 0; t < 60; ++t) {
    PoseEstimate estimate;
    for (int j = 0; j < kNumStandardJoints; ++j) {
      // Hinges bend, no joint is turned backwards.
      const Vec3 angles = Vec3::Constant(0.3 + 0.25 * std::sin(0.3 * t + j));
      estimate.rotations.emplace_back(joint_rotation(kSkeleton.joint(j), angles.data()));
    }
    const auto before = estimate.rotations;
    limits.apply(estimate);
    for (std::size_t j = 0; j < before.size(); ++j)
      EXPECT_EQ(estimate.rotations[j].coeffs(), before[j].coeffs()) << t << " " << j;
  }
}

TEST(HumanLimits, EndHowFarAHingeBends) {
  for (const auto& [wanted, expected] :
       {std::pair{60.0, 60.0}, {-40.0, -10.0}, {-9.0, -9.0}, {185.0, 170.0}, {215.0, 170.0}}) {
    PoseEstimate estimate = resting();
    estimate.rotations[ltibia] = bent(ltibia, wanted);
    HumanLimits(kSkeleton, kRate_hz).apply(estimate);
    EXPECT_LT(degrees_between(estimate.rotations[ltibia], bent(ltibia, expected)), 1e-6) << wanted;
  }
}

TEST(HumanLimits, EndHowFarTheBackBends) {
  PoseEstimate estimate = resting();
  estimate.rotations[thorax] = Quat(Eigen::AngleAxisd(2.0, Vec3::UnitX()));
  HumanLimits(kSkeleton, kRate_hz).apply(estimate);
  EXPECT_NEAR(degrees_between(estimate.rotations[thorax], Quat::Identity()), 60.0, 1e-6);
}

TEST(HumanLimits, EndHowFastAJointTurnsAndLetItArrive) {
  HumanLimits limits(kSkeleton, kRate_hz);
  PoseEstimate estimate = resting();
  limits.apply(estimate);
  const Quat wanted(Eigen::AngleAxisd(2.4, Vec3::UnitY()));
  double turned = 0.0;
  for (int t = 1; t < 5; ++t) {
    estimate.rotations[rwrist] = wanted;
    limits.apply(estimate);
    turned = std::min(turned + 1400.0 / kRate_hz, 2.4 / kRadiansPerDegree);
    EXPECT_NEAR(degrees_between(estimate.rotations[rwrist], Quat::Identity()), turned, 1e-6);
  }
  limits.reset();
  estimate = resting();
  limits.apply(estimate);
  EXPECT_EQ(estimate.rotations[rwrist].w(), 1.0);
}

}  // namespace
}  // namespace sparse_mocap
