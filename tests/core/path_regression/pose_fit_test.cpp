// SPDX-License-Identifier: GPL-3.0-or-later
#include "sparse_mocap/path_regression/pose_fit.hpp"

#include <gtest/gtest.h>

#include <limits>

#include "sparse_mocap/motion/standard_skeleton.hpp"
#include "sparse_mocap/sensors/sites.hpp"
#include "support/synthetic.hpp"

namespace sparse_mocap::path_regression {
namespace {

using namespace standard_joint;
using retrieval::Signal;
using testing::Random;
using testing::template_skeleton;

const Skeleton kSkeleton = template_skeleton();

JointTransforms posed(const Eigen::VectorXd& angles) {
  JointTransforms pose;
  forward_kinematics(kSkeleton, Vec3::Zero(), angles, pose);
  return pose;
}

// What a sensor reads of gravity in a pose of the standard skeleton.
Vec3 gravity_direction_at(const Eigen::VectorXd& angles, int site) {
  const Site& worn = all_sites()[static_cast<std::size_t>(site)];
  const Mat3 R_world_sensor =
      posed(angles).R_world_joint[static_cast<std::size_t>(worn.orientation)] * worn.R_joint_sensor;
  return R_world_sensor.transpose() * kUp;
}

PoseFit random_fit(Random& random) {
  return {kSkeleton,
          {{2.0, random.column(63, 0.8), 0.3}, {0.5, random.column(63, 0.8), 0.1}},
          {3.0, {rwrist, lfemur}, random.column(2, 0.4)}};
}

TEST(PositionTarget, IsTheWeightedSumOfSquaredDistances) {
  Random random(1);
  const Eigen::MatrixXd targets = random.matrix(63, 9, 0.8);
  Eigen::VectorXd weights = random.column(9, 1.0).array().abs() + 0.01;
  weights /= weights.sum();
  const PoseFit fit(kSkeleton, {position_target(2.5, targets, weights)}, {});
  for (int trial = 0; trial < 5; ++trial) {
    const Eigen::VectorXd angles = random.column(43, 1.0);
    const Eigen::VectorXd y = stacked_ends(posed(angles));
    double expected = 0.0;
    for (Eigen::Index i = 0; i < 9; ++i)
      expected += 2.5 * weights[i] * (targets.col(i) - y).squaredNorm();
    EXPECT_NEAR(fit.value(angles), expected, 1e-9 * expected);
  }
}

TEST(InclinationTarget, IsMetInThePoseThatWasMeasured) {
  Random random(4);
  const Channels inertial = Channel::specific_force | Channel::gravity_direction;
  const std::vector<Sensor> sensors{{find_site("left_wrist"), 1.0, inertial},
                                    {find_site("right_ankle"), 1.0, inertial},
                                    {find_site("left_thigh"), 1.0, Channel::specific_force},
                                    {find_site("head"), 1.0, inertial}};
  const auto signals = retrieval::compared_signals(sensors, true);
  for (int trial = 0; trial < 10; ++trial) {
    const Eigen::VectorXd angles = random.column(kNumStandardAngles, 0.6);
    Reading reading(4);
    for (Eigen::Index s = 0; s < 4; ++s)
      reading.gravity_direction.col(s) =
          gravity_direction_at(angles, sensors[static_cast<std::size_t>(s)].site);
    const auto target = inclination_target(2.0, kSkeleton, reading, signals);
    EXPECT_EQ(target.joints, (std::vector<int>{lradius, rtibia}));
    const PoseFit fit(kSkeleton, {}, target);
    EXPECT_NEAR(fit.value(angles), 0.0, 1e-12);
    EXPECT_GT(fit.value(random.column(kNumStandardAngles, 0.6)), 1e-4);
  }
}

TEST(InclinationTarget, LeavesSilentSensorsOut) {
  const auto signals = retrieval::compared_signals(
      {{find_site("left_wrist"), 1.0, Channel::specific_force | Channel::gravity_direction}}, true);
  EXPECT_TRUE(inclination_target(2.0, kSkeleton, Reading(1), signals).joints.empty());
}

TEST(PoseFit, GradientEqualsCentralDifferences) {
  Random random(2);
  const PoseFit fit = random_fit(random);
  const Eigen::VectorXd angles = random.column(43, 1.0);
  const auto model = fit.majorised(angles, Eigen::MatrixXd::Identity(43, 43));
  EXPECT_NEAR(model.value, fit.value(angles), 1e-12);
  for (Eigen::Index a = 0; a < 43; ++a) {
    Eigen::VectorXd more = angles, less = angles;
    more[a] += 1e-5;
    less[a] -= 1e-5;
    EXPECT_NEAR(model.gradient[a], (fit.value(more) - fit.value(less)) / 2e-5, 1e-6);
  }
}

// Where positions are linear in the angles, the model is the fit itself; nearby almost.
TEST(PoseFit, ModelIsOfSecondOrderAtAMinimum) {
  Random random(3);
  const Eigen::VectorXd angles = random.column(43, 0.5);
  const PoseFit fit(kSkeleton, {{1.0, stacked_ends(posed(angles)), 0.0}}, {});
  const auto model = fit.majorised(angles, Eigen::MatrixXd::Identity(43, 43));
  const Eigen::VectorXd d = random.column(43, 1e-4);
  const double expected = fit.value(angles + d);
  EXPECT_NEAR(model.value + model.gradient.dot(d) + 0.5 * d.dot(model.hessian * d), expected,
              1e-2 * expected);
}

TEST(PoseFit, ModelInABasisIsTheWholeOneSeenThere) {
  Random random(5);
  const PoseFit fit = random_fit(random);
  const Eigen::VectorXd angles = random.column(43, 1.0);
  const Eigen::MatrixXd basis = random.matrix(43, 7, 1.0);
  const auto whole = fit.majorised(angles, Eigen::MatrixXd::Identity(43, 43));
  const auto seen = fit.majorised(angles, basis);
  EXPECT_LT((seen.gradient - basis.transpose() * whole.gradient).norm(), 1e-9);
  EXPECT_LT((seen.hessian - basis.transpose() * whole.hessian * basis).norm(), 1e-8);
}

}  // namespace
}  // namespace sparse_mocap::path_regression
