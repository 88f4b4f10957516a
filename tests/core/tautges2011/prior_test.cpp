// SPDX-License-Identifier: GPL-3.0-or-later
//
// Each term of the energy against its equation as the paper prints it.
#include "sparse_mocap/tautges2011/prior.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "sparse_mocap/tautges2011/control.hpp"
#include "tautges2011/neighbourhoods.hpp"

namespace sparse_mocap::tautges2011 {
namespace {

using namespace standard_joint;
using testing::paper_sensors;
using testing::Random;
using testing::random_neighbourhood;
using testing::template_skeleton;

constexpr double kDt = 0.04;

class Terms : public ::testing::TestWithParam<double> {
 protected:
  Terms() {
    config_.kernel_power = GetParam();
    config_.w_prior = 5.5;
    config_.w_pose = 0.7;
    config_.w_motion = 0.3;
    config_.w_smooth = 0.25;
    config_.w_contr = 1.75;
    JointTransforms pose;
    forward_kinematics(skeleton_, Vec3::Zero(), q_, pose);
    for (Eigen::Index j = 0; j < kNumStandardJoints; ++j)
      x_.segment<3>(3 * j) = pose.end[static_cast<std::size_t>(j)];
  }

  double value(const KernelTerm& term) const {
    return Energy(skeleton_, neighbours_.weights, {term}).value(q_);
  }
  // sum_i w_i |d_i|^p
  template <typename Difference>
  double kernel_sum(const Difference& difference) const {
    double sum = 0.0;
    for (Eigen::Index i = 0; i < neighbours_.weights.size(); ++i)
      sum += neighbours_.weights[i] * std::pow(Eigen::VectorXd(difference(i)).norm(), GetParam());
    return sum;
  }
  static void expect_near(double found, double expected) {
    EXPECT_NEAR(found, expected, 2e-5 * expected);
  }

