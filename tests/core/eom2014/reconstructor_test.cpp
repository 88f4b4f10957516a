// SPDX-License-Identifier: GPL-3.0-or-later
#include "sparse_mocap/eom2014/reconstructor.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "sparse_mocap/eom2014/method.hpp"
#include "sparse_mocap/eom2014/training_sequence.hpp"
#include "sparse_mocap/motion/heading.hpp"
#include "support/refusals.hpp"
#include "support/synthetic.hpp"

namespace sparse_mocap::eom2014 {
namespace {

// Legs that swing against each other, the pelvis as high as the lower foot allows: a walk on the
// spot in which each foot leaves the floor.
Motion walking_motion(int frames, double rate_hz) {
  const Skeleton skeleton = sparse_mocap::testing::template_skeleton();
  Motion motion = sparse_mocap::testing::resting_motion(skeleton, frames, rate_hz);
  const auto bent = [](double angle) { return Quat(Eigen::AngleAxisd(angle, Vec3::UnitX())); };
  for (int t = 0; t < frames; ++t) {
    const double turn = 2.0 * kPi * t / rate_hz;
    const double left = std::max(0.0, std::sin(turn)), right = std::max(0.0, -std::sin(turn));
    using namespace standard_joint;
    motion.rotation(t, lfemur) = bent(-0.7 * left);
    motion.rotation(t, ltibia) = bent(1.2 * left);
    motion.rotation(t, rfemur) = bent(-0.7 * right);
    motion.rotation(t, rtibia) = bent(1.2 * right);
    motion.rotation(t, lhumerus) = bent(0.4 * std::sin(turn));
  }
  return motion;
}

Sensor ankle() { return {find_site("left_ankle"), 1.0, Channel::specific_force}; }

std::vector<Reading> take_of(const Motion& motion) {
  const auto sequence =
      training_sequences({{"take", "", motion, {}, {}}}, {find_site("left_ankle"), 1.0, 30.0})
          .front();
  std::vector<Reading> take;
  for (Eigen::Index t = 0; t < sequence.readings.rows(); ++t) {
    Reading reading(1);
    reading.time_s = static_cast<double>(t) / 30.0;
    reading.specific_force.col(0) = sequence.readings.row(t).head<3>();
    reading.angular_velocity.col(0) = sequence.readings.row(t).tail<3>();
    take.push_back(reading);
  }
  return take;
}

class EomReconstructor : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    const MethodSettings settings{"", {{"iterations", "60"}}};
    model_ = std::make_shared<Model>(
        method().train(settings, {{"walk", "", walking_motion(360, 120.0), {}, {}}}, Progress()));
  }
  static void TearDownTestSuite() { model_.reset(); }

  static Reconstructor made(const OptionValues& options = {}, Sensor sensor = ankle()) {
    MethodContext context;
    context.model = model_;
    context.sensors = {sensor};
    return Reconstructor({"", options}, context);
  }

  static std::shared_ptr<const Model> model_;
};

std::shared_ptr<const Model> EomReconstructor::model_;

TEST_F(EomReconstructor, RefusesWhatItCannotUse) {
  EXPECT_REFUSED(ConfigError, "trained for a sensor at left_ankle, right_ankle, not at head",
                 made({}, {find_site("head"), 1.0, Channel::specific_force}));
  EXPECT_REFUSED(ConfigError, "trained with window_frames 8, not 4",
                 made({{"window_frames", "4"}}));
  auto take = take_of(walking_motion(360, 120.0));
  EXPECT_REFUSED(ConfigError, "too short",
                 made().solve({take.begin(), take.begin() + 20}, Progress()));
  for (std::size_t t = 0; t < take.size(); t += 3)
    take[t].angular_velocity.setConstant(std::nan(""));
  EXPECT_NO_THROW(made().solve(take, Progress()));
  for (auto& reading : take) reading.angular_velocity.setConstant(std::nan(""));
  EXPECT_REFUSED(ConfigError, "has gaps", made().solve(take, Progress()));
}

TEST_F(EomReconstructor, RefusesClipsWithoutSteps) {
  const auto still =
      sparse_mocap::testing::resting_motion(sparse_mocap::testing::template_skeleton(), 360, 120.0);
  EXPECT_REFUSED(ConfigError, "the clip 'pause' has no steps",
                 method().train({}, {{"pause", "", still, {}, {}}}, Progress()));
}

TEST_F(EomReconstructor, BringsBackTheMovementThatItWasTrainedOn) {
  const Motion truth = resampled(walking_motion(360, 120.0), 30.0);
  const Eigen::MatrixXd positions = joint_positions(truth, PositionFrame::heading);
  for (const char* mapping :
       {"phases", "perceptron", "linear", "direct_linear", "gaussian_process", "path"}) {
    auto reconstructor = made({{"mapping", mapping}, {"estimates_mounting", "false"}});
    const auto found =
        to_motion(reconstructor.solve(take_of(walking_motion(360, 120.0)), Progress()),
                  reconstructor.skeleton(), 30.0);
    const Eigen::MatrixXd errors = joint_positions(found, PositionFrame::heading) - positions;
    EXPECT_LT(std::sqrt(errors.squaredNorm() / static_cast<double>(errors.size() / 3)), 0.03)
        << mapping;
  }
}

