// SPDX-License-Identifier: GPL-3.0-or-later
#include "sparse_mocap/liu2011/reconstructor.hpp"

#include <gtest/gtest.h>

#include <limits>

#include "liu2011/bodies.hpp"
#include "sparse_mocap/sensors/sites.hpp"

namespace sparse_mocap::liu2011 {
namespace {

using testing::pose_of;
using testing::readings_of;
using testing::swaying_motion;
using testing::template_skeleton;

constexpr auto kBoth = Channel::position | Channel::orientation;
constexpr int kClip = 0;  // performed, and not searched

// The sensors of the paper, each with these channels.
std::vector<Sensor> six_sensors(Channels channels) {
  std::vector<Sensor> sensors;
  for (const char* site : {"left_hand", "right_hand", "left_ankle", "right_ankle", "head", "torso"})
    sensors.push_back({find_site(site), 1.0, channels});
  return sensors;
}

const std::shared_ptr<const MotionDatabase>& database() {
  static const auto made = [] {
    std::vector<Motion> motions;
    for (const double pace : {1.0, 0.85, 0.93, 1.08, 1.16}) {
      for (unsigned seed = 0; seed < 4; ++seed) {
        motions.push_back(swaying_motion(template_skeleton(), seed, 100, 25.0 * pace));
        motions.back().frame_time_s = 1.0 / 25.0;
      }
    }
    return testing::database_of(motions);
  }();
  return made;
}

// Largest distance over the frames of sensors, as they are worn on the estimates, from where the
// readings have them, m; beyond the first few frames.
double farthest_m(const std::vector<PoseEstimate>& estimates, const std::vector<Reading>& truth,
                  const std::vector<Sensor>& sensors) {
  const Skeleton body = template_skeleton();
  const auto worn = worn_sensors(body, sensors);
  double largest = 0.0;
  for (std::size_t t = 5; t < estimates.size(); ++t) {
    BodyPose pose{estimates[t].root_position, {}};
    for (const Quat& q : estimates[t].rotations) pose.rotations.push_back(q.toRotationMatrix());
    for (const auto& seen : sensors_of(body, worn, pose))
      largest = std::max(largest,
                         (seen.measured.position - truth[t].position.col(seen.worn.sensor)).norm());
  }
  return largest;
}

std::vector<PoseEstimate> solved(const std::vector<Sensor>& sensors,
                                 const std::vector<Reading>& take, const Config& config = {}) {
  Reconstructor method(config, {database(), nullptr, {}, sensors, {kClip}});
  return solve_live(method, take, Progress());
}

TEST(Reconstructor, FollowsSensorsThroughAMovementThatIsNotInTheDatabase) {
  for (const Channels channels : {Channels(kBoth), Channels(Channel::position)}) {
    const auto sensors = six_sensors(channels);
    const auto take = readings_of(*database(), kClip, sensors);
    EXPECT_LT(farthest_m(solved(sensors, take), take, sensors), 0.05);
  }
}

TEST(Reconstructor, TurnsTheBodyAsOrientationsSay) {
  auto sensors = six_sensors(Channel::orientation);
  const auto take = readings_of(*database(), kClip, sensors);
  const auto estimates = solved(sensors, take);
  const auto worn = worn_sensors(template_skeleton(), sensors);
  for (std::size_t t = 5; t < estimates.size(); ++t) {
    BodyPose pose{estimates[t].root_position, {}};
    for (const Quat& q : estimates[t].rotations) pose.rotations.push_back(q.toRotationMatrix());
    const auto measured = observations(take[t], worn, {});
    const auto seen = sensors_of(template_skeleton(), worn, pose);
    for (std::size_t s = 0; s < seen.size(); ++s)
      EXPECT_LT(Quat(seen[s].measured.R_frame_sensor)
                    .angularDistance(Quat(measured[s].measured.R_frame_sensor)),
                10.0 * kRadiansPerDegree);
  }
}

TEST(Reconstructor, TakesAnyMixOfChannelsAndSilences) {
  auto sensors = six_sensors(kBoth);
  sensors[0].channels = Channel::position;
  sensors[1].channels = Channel::orientation;
  sensors[4].channels = Channel::orientation;
  auto take = readings_of(*database(), kClip, sensors);
  const auto truth = take;
  for (std::size_t t = 30; t < 40; ++t)
    for (const Eigen::Index s : {2, 5}) {
      take[t].position.col(s).setConstant(std::numeric_limits<double>::quiet_NaN());
      take[t].orientation.col(s).setConstant(std::numeric_limits<double>::quiet_NaN());
    }
  const auto estimates = solved(sensors, take);
  ASSERT_EQ(estimates.size(), take.size());
  const auto worn = worn_sensors(template_skeleton(), sensors);
  const auto& last = estimates.back();
  BodyPose pose{last.root_position, {}};
  for (const Quat& q : last.rotations) pose.rotations.push_back(q.toRotationMatrix());
  for (const auto& seen : sensors_of(template_skeleton(), worn, pose)) {
    const Vec3 measured = truth.back().position.col(seen.worn.sensor);
    if (!measured.allFinite()) continue;
    EXPECT_LT((seen.measured.position - measured).norm(), 0.05);
  }
}

TEST(Reconstructor, HoldsWrongPositionsOff) {
  const auto sensors = six_sensors(kBoth);
  const auto truth = readings_of(*database(), kClip, sensors);
  auto take = truth;
  testing::Random random(1);
  for (std::size_t t = 6; t < take.size(); t += 4)
    take[t].position.col(random.below(6)) += random.vector(1.0);
  EXPECT_LT(farthest_m(solved(sensors, take), truth, sensors), 0.12);
}

TEST(Reconstructor, FollowsOnABodyOfItsOwn) {
  StandardBones bones = template_bones();
  for (Vec3& bone : bones) bone *= 1.1;
  const Skeleton body = make_standard_skeleton(bones);
  // Somebody larger does the same: everything is farther apart.
  const auto sensors = six_sensors(kBoth);
  auto take = readings_of(*database(), kClip, sensors);
  for (auto& reading : take) reading.position *= 1.1;
  Reconstructor method({}, {database(), nullptr, body, sensors, {kClip}});
  const auto estimates = solve_live(method, take, Progress());
  const auto worn = worn_sensors(body, sensors);
  for (std::size_t t = 5; t < estimates.size(); ++t) {
    BodyPose pose{estimates[t].root_position, {}};
    for (const Quat& q : estimates[t].rotations) pose.rotations.push_back(q.toRotationMatrix());
    for (const auto& seen : sensors_of(body, worn, pose))
      EXPECT_LT((seen.measured.position - take[t].position.col(seen.worn.sensor)).norm(), 0.05);
  }
}

TEST(Reconstructor, FeetAndHandsAreThoseOfTheClosestExamples) {
  const Skeleton full = with_extremities(template_skeleton());
  const std::vector<Motion> motions{swaying_motion(full, 0, 60, 25.0),
                                    swaying_motion(full, 0, 60, 25.0)};
  DatabaseContent content = testing::content_of(motions, 25.0);
  content.skeleton = template_skeleton();
  for (Clip& clip : content.clips) clip.has_extremity.fill(true);
  const auto made = testing::database_of(content);
  const auto sensors = six_sensors(kBoth);
  Config config;
  config.num_neighbours = 4;
  Reconstructor method(config, {made, nullptr, {}, sensors, {0}});
  const auto estimates = solve_live(method, readings_of(*made, 0, sensors), Progress());
  double sum = 0.0;
  for (std::size_t t = 5; t < estimates.size(); ++t)
    for (int e = 0; e < kNumExtremities; ++e) {
      const ExtremityVote& vote = estimates[t].extremities;
      EXPECT_NEAR(vote.certainty[static_cast<std::size_t>(e)], 1.0, 1e-9);
      sum += vote.R_parent_joint[static_cast<std::size_t>(e)].angularDistance(
          motions[0].rotation(static_cast<int>(t), extremity_joint(e)));
    }
  const auto count = static_cast<double>(kNumExtremities * (estimates.size() - 5));
  EXPECT_LT(sum / count, 5.0 * kRadiansPerDegree);
}

TEST(Reconstructor, WorksWithEveryPrior) {
  const auto sensors = six_sensors(kBoth);
  const auto take = readings_of(*database(), kClip, sensors);
  for (const auto prior :
       {PriorModel::dynamic, PriorModel::local_pca, PriorModel::inverse_kinematics}) {
    Config config;
    config.prior = prior;
    EXPECT_LT(farthest_m(solved(sensors, take, config), take, sensors), 0.3);
  }
}

}  // namespace
}  // namespace sparse_mocap::liu2011
