// SPDX-License-Identifier: GPL-3.0-or-later
#include "sparse_mocap/readings/take_alignment.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "sparse_mocap/base/quaternions.hpp"
#include "sparse_mocap/sensors/virtual_sensor.hpp"
#include "support/synthetic.hpp"

namespace sparse_mocap {
namespace {

using testing::Random;
using testing::swaying_motion;
using testing::template_skeleton;

constexpr double kRate_hz = 60.0;

std::vector<SensorInput> worn(Channels channels) {
  std::vector<SensorInput> sensors;
  for (const int site : paper_sites()) sensors.push_back({{site, 1.0, channels}, {}});
  return sensors;
}

// What sensors record that are turned by these rotations on the body, their clock being late_s
// late.
std::vector<SensorRecording> recorded(const Motion& motion, double late_s,
                                      const std::vector<Mat3>& R_sensor_site) {
  std::vector<Site> sites;
  for (const int site : paper_sites()) sites.push_back(all_sites()[static_cast<std::size_t>(site)]);
  const auto readings = virtual_readings(motion, sites);
  std::vector<SensorRecording> take(sites.size());
  for (std::size_t s = 0; s < sites.size(); ++s) {
    take[s].specific_force = R_sensor_site[s] * readings[s].specific_force_end;
    take[s].angular_velocity = R_sensor_site[s] * readings[s].angular_velocity;
    take[s].orientation.resize(4, motion.num_frames());
    for (int t = 0; t < motion.num_frames(); ++t) {
      take[s].times_s.push_back(t * motion.frame_time_s + late_s);
      const Mat3 R =
          readings[s].R_world_sensor[static_cast<std::size_t>(t)] * R_sensor_site[s].transpose();
      take[s].orientation.col(t) = wxyz_of(Quat(R));
    }
  }
  return take;
}

std::vector<Mat3> random_mountings() {
  Random random(5);
  std::vector<Mat3> rotations;
  for (std::size_t s = 0; s < paper_sites().size(); ++s) {
    const Vec3 turn = random.vector(1.5);
    rotations.push_back(Eigen::AngleAxisd(turn.norm(), turn.normalized()).toRotationMatrix());
  }
  return rotations;
}

// A movement that becomes faster and faster, so that no part of it is like another.
Motion hastening() {
  const Motion even = swaying_motion(template_skeleton(), 1, 1500, kRate_hz);
  Motion motion = trimmed(even, 0, 720);
  for (int t = 0; t < motion.num_frames(); ++t) {
    const double at = 0.4 * t + 0.0009 * t * t;
    const int before = static_cast<int>(at);
    const double part = at - before;
    const auto b = static_cast<std::size_t>(before);
    motion.root_positions[static_cast<std::size_t>(t)] =
        (1.0 - part) * even.root_positions[b] + part * even.root_positions[b + 1];
    for (int j = 0; j < motion.skeleton.num_joints(); ++j)
      motion.rotation(t, j) = even.rotation(before, j).slerp(part, even.rotation(before + 1, j));
  }
  return motion;
}

const Motion& performance() {
  static const Motion motion = hastening();
  return motion;
}

// From 3 to 7 s.
Motion part() { return trimmed(performance(), 180, 420); }

class AlignTake : public ::testing::TestWithParam<Channels> {};

TEST_P(AlignTake, FindsAKnownTimeHoweverTheSensorsAreTurned) {
  const auto take = recorded(performance(), 1.2345, random_mountings());
  const TakeAlignment found = align_take(part(), take, worn(GetParam()), {});
  EXPECT_NEAR(found.begin_s, 3.0 + 1.2345, 0.5 / kRate_hz);
  EXPECT_GT(found.correlation, 0.99);
  EXPECT_LT(found.runner_up, 0.9);
  EXPECT_NEAR(found.coverage, 1.0, 1e-9);
  ASSERT_EQ(found.sensor_correlations.size(), 4U);
  for (const double correlation : found.sensor_correlations) EXPECT_GT(correlation, 0.98);
}

INSTANTIATE_TEST_SUITE_P(Channels, AlignTake,
                         ::testing::Values(Channels(Channel::specific_force),
                                           Channel::specific_force | Channel::angular_velocity,
                                           Channels(Channel::angular_velocity),
                                           Channels(Channel::orientation)));

TEST(AlignTake, SaysHowMuchOfTheMotionTheTakeCovers) {
  auto take =
      recorded(trimmed(performance(), 240, 720), 0.0, std::vector<Mat3>(4, Mat3::Identity()));
  const TakeAlignment found = align_take(part(), take, worn(Channel::specific_force), {});
  EXPECT_NEAR(found.begin_s, -1.0, 0.01);
  EXPECT_NEAR(found.coverage, 0.75, 0.01);
}

TEST(AlignTake, TellsAnotherMovementApart) {
  const Motion other = swaying_motion(template_skeleton(), 9, 600, 1.7 * kRate_hz);
  const auto take = recorded(performance(), 0.0, random_mountings());
  EXPECT_LT(
      align_take(trimmed(other, 100, 500), take, worn(Channel::specific_force), {}).correlation,
      0.8);
}

TEST(AlignTake, TellsWhichSensorWasElsewhere) {
  auto take = recorded(performance(), 0.0, random_mountings());
  std::swap(take[0], take[3]);
  const auto found = align_take(part(), take, worn(Channel::specific_force), {});
  const auto& of_sensors = found.sensor_correlations;
  EXPECT_GT(std::min(of_sensors[1], of_sensors[2]), 0.95);
  EXPECT_LT(std::max(of_sensors[0], of_sensors[3]), 0.9);
}

// The same movement twice.
Motion repeated() {
  Motion twice = part();
  const Motion again = twice;
  twice.root_positions.insert(twice.root_positions.end(), again.root_positions.begin(),
                              again.root_positions.end());
  twice.rotations.insert(twice.rotations.end(), again.rotations.begin(), again.rotations.end());
  return twice;
}

TEST(AlignTake, ShowsThatSeveralTimesFit) {
  const auto take = recorded(repeated(), 0.0, random_mountings());
  const auto found = align_take(part(), take, worn(Channel::specific_force), {});
  EXPECT_GT(found.runner_up, 0.95 * found.correlation);
}

TEST(AlignTake, AnEventDecidesTheTime) {
  const auto take = recorded(repeated(), 0.0, random_mountings());
  for (const double begin_s : {0.0, 4.0}) {
    const auto event = std::pair{begin_s + 1.5, begin_s + 3.0};
    const auto found = align_take(part(), take, worn(Channel::specific_force), event);
    EXPECT_NEAR(found.begin_s, begin_s, 0.01);
  }
}

TEST(AlignTake, RefusesWhatIsTooShortOrTellsNothing) {
  const std::vector<Mat3> straight(4, Mat3::Identity());
  const auto sensors = worn(Channel::specific_force);
  const auto take = recorded(performance(), 0.0, straight);
  EXPECT_THROW(align_take(trimmed(performance(), 0, 30), take, sensors, {}), ConfigError);
  EXPECT_THROW(
      align_take(part(), recorded(trimmed(performance(), 0, 30), 0.0, straight), sensors, {}),
      ConfigError);
  EXPECT_THROW(align_take(part(), take, sensors, std::pair{20.0, 22.0}), ConfigError);
  EXPECT_THROW(align_take(part(), take, worn(Channel::position), {}), ConfigError);
  EXPECT_THROW(align_take(part(), std::span(take).first(2), sensors, {}), std::invalid_argument);
}

TEST(AlignTake, CanBeCancelled) {
  const auto take = recorded(performance(), 0.0, random_mountings());
  const Progress cancelling([](std::size_t, std::size_t, std::string_view) { return false; });
  EXPECT_THROW(align_take(part(), take, worn(Channel::specific_force), {}, cancelling), Cancelled);
}

}  // namespace
}  // namespace sparse_mocap