TEST_F(EomReconstructor, FindsHowTheSensorIsTurned) {
  auto take = take_of(walking_motion(360, 120.0));
  const Mat3 R_site_sensor =
      Eigen::AngleAxisd(30.0 * kRadiansPerDegree, Vec3::UnitX()).toRotationMatrix();
  for (auto& reading : take) {
    reading.specific_force = R_site_sensor.transpose() * reading.specific_force;
    reading.angular_velocity = R_site_sensor.transpose() * reading.angular_velocity;
  }
  auto reconstructor = made();
  const auto poses = reconstructor.solve(take, Progress());
  ASSERT_FALSE(reconstructor.notes().empty());
  EXPECT_NE(reconstructor.notes().front().find("turned by "), std::string::npos)
      << reconstructor.notes().front();
  const auto straight = made().solve(take_of(walking_motion(360, 120.0)), Progress());
  for (std::size_t t = 0; t < poses.size(); ++t)
    for (std::size_t j = 0; j < poses[t].rotations.size(); ++j)
      EXPECT_LT(poses[t].rotations[j].angularDistance(straight[t].rotations[j]), 0.2);
}

// Feet and hands turn with the left thigh, so that its rotation tells theirs.
Motion with_feet(const Motion& motion) {
  Motion full;
  full.skeleton = with_extremities(motion.skeleton);
  full.frame_time_s = motion.frame_time_s;
  full.root_positions = motion.root_positions;
  for (int t = 0; t < motion.num_frames(); ++t) {
    for (int j = 0; j < kNumStandardJoints; ++j) full.rotations.push_back(motion.rotation(t, j));
    for (int e = 0; e < kNumExtremities; ++e)
      full.rotations.push_back(motion.rotation(t, standard_joint::lfemur));
  }
  return full;
}

TEST_F(EomReconstructor, FeetAndHandsComeFromTheTrainingFrames) {
  const Motion truth = with_feet(resampled(walking_motion(360, 120.0), 30.0));
  const MethodSettings settings{"", {{"iterations", "30"}}};
  MethodContext context;
  context.model = std::make_shared<Model>(method().train(
      settings, {{"walk", "", with_feet(walking_motion(360, 120.0)), {}, {}}}, Progress()));
  context.sensors = {ankle()};
  const auto take = take_of(walking_motion(360, 120.0));
  const auto poses = Reconstructor({"", {}}, context).solve(take, Progress());
  double sum = 0.0;
  for (std::size_t t = 0; t < poses.size(); ++t)
    for (std::size_t e = 0; e < kNumExtremities; ++e) {
      EXPECT_NEAR(poses[t].extremities.certainty[e], 1.0, 1e-6);
      sum += poses[t].extremities.R_parent_joint[e].angularDistance(
          truth.rotation(static_cast<int>(t), extremity_joint(static_cast<int>(e))));
    }
  EXPECT_LT(sum / static_cast<double>(poses.size() * kNumExtremities), 5.0 * kRadiansPerDegree);
  for (const auto& pose : made().solve(take, Progress()))  // trained without feet
    EXPECT_EQ(pose.extremities.certainty[0], 0.0);
}

TEST_F(EomReconstructor, AModelComesBackFromItsFileAsItWas) {
  const Config config = with_model({}, *model_);
  const TrainedModel trained = restored(*model_, config);
  const Model again = stored(trained, config);
  EXPECT_EQ(again.tensors, model_->tensors);
  EXPECT_EQ(again.metadata, model_->metadata);
}

TEST_F(EomReconstructor, RefusesModelsThatAreNotItsOwn) {
  const auto refused = [](const std::string& text, const auto& change) {
    Model broken = *model_;
    change(broken);
    EXPECT_REFUSED(FormatError, text, restored(broken, with_model({}, broken)));
  };
  refused("has no tensor 'latent'", [](Model& m) { m.tensors.erase("latent"); });
  refused("does not say its site", [](Model& m) { m.metadata.erase("site"); });
  refused("not of 'eom2014'", [](Model& m) { m.method = "held_pose"; });
  refused("newer version", [](Model& m) { m.version = 99; });
  refused("are positive", [](Model& m) { m.set("alpha", Eigen::Vector3d(1.0, -1.0, 0.1)); });
  refused("does not divide",
          [](Model& m) { m.set("sequence_begins", Eigen::Matrix<std::int32_t, 1, 1>(5)); });
  refused("no probabilities", [](Model& m) {
    m.set("left_ankle.left_step.transition", Eigen::Matrix3d::Ones().eval());
  });
}

}  // namespace
}  // namespace sparse_mocap::eom2014
