// SPDX-License-Identifier: GPL-3.0-or-later
#include "sparse_mocap/eom2014/reconstructor.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "eom2014/walk.hpp"
#include "sparse_mocap/motion/heading.hpp"
#include "support/refusals.hpp"

namespace sparse_mocap::eom2014 {
namespace {

class EomReconstructor : public EomWalk {};

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

// The gyroscope says that the performer turns; the clip goes straight on.
TEST_F(EomReconstructor, TurnsAsTheGyroscopeDoes) {
  auto take = take_of(walking_motion(360, 120.0));
  for (auto& reading : take) {
    reading.gravity_direction.col(0) = reading.specific_force.col(0).normalized();
    reading.angular_velocity.col(0) += 0.5 * reading.gravity_direction.col(0);
  }
  const auto turned_by = [&](const char* uses_gyroscope) {
    auto reconstructor =
        made({{"turns_by_gyroscope", uses_gyroscope}, {"estimates_mounting", "false"}});
    const auto yaw =
        headings(to_motion(reconstructor.solve(take, Progress()), reconstructor.skeleton(), 30.0));
    return yaw.back() - yaw.front();
  };
  EXPECT_NEAR(turned_by("true"), 0.5 * 3.0, 0.25);
  EXPECT_NEAR(turned_by("false"), 0.0, 0.1);
}

// Two types of motion, of which one is twice as fast.
TEST_F(EomReconstructor, RecognisesTheTypeOfMotion) {
  const Motion walk = walking_motion(360, 120.0);
  Motion run = walking_motion(720, 120.0);
  run.frame_time_s /= 2.0;
  MethodContext context;
  context.model = std::make_shared<Model>(
      method().train({"", {{"iterations", "40"}}},
                     {{"walk", "walk", walk, {}, {}}, {"run", "run", run, {}, {}}}, Progress()));
  context.sensors = {ankle()};
  for (const int type : {0, 1}) {
    Reconstructor reconstructor({}, context);
    const Motion& truth = type == 0 ? walk : run;
    const auto poses = reconstructor.solve(take_of(truth), Progress());
    for (const auto& pose : poses) EXPECT_EQ(pose.diagnostics.at("motion_type")[0], type);
    const Eigen::MatrixXd errors =
        joint_positions(to_motion(poses, reconstructor.skeleton(), 30.0), PositionFrame::heading) -
        joint_positions(resampled(truth, 30.0), PositionFrame::heading);
    EXPECT_LT(std::sqrt(errors.squaredNorm() / static_cast<double>(errors.size() / 3)), 0.04);
  }
}

TEST_F(EomReconstructor, LearnsThePhasesThatItIsGiven) {
  TrainingClip clip{"walk", "", walking_motion(360, 120.0), {}, {}};
  clip.segments = method().segment({}, clip);
  ASSERT_GT(clip.segments.size(), 3U);
  EXPECT_EQ(clip.segments.front().begin_s, 0.0);
  clip.segments.resize(2);
  clip.segments[1] = {1.0, "jump"};
  const Model learnt = method().train({"", {{"iterations", "5"}}}, {clip}, Progress());
  EXPECT_TRUE(learnt.tensors.contains("type0.left_ankle.jump.transition"));
  clip.segments[1].label = "hop";
  EXPECT_REFUSED(ConfigError, "one named 'hop'", method().train({}, {clip}, Progress()));
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
  refused("has no tensor 'type0.latent'", [](Model& m) { m.tensors.erase("type0.latent"); });
  refused("does not say its site", [](Model& m) { m.metadata.erase("site"); });
  refused("not of 'eom2014'", [](Model& m) { m.method = "held_pose"; });
  refused("newer version", [](Model& m) { m.version = 99; });
  refused("older version", [](Model& m) { m.version = 1; });
  refused("unknown one", [](Model& m) {
    const auto frames = static_cast<Eigen::Index>(m.matrix<double>("type0.poses").rows());
    m.set("type0.phases", Eigen::Matrix<std::int32_t, Eigen::Dynamic, 1>::Constant(frames, 6));
  });
  refused("are positive", [](Model& m) { m.set("type0.alpha", Eigen::Vector3d(1.0, -1.0, 0.1)); });
  refused("does not divide",
          [](Model& m) { m.set("type0.sequence_begins", Eigen::Matrix<std::int32_t, 1, 1>(5)); });
  refused("no probabilities", [](Model& m) {
    m.set("type0.left_ankle.left_step.transition", Eigen::Matrix3d::Ones().eval());
  });
}

}  // namespace
}  // namespace sparse_mocap::eom2014