  Random random_{1};
  const Skeleton skeleton_ = template_skeleton();
  const Neighbourhood neighbours_ = random_neighbourhood(random_, 24);
  const Eigen::VectorXd q_ = random_.column(43, 1.0);
  Eigen::VectorXd x_ = Eigen::VectorXd(63);
  const Eigen::VectorXd x_now_ = random_.column(63, 1.0);
  const Eigen::VectorXd x_before_ = random_.column(63, 1.0);
  Config config_;
};

TEST_P(Terms, PosePriorIsEquationFive) {
  expect_near(value(pose_prior(neighbours_, config_)),
              5.5 * 0.7 * kernel_sum([&](Eigen::Index i) -> Eigen::VectorXd {
                return neighbours_.angles.col(i) - q_;
              }));
}

TEST_P(Terms, PosePriorMayComparePositions) {
  config_.pose_space = PoseSpace::positions;
  expect_near(value(pose_prior(neighbours_, config_)),
              5.5 * 0.7 * kernel_sum([&](Eigen::Index i) -> Eigen::VectorXd {
                return neighbours_.positions.col(i) - x_;
              }));
}

TEST_P(Terms, MotionPriorIsEquationsSixAndSeven) {
  expect_near(value(motion_prior(neighbours_, config_, x_now_, kDt)),
              5.5 * 0.3 * kernel_sum([&](Eigen::Index i) -> Eigen::VectorXd {
                return x_now_ + neighbours_.velocities.col(i) * kDt +
                       0.5 * neighbours_.accelerations.col(i) * kDt * kDt - x_;
              }));
}

TEST_P(Terms, MotionPriorMayTakeTheDatabasesOwnStep) {
  config_.motion_rule = MotionRule::exact;
  expect_near(value(motion_prior(neighbours_, config_, x_now_, kDt)),
              5.5 * 0.3 * kernel_sum([&](Eigen::Index i) -> Eigen::VectorXd {
                return x_now_ + neighbours_.steps.col(i) - x_;
              }));
}

// dt sqrt(|a_i - a|), the factor belonging to the square root; for other powers it is dt^(2 p).
TEST_P(Terms, SmoothnessPriorIsEquationsEightAndNine) {
  const Eigen::VectorXd a = (x_ - 2.0 * x_now_ + x_before_) / (kDt * kDt);
  expect_near(value(smoothness_prior(neighbours_, config_, x_now_, x_before_, kDt)),
              5.5 * 0.25 * std::pow(kDt, 2.0 * GetParam()) *
                  kernel_sum([&](Eigen::Index i) -> Eigen::VectorXd {
                    return neighbours_.accelerations.col(i) - a;
                  }));
}

TEST_P(Terms, ControlTermIsEquationsTenAndEleven) {
  const Eigen::Matrix3Xd alpha = random_.matrix(3, 4, 30.0);
  const std::vector<Eigen::Index> rows{3 * lradius, 3 * rradius, 3 * ltibia, 3 * rtibia};
  const auto next_to_sensors = [&](const Eigen::VectorXd& y) {
    Eigen::VectorXd out(12);
    for (Eigen::Index s = 0; s < 4; ++s)
      out.segment<3>(3 * s) = y.segment<3>(rows[static_cast<std::size_t>(s)]);
    return out;
  };
  expect_near(value(control_term(neighbours_, config_, x_now_, alpha, paper_sensors(), kDt)),
              1.75 * kernel_sum([&](Eigen::Index i) -> Eigen::VectorXd {
                const Eigen::VectorXd moved = x_now_ + neighbours_.velocities_before.col(i) * kDt;
                return next_to_sensors(moved) + 0.5 * kDt * kDt * alpha.reshaped() -
                       next_to_sensors(x_);
              }));
}

TEST_P(Terms, ControlTermLeavesSilentSensorsOut) {
  Eigen::Matrix3Xd alpha = random_.matrix(3, 4, 30.0);
  alpha(1, 1) = std::numeric_limits<double>::quiet_NaN();
  const std::vector<WornSensor> all = paper_sensors();
  const std::vector<WornSensor> heard{all[0], all[2], all[3]};
  Eigen::Matrix3Xd rest(3, 3);
  rest << alpha.col(0), alpha.col(2), alpha.col(3);
  expect_near(value(control_term(neighbours_, config_, x_now_, alpha, all, kDt)),
              value(control_term(neighbours_, config_, x_now_, rest, heard, kDt)));
  alpha.setConstant(std::numeric_limits<double>::quiet_NaN());
  EXPECT_EQ(value(control_term(neighbours_, config_, x_now_, alpha, all, kDt)), 0.0);
}

INSTANTIATE_TEST_SUITE_P(KernelPowers, Terms, ::testing::Values(0.5, 1.0, 2.0));

TEST(HeadingAccelerations, TurnReadingsByThePoseAndTakeGravityAway) {
  Random random(2);
  const Skeleton skeleton = template_skeleton();
  JointTransforms pose;
  forward_kinematics(skeleton, Vec3::Zero(), random.column(43, 1.0), pose);
  const Eigen::Matrix3Xd wanted = random.matrix(3, 4, 20.0);
  const std::vector<int> orientation{lwrist, rwrist, ltibia, rtibia};
  Reading reading(3, 4);
  for (Eigen::Index s = 0; s < 4; ++s) {
    const auto at = static_cast<std::size_t>(s);
    const Mat3 R = pose.R_world_joint[static_cast<std::size_t>(orientation[at])] *
                   all_sites()[at].R_joint_sensor;
    reading.col(s) = R.transpose() * (wanted.col(s) + Vec3(0, 9.81, 0));
  }
  EXPECT_LT((heading_accelerations(reading, pose, paper_sensors()) - wanted).norm(), 1e-9);
  reading(0, 2) = std::numeric_limits<double>::quiet_NaN();
  const auto silent = heading_accelerations(reading, pose, paper_sensors());
  EXPECT_FALSE(silent.col(2).allFinite());
  EXPECT_TRUE(silent.col(1).allFinite());
}

TEST(HeadingAccelerations, OfABodyAtRestAreNothing) {
  JointTransforms pose;
  forward_kinematics(template_skeleton(), Vec3::Zero(), Eigen::VectorXd::Zero(43), pose);
  Reading reading(3, 2);
  reading << 0, 0, 0, 0, 9.81, 9.81;
  EXPECT_LT(heading_accelerations(reading, pose, {{0, 1.0}, {1, 1.0}}).norm(), 1e-9);
}

}  // namespace
}  // namespace sparse_mocap::tautges2011
