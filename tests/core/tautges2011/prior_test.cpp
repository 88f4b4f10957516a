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
using testing::paper_signals;
using testing::Random;
using testing::random_derivatives;
using testing::random_neighbourhood;
using testing::template_skeleton;

constexpr double kDt = 0.04;

class Terms : public ::testing::Test {
 protected:
  Terms() {
    config_.w_prior = 5.5;
    config_.w_pose = 0.7;
    config_.w_motion = 0.3;
    config_.w_smooth = 0.25;
    config_.w_contr = 1.75;
    JointTransforms pose;
    forward_kinematics(skeleton_, Vec3::Zero(), q_, pose);
    x_ = stacked_ends(pose);
  }

  // What a term comes to that put(term) makes, in the memory of another one.
  template <typename Put>
  double value(const Put& put) const {
    KernelTerm term{{TermSpace::Compared::angles, {lwrist}}, 9.0, Eigen::MatrixXd::Ones(7, 3)};
    put(term);
    return Energy(skeleton_, neighbours_.weights, {{term}, {}}).value(q_);
  }
  double control_value(const Eigen::Matrix3Xd& accelerations,
                       const std::vector<retrieval::Signal>& signals) const {
    return value([&](KernelTerm& term) {
      put_control_term(derivatives_, config_, x_now_, accelerations, signals, kDt, term);
    });
  }
  // sum_i w_i sqrt|d_i|
  template <typename Difference>
  double kernel_sum(const Difference& difference) const {
    double sum = 0.0;
    for (Eigen::Index i = 0; i < neighbours_.weights.size(); ++i)
      sum += neighbours_.weights[i] * std::sqrt(Eigen::VectorXd(difference(i)).norm());
    return sum;
  }
  static void expect_near(double found, double expected) {
    EXPECT_NEAR(found, expected, 2e-5 * expected);
  }

  Random random_{1};
  const Skeleton skeleton_ = template_skeleton();
  const retrieval::Neighbourhood neighbours_ = random_neighbourhood(random_, 24);
  const PathDerivatives derivatives_ = random_derivatives(random_, 24);
  const Eigen::VectorXd q_ = random_.column(43, 1.0);
  Eigen::VectorXd x_ = Eigen::VectorXd(63);
  const Eigen::VectorXd x_now_ = random_.column(63, 1.0);
  const Eigen::VectorXd x_before_ = random_.column(63, 1.0);
  Config config_;
};

TEST_F(Terms, PosePriorIsEquationFive) {
  expect_near(value([&](KernelTerm& term) { put_pose_prior(neighbours_, config_, term); }),
              5.5 * 0.7 * kernel_sum([&](Eigen::Index i) -> Eigen::VectorXd {
                return neighbours_.angles.col(i) - q_;
              }));
}

TEST_F(Terms, MotionPriorIsEquationsSixAndSeven) {
  expect_near(
      value([&](KernelTerm& term) { put_motion_prior(derivatives_, config_, x_now_, kDt, term); }),
      5.5 * 0.3 * kernel_sum([&](Eigen::Index i) -> Eigen::VectorXd {
        return x_now_ + derivatives_.velocities.col(i) * kDt +
               0.5 * derivatives_.accelerations.col(i) * kDt * kDt - x_;
      }));
}

// dt sqrt(|a_i - a|), the factor belonging to the square root.
TEST_F(Terms, SmoothnessPriorIsEquationsEightAndNine) {
  const Eigen::VectorXd a = (x_ - 2.0 * x_now_ + x_before_) / (kDt * kDt);
  expect_near(value([&](KernelTerm& term) {
                put_smoothness_prior(derivatives_, config_, x_now_, x_before_, kDt, term);
              }),
              5.5 * 0.25 * kDt * kernel_sum([&](Eigen::Index i) -> Eigen::VectorXd {
                return derivatives_.accelerations.col(i) - a;
              }));
}

