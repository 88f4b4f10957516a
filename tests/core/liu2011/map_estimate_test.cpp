// SPDX-License-Identifier: GPL-3.0-or-later
#include "sparse_mocap/liu2011/map_estimate.hpp"

#include <gtest/gtest.h>

#include "liu2011/bodies.hpp"
#include "sparse_mocap/sensors/sites.hpp"

namespace sparse_mocap::liu2011 {
namespace {

using testing::distance_m;
using testing::Random;
using testing::random_pose;
using testing::template_skeleton;

std::vector<Sensor> six_sensors() {
  std::vector<Sensor> sensors;
  for (const char* site : {"left_hand", "right_hand", "left_ankle", "right_ankle", "head", "torso"})
    sensors.push_back({find_site(site), 0.7, Channel::position | Channel::orientation});
  return sensors;
}

// What ideal sensors measure on a pose, and a prior about another one.
struct Case {
  Skeleton body = template_skeleton();
  ControlWeights weights;
  BodyPose truth;
  std::vector<Observation> observed;
  PosePrior prior;

  Case(unsigned seed, double away_rad) {
    Random random(seed);
    truth = random_pose(body, random, 0.4);
    observed = sensors_of(body, worn_sensors(body, six_sensors()), truth);
    const Eigen::Index n = num_freedoms(body);
    prior.reference = moved(body, truth, random.column(n, away_rad));
    prior.whitening = (random.column(n, 5.0).array() + 10.0).matrix().asDiagonal();
    prior.target = random.column(n, 0.5);
  }
  PosteriorEnergy energy() const { return {body, observed, weights, prior}; }
  Estimate estimate(const BodyPose& start, int max_iterations) const {
    return map_estimate(body, observed, weights, prior, start, max_iterations);
  }
};

TEST(RobustCost, IsEquation11ForSmallErrorsAndFlatForLargeOnes) {
  const double sigma = 0.02, c = 3.0;
  EXPECT_NEAR(robust_cost(1e-8, sigma, c), 1e-8 / (2.0 * sigma * sigma), 1e-9);
  for (const double r : {0.01, 0.05, 0.3}) {
    const double s = c * sigma;  // equation (12), times c^2
    EXPECT_NEAR(robust_cost(r * r, sigma, c), c * c * std::log(1.0 + r * r / (2.0 * s * s)), 1e-12);
  }
  EXPECT_LT(robust_cost(1.0, sigma, c) - robust_cost(0.25, sigma, c), 2.0 * c * c);
}

TEST(PosteriorEnergy, AddsOneRobustTermASensorAndQuantity) {
  const Case made(1, 0.2);
  Random random(2);
  const BodyPose pose = random_pose(made.body, random, 0.4);
  JointTransforms at;
  forward_kinematics(made.body, pose, at);
  double sum = 0.0;
  for (const Observation& observed : made.observed) {
    const auto carrier = static_cast<std::size_t>(observed.worn.carrier);
    const Vec3 position =
        at.end[carrier] - 0.3 * at.R_world_joint[carrier] * made.body.joints()[carrier].bone;
    const Mat3 R = at.R_world_joint[static_cast<std::size_t>(observed.worn.turning)] *
                   observed.worn.R_joint_sensor;
    const double angle = Quat(R).angularDistance(Quat(observed.measured.R_frame_sensor));
    const double distance = (position - observed.measured.position).norm();
    const double c2 = 9.0;
    sum += c2 * std::log(1.0 + distance * distance / (2.0 * c2 * 1e-4));
    sum += c2 * std::log(1.0 + angle * angle / (2.0 * c2 * 0.035 * 0.035));
  }
  EXPECT_NEAR(made.energy().control(pose), sum, 1e-6);
  const Eigen::VectorXd q = pose_vector(made.body, made.prior.reference, pose);
  double prior = 0.0;  // equation (14)
  for (Eigen::Index d = 0; d < q.size(); ++d) {
    const double sigma = 1.0 / made.prior.whitening(d, d);
    const double predicted = made.prior.target[d] * sigma;
    prior += (q[d] - predicted) * (q[d] - predicted) / (2.0 * sigma * sigma);
  }
  EXPECT_NEAR(made.energy().value(pose), sum + prior, 1e-6);
}

TEST(PosteriorEnergy, LeavesOutWhatIsNotMeasured) {
  Case made(3, 0.2);
  Random random(4);
  const BodyPose pose = random_pose(made.body, random, 0.4);
  made.observed[0].has_position = false;
  const double without = made.energy().control(pose);
  made.observed[0].measured.position += Vec3(5.0, 5.0, 5.0);
  EXPECT_EQ(made.energy().control(pose), without);
  made.observed.clear();
  EXPECT_EQ(made.energy().control(pose), 0.0);
}

TEST(PosteriorEnergy, HasTheGradientOfItsValue) {
  for (unsigned seed = 5; seed < 9; ++seed) {
    const Case made(seed, 0.2);
    Random random(seed);
    const BodyPose pose = moved(made.body, made.truth, random.column(46, 0.2));
    const auto equations = made.energy().equations(pose);
    EXPECT_NEAR(equations.value, made.energy().value(pose), 1e-9);
    for (Eigen::Index i = 0; i < 46; ++i) {
      const Eigen::VectorXd step = 1e-6 * Eigen::VectorXd::Unit(46, i);
      const double difference = (made.energy().value(moved(made.body, pose, step)) -
                                 made.energy().value(moved(made.body, pose, -step))) /
                                2e-6;
      EXPECT_NEAR(difference, equations.gradient[i], 1e-4 * (1.0 + std::abs(difference))) << i;
    }
  }
}

TEST(MapEstimate, ReachesTheLowestValueOfRandomStarts) {
  for (unsigned seed = 10; seed < 14; ++seed) {
    const Case made(seed, 0.1);
    const auto energy = made.energy();
    const Estimate ours = made.estimate(made.prior.reference, 100);
    EXPECT_NEAR(ours.value, energy.value(ours.pose), 1e-9);
    EXPECT_LT(energy.equations(ours.pose).gradient.norm(), 1e-2);
    Random random(seed);
    for (int restart = 0; restart < 10; ++restart) {
      const BodyPose start = moved(made.body, made.prior.reference, random.column(46, 0.3));
      EXPECT_GE(made.estimate(start, 200).value, ours.value * (1.0 - 1e-4));
    }
  }
}

TEST(MapEstimate, FollowsSensorsThatAgreeAndIgnoresAWildOne) {
  Case made(20, 0.05);
  made.prior.reference = made.truth;
  made.prior.target.setZero();
  made.observed[0].measured.position += Vec3(1.0, 0.5, -1.0);
  const BodyPose start = moved(made.body, made.truth, Eigen::VectorXd::Constant(46, 0.05));
  const Estimate found = made.estimate(start, 100);
  EXPECT_LT(distance_m(made.body, found.pose, made.truth), 0.02);
}

TEST(MapEstimate, GoesAllTheWayToSensorsThatAreFarOff) {
  Case made(22, 0.0);
  made.prior.whitening.diagonal().head<3>().setConstant(2.0);
  made.prior.target.setZero();
  BodyPose start = made.truth;
  start.root_position += Vec3(1.0, 0.0, -2.0);
  made.prior.reference = start;
  EXPECT_LT(distance_m(made.body, made.estimate(start, 100).pose, made.truth), 0.05);
}

TEST(MapEstimate, WithoutSensorsIsThePriorsMean) {
  Case made(21, 0.1);
  made.observed.clear();
  const Estimate found = made.estimate(made.truth, 100);
  const Eigen::VectorXd mean =
      made.prior.whitening.diagonal().cwiseInverse().cwiseProduct(made.prior.target);
  EXPECT_LT((pose_vector(made.body, made.prior.reference, found.pose) - mean).norm(), 1e-3);
}

}  // namespace
}  // namespace sparse_mocap::liu2011