TEST_F(Terms, ControlTermIsEquationsTenAndEleven) {
  const Eigen::Matrix3Xd alpha = random_.matrix(3, 4, 30.0);
  const std::vector<Eigen::Index> rows{3 * lradius, 3 * rradius, 3 * ltibia, 3 * rtibia};
  const auto next_to_sensors = [&](const Eigen::VectorXd& y) {
    Eigen::VectorXd out(12);
    for (Eigen::Index s = 0; s < 4; ++s)
      out.segment<3>(3 * s) = y.segment<3>(rows[static_cast<std::size_t>(s)]);
    return out;
  };
  expect_near(control_value(alpha, paper_signals()),
              1.75 * kernel_sum([&](Eigen::Index i) -> Eigen::VectorXd {
                const Eigen::VectorXd moved = x_now_ + derivatives_.velocities_before.col(i) * kDt;
                return next_to_sensors(moved) + 0.5 * kDt * kDt * alpha.reshaped() -
                       next_to_sensors(x_);
              }));
}

TEST_F(Terms, ControlTermLeavesSilentSensorsOut) {
  Eigen::Matrix3Xd alpha = random_.matrix(3, 4, 30.0);
  alpha(1, 1) = std::numeric_limits<double>::quiet_NaN();
  const std::vector<retrieval::Signal> all = paper_signals();
  const std::vector<retrieval::Signal> delivering{all[0], all[2], all[3]};
  Eigen::Matrix3Xd rest(3, 3);
  rest << alpha.col(0), alpha.col(2), alpha.col(3);
  expect_near(control_value(alpha, all), control_value(rest, delivering));
  alpha.setConstant(std::numeric_limits<double>::quiet_NaN());
  EXPECT_EQ(control_value(alpha, all), 0.0);
}

Eigen::Matrix3Xd heading_accelerations(const Reading& reading, const JointTransforms& pose,
                                       const std::vector<retrieval::Signal>& signals) {
  Eigen::Matrix3Xd accelerations;
  put_heading_accelerations(reading, pose, signals, accelerations);
  return accelerations;
}

TEST(HeadingAccelerations, TurnReadingsByThePoseAndTakeGravityAway) {
  Random random(2);
  const Skeleton skeleton = template_skeleton();
  JointTransforms pose;
  forward_kinematics(skeleton, Vec3::Zero(), random.column(43, 1.0), pose);
  const Eigen::Matrix3Xd wanted = random.matrix(3, 4, 20.0);
  const std::vector<int> orientation{lwrist, rwrist, ltibia, rtibia};
  Reading reading(4);
  for (Eigen::Index s = 0; s < 4; ++s) {
    const auto at = static_cast<std::size_t>(s);
    const Mat3 R = pose.R_world_joint[static_cast<std::size_t>(orientation[at])] *
                   all_sites()[at].R_joint_sensor;
    reading.specific_force.col(s) = R.transpose() * (wanted.col(s) + Vec3(0, 9.81, 0));
  }
  EXPECT_LT((heading_accelerations(reading, pose, paper_signals()) - wanted).norm(), 1e-9);
  reading.specific_force(0, 2) = std::numeric_limits<double>::quiet_NaN();
  const auto silent = heading_accelerations(reading, pose, paper_signals());
  EXPECT_FALSE(silent.col(2).allFinite());
  EXPECT_TRUE(silent.col(1).allFinite());
}

TEST(HeadingAccelerations, OfABodyAtRestAreNothing) {
  JointTransforms pose;
  forward_kinematics(template_skeleton(), Vec3::Zero(), Eigen::VectorXd::Zero(43), pose);
  Reading reading(2);
  reading.specific_force << 0, 0, 0, 0, 9.81, 9.81;
  const std::vector<retrieval::Signal> wrists{{0, 0}, {1, 1}};
  EXPECT_LT(heading_accelerations(reading, pose, wrists).norm(), 1e-9);
}

}  // namespace
}  // namespace sparse_mocap::tautges2011
